/* modes.c - frequencies and shapes of small vibrations about the present place.
 *
 * A spring k along e acts between the arms a of body A and b of body B. It has the row
 *
 *     g = (-e, -a x e, e, b x e)
 *
 * of their freedoms, and adds k g^T g to the stiffness K. Points that press, or pull, have kn A across the joint and
 * ks A along it. So have those that bear nothing just now and would pull. A field contact has the springs of its
 * area at the centre of its pressure (secants.c has the same).
 * An element adds its tangent (element/tangent.c). One that stands for what lies outside, as a quiet face, adds none.
 *
 * Freedoms are those of the centroid, and of the turn about the principal axes, times the root of mass or moment of
 * inertia. So the mass matrix is 1, and the eigenvalues of K are squares of circular frequencies, 1/s2. K is stored by
 * rows from the first entry on. Bodies are in the order of Cuthill and McKee (1969) along contacts and elements. A
 * little stiffness is added everywhere, and taken off the eigenvalues again: what nothing holds has 0. */
#include "base/error.h"
#include "base/skyline.h"
#include "contact/body_contacts.h"
#include "contact/contacts.h"
#include "contact/places.h"
#include "contact/sides.h"
#include "cycle/cycle_data.h"
#include "element/tangent.h"
#include "zone/zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/modes.h>

/* Constant: pi. */
#define PI 3.14159265358979323846
/* Limit: unbalanced force over what a body bears, up to which a model is at rest. */
#define AT_REST 1e-3
/* Tolerance: stiffness that is added, over the mean of the diagonal. That is far above rounding, and far below the
 * square of any frequency that is asked for. Below ten times as much a vibration has none. Test: lua/test_modes. */
#define ADDED 1e-11
/* Limit: entries of a matrix; it takes 8 bytes for each, and the product of entries and rows in time. */
#define MOST_ENTRIES 200000000.0

#define NO_FREEDOM SIZE_MAX

/* A free body: its row, the freedoms of its six motions, roots of 1 over mass and moments, and its principal axes. */
typedef struct mover {
    uint32_t body;
    size_t freedom[6];
    double per[6];
    tl_mat3 axes;
} mover;

typedef struct vibration {
    tl_model *m;
    mover *mover;
    uint32_t *number; /* of each body among the movers, or TL_NO_ROW */
    uint32_t *queue;
    size_t movers, size;
    uint32_t *beside, *beside_begin; /* bodies that body b may share a spring with: from beside_begin[b] on */
    tl_skyline k;
} vibration;

/* ---------------------------------------------------------------- freedoms ---------------- */

/* The rows of the bodies that carry nodes of an element, one after the other, each once; how many. */
static size_t list_carriers(const tl_model *m, size_t row, uint32_t *to)
{
    const tl_element_table *t = &m->elements->table;
    size_t count = 0;
    for (uint32_t k = t->node_begin[row]; k < t->node_begin[row] + t->node_count[row]; k++) {
        const uint32_t body = m->elements->nodes.body[k];
        size_t i = 0;
        while (i < count && to[i] != body)
            i++;
        if (i == count && body != TL_NO_ROW)
            to[count++] = body;
    }
    return count;
}

/* Counts what stands beside each body or, with `put`, lists it: contacts first, in their order. */
static void go_beside(vibration *v, bool put)
{
    const tl_model *m = v->m;
    const size_t elements = m->elements ? m->elements->table.table.rows : 0;
    uint32_t on[TL_ELEMENT_MANY];
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
            const tl_sides of = tl_contact_bodies(m, at.contact);
            if (put)
                v->beside[v->beside_begin[body]] = of.a == body ? of.b : of.a;
            v->beside_begin[body]++;
        }
    for (size_t row = 0; row < elements; row++) {
        const size_t count = list_carriers(m, row, on);
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < count; k++) {
                if (put && i != k)
                    v->beside[v->beside_begin[on[i]]] = on[k];
                v->beside_begin[on[i]] += i != k;
            }
    }
}

/* false: out of memory. */
static bool list_beside(vibration *v)
{
    const size_t rows = v->m->bodies.table.rows;
    uint32_t sum = 0;
    v->beside_begin = calloc(rows + 1, sizeof *v->beside_begin);
    if (!v->beside_begin)
        return false;
    go_beside(v, false);
    for (size_t body = 0; body < rows; body++) {
        const uint32_t count = v->beside_begin[body];
        v->beside_begin[body] = sum;
        sum += count;
    }
    v->beside = malloc((sum + (size_t)1) * sizeof *v->beside);
    if (!v->beside)
        return false;
    go_beside(v, true); /* each then begins where it ended: */
    memmove(v->beside_begin + 1, v->beside_begin, rows * sizeof *v->beside_begin);
    v->beside_begin[0] = 0;
    return true;
}

/* Lists bodies that hang together from one of them on, in the order in which they reach each other. */
static size_t reach(vibration *v, uint32_t from, size_t end)
{
    const tl_bodies *b = &v->m->bodies;
    size_t next = end;
    v->queue[end++] = from;
    v->number[from] = 0;
    for (; next < end; next++)
        for (uint32_t k = v->beside_begin[v->queue[next]]; k < v->beside_begin[v->queue[next] + 1]; k++) {
            const uint32_t other = v->beside[k];
            if (v->number[other] != TL_NO_ROW || b->fixed[other] == TL_FIX_ALL)
                continue;
            v->number[other] = 0;
            v->queue[end++] = other;
        }
    return end;
}

/* The body from which to begin: of those that are left and free that with the fewest beside it. */
static uint32_t choose_first(const vibration *v)
{
    const tl_bodies *b = &v->m->bodies;
    uint32_t best = TL_NO_ROW;
    uint32_t least = UINT32_MAX;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (v->number[body] != TL_NO_ROW || b->fixed[body] == TL_FIX_ALL)
            continue;
        const uint32_t count = v->beside_begin[body + 1] - v->beside_begin[body];
        if (count < least) {
            least = count;
            best = body;
        }
    }
    return best;
}

static void put_mover(vibration *v, uint32_t body)
{
    const tl_bodies *b = &v->m->bodies;
    mover *to = &v->mover[v->movers];
    const tl_vec3 moments = tl_moments_of(v->m, body);
    *to = (mover){.body = body, .axes = tl_q_matrix(tl_q_mul(b->q[body], b->axes[body]))};
    for (unsigned k = 0; k < 6; k++) {
        const bool held = b->fixed[body] & (k < 3 ? 1u << k : (unsigned)TL_FIX_ROTATION);
        to->freedom[k] = held ? NO_FREEDOM : v->size++;
        to->per[k] = 1 / sqrt(k < 3 ? b->mass[body] : (&moments.x)[k - 3]);
    }
    v->number[body] = (uint32_t)v->movers++;
}

/* Numbers the freedoms. */
static void list_movers(vibration *v)
{
    size_t count = 0;
    memset(v->number, 0xff, v->m->bodies.table.rows * sizeof *v->number);
    for (uint32_t first; (first = choose_first(v)) != TL_NO_ROW;)
        count = reach(v, first, count);
    for (size_t k = count; k-- > 0;)
        put_mover(v, v->queue[k]);
}

/* The first freedom that a mover shares a spring with. */
static size_t first_of(const vibration *v, size_t k, size_t own)
{
    uint32_t least = (uint32_t)k;
    const uint32_t body = v->mover[k].body;
    for (uint32_t i = v->beside_begin[body]; i < v->beside_begin[body + 1]; i++) {
        const uint32_t other = v->number[v->beside[i]];
        least = other < least ? other : least;
    }
    for (; least <= k; least++)
        for (int d = 0; d < 6; d++)
            if (v->mover[least].freedom[d] != NO_FREEDOM)
                return v->mover[least].freedom[d];
    return own;
}

static tl_status make_matrix(vibration *v)
{
    size_t *first = malloc((v->size + 1) * sizeof *first);
    double entries = 0;
    for (size_t k = 0; first && k < v->movers; k++)
        for (int d = 0; d < 6; d++) {
            const size_t own = v->mover[k].freedom[d];
            if (own == NO_FREEDOM)
                continue;
            first[own] = first_of(v, k, own);
            entries += (double)(own - first[own] + 1);
        }
    if (!first || entries > MOST_ENTRIES || !tl_skyline_make(&v->k, v->size, first)) {
        if (first != v->k.first)
            free(first);
        return first && entries > MOST_ENTRIES
                   ? tl_fail(
                         &v->m->error, TL_E_ARGUMENT,
                         "modes: the stiffness of the %zu free bodies would have %.3g numbers, above %.3g: hold what "
                         "need not vibrate",
                         v->movers, entries, MOST_ENTRIES)
                   : tl_fail_memory(&v->m->error);
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- stiffness --------------- */

/* Motions of both bodies of a contact that a spring resists: freedoms, and how much each stretches it. */
typedef struct spring_row {
    size_t freedom[12];
    double by[12];
} spring_row;

static void put_side(const vibration *v, uint32_t body, tl_vec3 along, tl_vec3 about, spring_row *row, size_t at)
{
    const uint32_t number = v->number[body];
    const mover *of = number == TL_NO_ROW ? NULL : &v->mover[number];
    const tl_vec3 turned = of ? tl_m3_tmul(&of->axes, about) : about;
    for (size_t k = 0; k < 6; k++) {
        row->freedom[at + k] = of ? of->freedom[k] : NO_FREEDOM;
        row->by[at + k] = of ? of->per[k] * (k < 3 ? (&along.x)[k] : (&turned.x)[k - 3]) : 0;
    }
}

static void add_row(vibration *v, double k, const spring_row *row)
{
    for (size_t i = 0; i < 12; i++)
        for (size_t j = 0; j < 12; j++)
            if (row->freedom[i] != NO_FREEDOM && row->freedom[j] != NO_FREEDOM && row->freedom[j] <= row->freedom[i])
                *tl_skyline_at(&v->k, row->freedom[i], row->freedom[j]) += k * row->by[i] * row->by[j];
}

/* A contact as its springs are added: its bodies, and from A's centroid to B's. */
typedef struct joint_at {
    tl_sides on;
    tl_vec3 apart;
} joint_at;

/* A spring along e at an arm from A. */
static void add_spring(vibration *v, const joint_at *c, double k, tl_vec3 e, tl_vec3 arm)
{
    spring_row row;
    const tl_vec3 arm_b = tl_v3_sub(arm, c->apart);
    put_side(v, c->on.a, tl_v3_neg(e), tl_v3_neg(tl_v3_cross(arm, e)), &row, 0);
    put_side(v, c->on.b, e, tl_v3_cross(arm_b, e), &row, 6);
    add_row(v, k, &row);
}

/* One that resists turning about e. */
static void add_turn(vibration *v, const joint_at *c, double k, tl_vec3 e)
{
    spring_row row;
    const tl_vec3 none = {0, 0, 0};
    put_side(v, c->on.a, none, tl_v3_neg(e), &row, 0);
    put_side(v, c->on.b, none, e, &row, 6);
    add_row(v, k, &row);
}

/* Whether a point, at rest, resists small motions. */
static bool resists(const vibration *v, const tl_law *law, size_t row)
{
    const tl_points_table *p = &v->m->detect->points;
    const bool lost = p->flags[row] & (TL_POINT_OPEN | TL_POINT_APART);
    return p->f_n[row] != 0 || (!lost && tl_law_may_pull(law, p->flags[row]));
}

static void add_patch(vibration *v, uint32_t contact, const joint_at *c, const tl_law *law)
{
    const tl_contacts *contacts = &v->m->detect->contacts;
    const tl_points_table *p = &v->m->detect->points;
    const tl_vec3 n = contacts->facet[contact].last, e = tl_facing_aside(n), g = tl_v3_cross(n, e);
    for (size_t i = 0; i < contacts->point_count[contact]; i++) {
        const size_t row = tl_point_row(contacts, contact, i);
        if (!resists(v, law, row))
            continue;
        const tl_vec3 arm = tl_contact_point_arm(v->m, contact, i);
        const double ks = p->flags[row] & TL_POINT_SLIPPING ? 0 : law->ks * p->area[row];
        add_spring(v, c, law->kn * p->area[row], n, arm);
        add_spring(v, c, ks, e, arm);
        add_spring(v, c, ks, g, arm);
    }
}

static void add_field(vibration *v, uint32_t contact, const joint_at *c, const tl_law *law)
{
    const tl_contacts *contacts = &v->m->detect->contacts;
    const tl_press *press = &tl_press_row_of(v->m, contact)->press;
    const size_t row = tl_point_row(contacts, contact, TL_FIELD_SHEAR);
    const tl_vec3 n = contacts->facet[contact].last, e = tl_facing_aside(n), g = tl_v3_cross(n, e);
    if (!resists(v, law, row))
        return;
    const tl_vec3 arm = tl_side_arm(v->m, tl_contact_sides(v->m, contact).a, press->point);
    const double ks = v->m->detect->points.flags[row] & TL_POINT_SLIPPING ? 0 : law->ks;
    const double turn = 0.5 * press->area * press->radius * press->radius;
    add_spring(v, c, law->kn * press->area, n, arm);
    add_spring(v, c, ks * press->area, e, arm);
    add_spring(v, c, ks * press->area, g, arm);
    add_turn(v, c, law->kn * turn, e);
    add_turn(v, c, law->kn * turn, g);
    add_turn(v, c, 2 * ks * turn, n);
}

static tl_status add_contacts(vibration *v)
{
    tl_model *m = v->m;
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        if (c->law[i] == TL_NO_ROW || c->point_count[i] == 0)
            continue;
        const tl_law *law = &m->joint_laws[c->law[i]];
        const joint_at at = {tl_contact_bodies(m, i), tl_sides_apart(m, tl_contact_sides(m, i))};
        if (v->number[at.on.a] == TL_NO_ROW && v->number[at.on.b] == TL_NO_ROW)
            continue;
        if (!tl_law_is_linear(law)) {
            char name[320];
            tl_contact_describe(m, i, name, sizeof name);
            return tl_fail(
                &m->error, TL_E_STATE,
                "modes: %s has the law '%s', whose stiffness is not that of a linear spring: give it such a law "
                "with the stiffness that it has there",
                name, law->kind->name);
        }
        if (tl_facet_is_field(&c->facet[i]))
            add_field(v, i, &at, law);
        else
            add_patch(v, i, &at, law);
    }
    return TL_OK;
}

/* How a freedom of a mover moves it, in the order of a tangent. */
static void motion_by(const mover *of, unsigned k, double by[6])
{
    for (unsigned i = 0; i < 6; i++)
        by[i] = i / 3 != k / 3 ? 0 : of->per[k] * (k < 3 ? i == k : of->axes.m[i - 3][k - 3]);
}

/* Adds what resists mover j, at body `to` of a tangent, when mover i, at body `from`, moves. */
static void add_block(vibration *v, const tl_element_tangent *t, uint32_t from, uint32_t to)
{
    const mover *a = &v->mover[v->number[t->body[from]]], *b = &v->mover[v->number[t->body[to]]];
    const size_t width = 6 * (size_t)t->count;
    double x[6], y[6];
    for (unsigned i = 0; i < 6; i++)
        for (unsigned j = 0; j < 6; j++) {
            if (a->freedom[i] == NO_FREEDOM || b->freedom[j] == NO_FREEDOM || b->freedom[j] > a->freedom[i])
                continue;
            double sum = 0;
            motion_by(a, i, x);
            motion_by(b, j, y);
            for (size_t k = 0; k < 36; k++)
                sum += x[k / 6] * t->k[(6 * from + k / 6) * width + 6 * to + k % 6] * y[k % 6];
            *tl_skyline_at(&v->k, a->freedom[i], b->freedom[j]) += sum;
        }
}

static tl_status add_elements(vibration *v)
{
    const size_t rows = v->m->elements ? v->m->elements->table.table.rows : 0;
    tl_element_tangent t = {.body = NULL};
    tl_status status = TL_OK;
    for (uint32_t row = 0; row < rows && status == TL_OK; row++) {
        status = tl_element_tangent_find(v->m, row, &t);
        for (uint32_t i = 0; status == TL_OK && t.internal && i < t.count; i++)
            for (uint32_t k = 0; k < t.count; k++)
                add_block(v, &t, i, k);
    }
    tl_element_tangent_free(&t);
    return status;
}

/* Adds a little stiffness to the diagonal, and gives it. */
static double add_little(vibration *v)
{
    double sum = 0;
    for (size_t i = 0; i < v->size; i++)
        sum += *tl_skyline_at(&v->k, i, i);
    const double little = sum > 0 ? ADDED * sum / (double)v->size : 1;
    for (size_t i = 0; i < v->size; i++)
        *tl_skyline_at(&v->k, i, i) += little;
    return little;
}

/* ---------------------------------------------------------------- shapes ------------------ */

/* The motion of a mover in a shape of freedoms. */
static void motion_of(const mover *of, const double *shape, tl_vec3 *shift, tl_vec3 *turn)
{
    double x[6];
    for (int k = 0; k < 6; k++)
        x[k] = of->freedom[k] == NO_FREEDOM ? 0 : of->per[k] * shape[of->freedom[k]];
    *shift = tl_v3(x[0], x[1], x[2]);
    *turn = tl_m3_mul(&of->axes, tl_v3(x[3], x[4], x[5]));
}

/* Shares of the free mass that go with a base. */
static void find_masses(const vibration *v, const double *shape, tl_mode *mode)
{
    double with[3] = {0, 0, 0}, all[3] = {0, 0, 0};
    for (size_t k = 0; k < v->movers; k++)
        for (int axis = 0; axis < 3; axis++) {
            const mover *of = &v->mover[k];
            if (of->freedom[axis] == NO_FREEDOM)
                continue;
            with[axis] += shape[of->freedom[axis]] / of->per[axis];
            all[axis] += 1 / (of->per[axis] * of->per[axis]);
        }
    for (int axis = 0; axis < 3; axis++)
        mode->mass[axis] = all[axis] > 0 ? with[axis] * with[axis] / all[axis] : 0;
}

/* Of the blocks, so that the largest is 1 and, of the components of that, the largest is positive. */
static void put_shape(const vibration *v, const double *shape, const tl_modes *all, tl_mode *mode)
{
    const tl_model *m = v->m;
    double most = 0, most_turn = 0, sign = 1;
    for (size_t i = 0; i < all->block_count; i++) {
        const uint32_t row = tl_block_row_quiet(m, all->block[i]), body = m->blocks.body[row];
        motion_of(&v->mover[v->number[body]], shape, &mode->shift[i], &mode->turn[i]);
        const tl_vec3 arm = tl_v3_sub(tl_block_place(m, row), tl_body_place(&m->bodies, body));
        mode->shift[i] = tl_v3_add(mode->shift[i], tl_v3_cross(mode->turn[i], arm));
        for (int axis = 0; axis < 3; axis++) {
            const double part = (&mode->shift[i].x)[axis];
            if (fabs(part) > most) {
                most = fabs(part);
                sign = part < 0 ? -1 : 1;
            }
            most_turn = fmax(most_turn, fabs((&mode->turn[i].x)[axis]));
        }
    }
    const double by = most > 0 ? sign / most : most_turn > 0 ? 1 / most_turn : 1;
    for (size_t i = 0; i < all->block_count; i++) {
        mode->shift[i] = tl_v3_scale(by, mode->shift[i]);
        mode->turn[i] = tl_v3_scale(by, mode->turn[i]);
    }
}

static bool make_result(const vibration *v, size_t count, tl_modes *out)
{
    const tl_blocks *blocks = &v->m->blocks;
    for (uint32_t row = 0; row < blocks->table.rows; row++)
        out->block_count += v->number[blocks->body[row]] != TL_NO_ROW;
    out->block = malloc((out->block_count + 1) * sizeof *out->block);
    out->mode = calloc(count + 1, sizeof *out->mode);
    out->memory = calloc(2 * count * out->block_count + 1, sizeof *out->memory);
    if (!out->block || !out->mode || !out->memory)
        return false;
    size_t at = 0;
    for (uint32_t row = 0; row < blocks->table.rows; row++)
        if (v->number[blocks->body[row]] != TL_NO_ROW)
            out->block[at++] = blocks->id[row];
    for (size_t k = 0; k < count; k++) {
        out->mode[k].shift = out->memory + 2 * k * out->block_count;
        out->mode[k].turn = out->mode[k].shift + out->block_count;
    }
    out->count = count;
    return true;
}

static tl_status find(vibration *v, size_t count, tl_modes *out)
{
    const double little = add_little(v);
    count = count < v->size ? count : v->size;
    double *value = malloc(count * sizeof *value), *vector = malloc(count * v->size * sizeof *vector);
    tl_status status = TL_OK;
    if (tl_skyline_factor(&v->k, 0) > 0)
        status = tl_fail(&v->m->error, TL_E_NUMERIC, "modes: stiffnesses and masses are too far apart in size");
    else if (!value || !vector || !make_result(v, count, out) || !tl_skyline_lowest(&v->k, count, value, vector))
        status = tl_fail_memory(&v->m->error);
    for (size_t k = 0; status == TL_OK && k < count; k++) {
        const double square = value[k] - little;
        out->mode[k].frequency = square > 10 * little ? sqrt(square) / (2 * PI) : 0;
        find_masses(v, vector + k * v->size, &out->mode[k]);
        put_shape(v, vector + k * v->size, out, &out->mode[k]);
    }
    free(value);
    free(vector);
    return status;
}

/* ---------------------------------------------------------------- the call ---------------- */

static tl_status check(tl_model *m, size_t count)
{
    if (count < 1 || count > TL_MODES_MOST)
        return tl_fail(&m->error, TL_E_ARGUMENT, "modes: count = %zu is outside 1 to %d", count, TL_MODES_MOST);
    if (tl_model_deforms(m))
        return tl_fail(&m->error, TL_E_STATE,
                       "modes: the model has deformable blocks, whose zones are not counted: use "
                       "rigid blocks, or measure frequencies in a run");
    if (!m->cycle || !m->detect || m->cycles == 0 || m->detect->structure != m->structure)
        return tl_fail(&m->error, TL_E_STATE,
                       "modes: the model has not been run since its blocks were made: bring it to rest "
                       "first");
    const double ratio = tl_model_balance(m).ratio_local;
    if (!(ratio <= AT_REST))
        return tl_fail(
            &m->error, TL_E_STATE,
            "modes: the model is not at rest (an unbalanced force is %.3g of what its block bears, above %g): "
            "solve or relax first",
            ratio, AT_REST);
    return TL_OK;
}

tl_status tl_model_modes(tl_model *m, size_t count, tl_modes *modes)
{
    *modes = (tl_modes){.count = 0};
    tl_status status = check(m, count);
    if (status != TL_OK)
        return status;
    const size_t rows = m->bodies.table.rows;
    vibration v = {.m = m,
                   .mover = malloc((rows + 1) * sizeof *v.mover),
                   .number = malloc((rows + 1) * sizeof *v.number),
                   .queue = malloc((rows + 1) * sizeof *v.queue)};
    status = v.mover && v.number && v.queue && list_beside(&v) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK) {
        list_movers(&v);
        if (v.size == 0)
            status = tl_fail(&m->error, TL_E_STATE, "modes: all blocks are held: nothing can vibrate");
    }
    if (status == TL_OK)
        status = make_matrix(&v);
    if (status == TL_OK)
        status = add_contacts(&v);
    if (status == TL_OK)
        status = add_elements(&v);
    if (status == TL_OK)
        status = find(&v, count, modes);
    tl_skyline_free(&v.k);
    free(v.mover);
    free(v.number);
    free(v.queue);
    free(v.beside);
    free(v.beside_begin);
    return status;
}

void tl_modes_free(tl_modes *modes)
{
    free(modes->block);
    free(modes->mode);
    free(modes->memory);
    *modes = (tl_modes){.count = 0};
}
