/* split.c - the parts of a body that cuts have split go on as the whole did.
 *
 * In the step after a cut the forces on the faces that were there are known: those on the whole, at the present places.
 * Newton and Euler give its acceleration a and angular acceleration, r from the whole's centroid:
 *
 *     a = F / M,    I alpha + w x I w = T
 *
 * and what each part p of it needs:
 *
 *     F_p = m_p [a + alpha x r_p + w x (w x r_p)],    T_p = I_p alpha + w x I_p w
 *
 * That is what acts on it in this step. So its parts go on as the whole over all of the kick: that spans half of the
 * last step, in which they were one. What the new faces press on each other with to bring that is found at the same
 * time. As far as the laws bear it, it is their force at the beginning. From the next step on the laws decide. Only
 * then may parts that no joint can hold begin to move on their own.
 *
 * Parts of a body that is partly held get the tractions of its mean stress, where the model has an initial stress. */
#include "cycle/split.h"

#include "base/columns.h"
#include "base/exact.h"
#include "contact/body_contacts.h"
#include "contact/contacts.h"
#include "contact/kind.h"
#include "contact/places.h"
#include "contact/store.h"
#include "cycle/gather.h"
#include "model/inertia.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct tl_split_contact {
    uint32_t row, a, b; /* row of the contact; parts */
    size_t first;       /* of its points */
} tl_split_contact;

/* A contact point between two parts: the motion of A against B makes a traction on B. */
typedef struct tl_split_point {
    uint32_t a, b; /* parts */
    double area;
    tl_vec3 arm_a, arm_b, n; /* from the parts' centroids; A to B */
    double normal, shear;    /* stiffness now, 0 or 1: of tractions that the law bears */
} tl_split_point;

/* A body that is a part of one that was split. */
typedef struct tl_split_part {
    uint32_t body;
    uint32_t listed;   /* place before parts were put in the order of wholes */
    bool goes;         /* it goes on as the whole does */
    uint32_t whole;    /* first part of those that new contacts hold together */
    double mass, area; /* as forces meet it; of its new faces */
    double size;       /* radius */
    tl_mat3 inertia;   /* axes of the model */
    tl_vec3 place;
    tl_wrench outer;            /* forces that act on it but for those of the new faces */
    tl_wrench wanted;           /* what lets it go on as the whole */
    tl_vec3 turn_v, turn_w;     /* what is to be added to its velocities: see find_turn */
    tl_wrench way, step, image; /* of the solver: small motions, and their forces */
    tl_wrench lacks, preconditioned;
} tl_split_part;

/* Parts that new contacts hold together. Tractions: `start` before, `given` asked for, `borne` by the laws. */
typedef struct tl_split_system {
    const tl_model *m;
    tl_split_part *parts;
    tl_split_contact *contacts;
    tl_split_point *points; /* `a` and `b` count from the system's first part */
    tl_traction *start, *given, *borne, *best;
    size_t part_count, contact_count, point_count;
    double stored; /* energy of the springs, J */
} tl_split_system;

/* ---------------------------------------------------------------- tractions between parts ---
 *
 * The tractions on the new faces of a body that was split.
 *
 * Wanted are tractions t that the laws bear and that bring to each part the force and moment it lacks. Of those the
 * nearest to the tractions t0 of the mean stress are taken, in the mean of squares over the faces:
 *
 *     least  int |t - t0|^2 dA    with    sum over the faces of a part of (t, x cross t) = what it lacks
 *
 * Then t - t0 is what springs of one stiffness would carry if the parts made small motions w:
 *
 *     t(x) = t0 + w_A(x) - w_B(x),    K w = what is lacking
 *
 * K is that of springs over all faces. Conjugate gradients solve it: linear tractions, in few steps, for a tree of cuts
 * exactly. Where a law does not bear t (a joint that cannot pull, or slips), its points lose that stiffness. The rest
 * is found again, by Newton's method with a line search. It ends when nothing lacks. Where no tractions do that the
 * best is kept that was met: it leaves the least acceleration of the parts, in the mean of m a^2. */

/* Tolerance: stiffness of springs that hold each part, over that of its faces: motions that no face resists stay
 * bounded. What lacks is wrong by that share at the most. Test: lua/test_cut_keeps. */
#define HOLD 1e-9
/* Tolerance: share of what was wanted whose lack is rounding. */
#define NOTHING 1e-11
/* Tolerance: share of a traction that a law may change of it for rounding. */
#define SAME_TRACTION 1e-10
/* Tolerance: rounds of Newton's method, and halvings of its step. It ends, too, when so many rounds leave more than
 * the last share of what lacks. Test: lua/test_cut_keeps. */
#define MOST_ROUNDS 60
#define MOST_HALVINGS 6
#define MOST_IDLE 6
#define LESS 0.98
/* Tolerance: rounding of conjugate gradients. Test: lua/test_cut_keeps. */
#define SOLVED 1e-13
/* Conjugate gradients take as many steps as there are unknowns, six a part, but for rounding. */
#define CG_STEPS(parts) (60 + 12 * (parts))

/* ---------------------------------------------------------------- springs ---------------- */

/* Traction on B at a point for small motions of both parts. */
static tl_vec3 spring(const tl_split_point *p, const tl_wrench *a, const tl_wrench *b)
{
    tl_vec3 way = tl_v3_sub(tl_v3_add(a->force, tl_v3_cross(a->moment, p->arm_a)),
                            tl_v3_add(b->force, tl_v3_cross(b->moment, p->arm_b)));
    double along = tl_v3_dot(way, p->n);
    return tl_v3_madd(tl_v3_scale(p->shear, way), (p->normal - p->shear) * along, p->n);
}

static void add(tl_wrench *to, double by, tl_vec3 force, tl_vec3 arm)
{
    to->force = tl_v3_madd(to->force, by, force);
    to->moment = tl_v3_madd(to->moment, by, tl_v3_cross(arm, force));
}

/* image = K step */
static void times_stiffness(tl_split_system *s)
{
    for (size_t i = 0; i < s->part_count; i++) {
        tl_split_part *p = &s->parts[i];
        double hold = HOLD * p->area;
        p->image.force = tl_v3_scale(hold, p->step.force);
        p->image.moment = tl_v3_scale(hold * p->size * p->size, p->step.moment);
    }
    for (size_t k = 0; k < s->point_count; k++) {
        const tl_split_point *p = &s->points[k];
        tl_split_part *a = &s->parts[p->a], *b = &s->parts[p->b];
        tl_vec3 t = spring(p, &a->step, &b->step);
        add(&a->image, p->area, t, p->arm_a);
        add(&b->image, -p->area, t, p->arm_b);
    }
}

static double dot(const tl_wrench *x, const tl_wrench *y)
{
    return tl_v3_dot(x->force, y->force) + tl_v3_dot(x->moment, y->moment);
}

static tl_wrench plus(tl_wrench x, double by, tl_wrench y)
{
    return (tl_wrench){tl_v3_madd(x.force, by, y.force), tl_v3_madd(x.moment, by, y.moment)};
}

/* Makes parts of all sizes alike. */
static tl_wrench precondition(const tl_split_part *p, tl_wrench x)
{
    double per = p->area > 0 ? 1 / p->area : 0;
    return (tl_wrench){tl_v3_scale(per, x.force), tl_v3_scale(per / (p->size * p->size), x.moment)};
}

/* Solves K way = -lacks: springs bring -K w. Overwrites `lacks`. */
static void solve_linear(tl_split_system *s)
{
    const tl_wrench none = {{0, 0, 0}, {0, 0, 0}};
    double rz = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        tl_split_part *p = &s->parts[i];
        p->lacks = plus(none, -1, p->lacks);
        p->way = none;
        p->step = precondition(p, p->lacks);
        rz += dot(&p->lacks, &p->step);
    }
    const double least = rz * SOLVED * SOLVED;
    for (size_t k = 0; k < CG_STEPS(s->part_count) && rz > least; k++) {
        double curve = 0, next = 0;
        times_stiffness(s);
        for (size_t i = 0; i < s->part_count; i++)
            curve += dot(&s->parts[i].step, &s->parts[i].image);
        if (!(curve > 0))
            return;
        for (size_t i = 0; i < s->part_count; i++) {
            tl_split_part *p = &s->parts[i];
            p->way = plus(p->way, rz / curve, p->step);
            p->lacks = plus(p->lacks, -rz / curve, p->image);
            p->preconditioned = precondition(p, p->lacks);
            next += dot(&p->lacks, &p->preconditioned);
        }
        for (size_t i = 0; i < s->part_count; i++)
            s->parts[i].step = plus(s->parts[i].preconditioned, next / rz, s->parts[i].step);
        rz = next;
    }
}

/* ---------------------------------------------------------------- laws ------------------- */

/* Sets `borne` to what the laws bear of `given`, and what their springs hold; false: a law failed. */
static bool split_bear(tl_split_system *s)
{
    s->stored = 0;
    for (size_t i = 0; i < s->contact_count; i++) {
        const tl_split_contact *c = &s->contacts[i];
        double stored;
        if (!tl_contact_bear(s->m, c->row, &s->given[c->first], &s->borne[c->first], &stored))
            return false;
        s->stored += stored;
    }
    return true;
}

/* What the parts lack with what is borne; returns the sum of the squares of the accelerations, times mass. */
static double find_lacking(tl_split_system *s)
{
    double sum = 0;
    for (size_t i = 0; i < s->part_count; i++)
        s->parts[i].lacks = plus(s->parts[i].wanted, -1, s->parts[i].outer);
    for (size_t k = 0; k < s->point_count; k++) {
        const tl_split_point *p = &s->points[k];
        tl_vec3 t = tl_v3_madd(s->borne[k].shear, s->borne[k].normal, p->n);
        add(&s->parts[p->a].lacks, p->area, t, p->arm_a);
        add(&s->parts[p->b].lacks, -p->area, t, p->arm_b);
    }
    for (const tl_split_part *p = s->parts; p < s->parts + s->part_count; p++)
        sum += (tl_v3_norm2(p->lacks.force) + tl_v3_norm2(p->lacks.moment) / (p->size * p->size)) / p->mass;
    return sum;
}

/* given = from + by times the tractions of `way`, in full where a point has lost its stiffness, too. */
static void give(tl_split_system *s, const tl_traction *from, double by)
{
    for (size_t k = 0; k < s->point_count; k++) {
        tl_split_point p = s->points[k];
        p.normal = p.shear = 1;
        tl_vec3 t = spring(&p, &s->parts[p.a].way, &s->parts[p.b].way);
        double along = tl_v3_dot(t, p.n);
        s->given[k].normal = from[k].normal + by * along;
        s->given[k].shear = tl_v3_madd(from[k].shear, by, tl_v3_madd(t, -along, p.n));
    }
}

/* Takes the stiffness of the points at which the laws bear less than what is given; true: of some. */
static bool soften(tl_split_system *s)
{
    double most = 0;
    bool any = false;
    for (size_t k = 0; k < s->point_count; k++)
        most = fmax(most, fabs(s->given[k].normal) + tl_v3_norm(s->given[k].shear));
    for (size_t k = 0; k < s->point_count; k++) {
        tl_split_point *p = &s->points[k];
        double along = fabs(s->borne[k].normal - s->given[k].normal);
        double across = tl_v3_norm(tl_v3_sub(s->borne[k].shear, s->given[k].shear));
        p->normal = along > SAME_TRACTION * most ? 0 : 1;
        p->shear = across > SAME_TRACTION * most ? 0 : 1;
        any = any || p->normal < 1 || p->shear < 1;
    }
    return any;
}

static void stiffen(tl_split_system *s)
{
    for (size_t k = 0; k < s->point_count; k++)
        s->points[k].normal = s->points[k].shear = 1;
}

/* Gives `from` and `by` times the tractions of `way`; what lacks then, or NAN: a law failed. */
static double try_step(tl_split_system *s, const tl_traction *from, double by)
{
    give(s, from, by);
    return split_bear(s) ? find_lacking(s) : NAN;
}

/* Goes on from the tractions that were given by what brings what lacks. With `search` by less until less lacks, or by
 * more as long as ever less does, or not at all. `from` is scratch. Returns what lacks then, or NAN: a law failed. */
static double go_on(tl_split_system *s, bool search, double lacking, tl_traction *from)
{
    memcpy(from, s->given, s->point_count * sizeof *from);
    find_lacking(s);
    solve_linear(s);
    double by = 1, now = try_step(s, from, by);
    if (!search)
        return now;
    if (now < lacking) {
        for (int k = 0; k < MOST_HALVINGS; k++, by *= 2) {
            double next = try_step(s, from, 2 * by);
            if (!(next < now))
                return isnan(next) ? next : try_step(s, from, by);
            now = next;
        }
        return now;
    }
    for (int k = 0; k < MOST_HALVINGS && now >= lacking; k++)
        now = try_step(s, from, by *= 0.5);
    return now < lacking || isnan(now) ? now : try_step(s, from, 0);
}

/* Finds tractions that the laws bear and that bring what the parts lack, or as much as can be; false: a law failed. */
static bool split_solve(tl_split_system *s)
{
    double wanted = 0, least = INFINITY, lacking;
    for (const tl_split_part *p = s->parts; p < s->parts + s->part_count; p++)
        wanted += (tl_v3_norm2(p->wanted.force) + tl_v3_norm2(p->outer.force)) / p->mass;
    memcpy(s->given, s->start, s->point_count * sizeof *s->start);
    memcpy(s->borne, s->start, s->point_count * sizeof *s->start);
    stiffen(s);
    lacking = go_on(s, false, INFINITY, s->start);
    for (int round = 0, idle = 0; round < MOST_ROUNDS && idle < MOST_IDLE; round++) {
        idle = lacking < LESS * least ? 0 : idle + 1;
        if (lacking < least) {
            least = lacking;
            memcpy(s->best, s->borne, s->point_count * sizeof *s->best);
        }
        if (lacking <= NOTHING * NOTHING * wanted || !soften(s))
            break;
        double next = go_on(s, true, lacking, s->start);
        if (!(next < lacking)) {
            stiffen(s);
            next = go_on(s, false, next, s->start);
        }
        lacking = next;
        if (isnan(lacking))
            return false;
    }
    memcpy(s->given, s->best, s->point_count * sizeof *s->best);
    return !isnan(lacking) && split_bear(s); /* once more, for the energy */
}

/* ---------------------------------------------------------------- what there is ---------- */

struct tl_split_work {
    tl_split_part *parts; /* whole by whole, by ascending body in each */
    tl_split_contact *contacts;
    tl_split_point *points;
    tl_traction *tractions; /* four for each point */
    size_t part_count, contact_count, point_count;
};

/* The body that all blocks of a body were in, or TL_NO_ID. */
static tl_id whole_of(const tl_model *m, uint32_t body)
{
    const uint32_t *rows = tl_body_blocks(m, body);
    tl_id whole = tl_split_of(m, m->blocks.id[rows[0]]);
    for (uint32_t k = 1; k < m->bodies.member_count[body]; k++)
        if (tl_split_of(m, m->blocks.id[rows[k]]) != whole)
            return TL_NO_ID;
    return whole;
}

/* The part that is a body; parts are in the order of bodies. */
static uint32_t part_of(const struct tl_split_work *w, uint32_t body)
{
    size_t low = 0, high = w->part_count;
    while (low + 1 < high) {
        size_t middle = low + (high - low) / 2;
        if (w->parts[middle].body <= body)
            low = middle;
        else
            high = middle;
    }
    return (uint32_t)low;
}

static tl_mat3 inertia_of(const tl_model *m, uint32_t body)
{
    tl_mat3 r = tl_q_matrix(tl_q_mul(m->bodies.q[body], m->bodies.axes[body])), out;
    const tl_vec3 own = tl_v3_scale(tl_turn_scale(m->cycle, body), tl_moments_of(m, body));
    const double i[3] = {own.x, own.y, own.z};
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            out.m[j][k] = r.m[j][0] * i[0] * r.m[k][0] + r.m[j][1] * i[1] * r.m[k][1] + r.m[j][2] * i[2] * r.m[k][2];
    return out;
}

/* Lists the parts, by ascending body: blocks ascend with them. */
static bool list_parts(const tl_model *m, struct tl_split_work *w)
{
    const tl_bodies *b = &m->bodies;
    w->parts = malloc((m->split_count + 1) * sizeof *w->parts);
    for (size_t i = 0; i < m->split_count && w->parts; i++) {
        uint32_t row = tl_block_row_quiet(m, m->splits[i].block);
        uint32_t body = row == TL_NO_ROW ? TL_NO_ROW : m->blocks.body[row];
        if (row == TL_NO_ROW || *tl_body_blocks(m, body) != row || whole_of(m, body) == TL_NO_ID)
            continue;
        w->parts[w->part_count] = (tl_split_part){.body = body,
                                                  .whole = (uint32_t)w->part_count,
                                                  .listed = (uint32_t)w->part_count,
                                                  .mass = b->mass[body] * tl_inertia_scale(m->cycle, body),
                                                  .size = b->radius[body],
                                                  .inertia = inertia_of(m, body),
                                                  .place = tl_body_place(b, body)};
        w->part_count++;
    }
    return w->parts;
}

/* The first of the parts that hang together with one. */
static uint32_t first_of(const struct tl_split_work *w, uint32_t part)
{
    while (w->parts[part].whole != part)
        part = w->parts[part].whole;
    return part;
}

/* Whether a contact is on new faces, between two parts of one whole. */
static bool is_inner(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    if (tl_facet_is_field(&contacts->facet[c]) || contacts->point_count[c] == 0 || contacts->law[c] == TL_NO_ROW)
        return false;
    const tl_sides on = tl_contact_bodies(m, c);
    tl_id whole = whole_of(m, on.a);
    return whole != TL_NO_ID && whole == whole_of(m, on.b);
}

/* Lists the contacts on new faces, in the order of their blocks, and joins the parts that they hold together. */
static bool list_contacts(const tl_model *m, struct tl_split_work *w)
{
    const tl_contacts *contacts = &m->detect->contacts;
    size_t capacity = 0;
    for (size_t i = 0; i < w->part_count; i++)
        for (tl_body_contacts at = tl_contacts_of_body(m, w->parts[i].body); tl_next_contact(&at);) {
            uint32_t c = at.contact;
            if (contacts->a[c] != at.block || !is_inner(m, c))
                continue;
            tl_split_contact found = {
                .row = c, .a = (uint32_t)i, .b = part_of(w, tl_contact_bodies(m, c).b), .first = w->contact_count};
            if (!tl_grow(&w->contacts, &capacity, w->contact_count + 1, sizeof *w->contacts))
                return false;
            w->contacts[w->contact_count++] = found;
            w->point_count += contacts->point_count[c];
            uint32_t a = first_of(w, found.a), b = first_of(w, found.b);
            w->parts[a < b ? b : a].whole = a < b ? a : b;
        }
    for (uint32_t i = 0; i < w->part_count; i++)
        w->parts[i].whole = first_of(w, i);
    return true;
}

static int compare_part(const void *x, const void *y)
{
    const tl_split_part *p = x, *q = y;
    return tl_pair_order(p->whole, p->body, q->whole, q->body);
}

static int compare_contact(const void *x, const void *y)
{
    const tl_split_contact *p = x, *q = y;
    return tl_pair_order(p->a, (uint32_t)p->first, q->a, (uint32_t)q->first);
}

/* Puts parts and contacts in the order of the wholes. */
static bool sort_wholes(struct tl_split_work *w)
{
    uint32_t *now = malloc((w->part_count + 1) * sizeof *now);
    if (!now)
        return false;
    qsort(w->parts, w->part_count, sizeof *w->parts, compare_part);
    for (size_t i = 0; i < w->part_count; i++)
        now[w->parts[i].listed] = (uint32_t)i;
    for (size_t i = 0; i < w->contact_count; i++) {
        w->contacts[i].a = now[w->contacts[i].a];
        w->contacts[i].b = now[w->contacts[i].b];
    }
    if (w->contact_count > 1)
        qsort(w->contacts, w->contact_count, sizeof *w->contacts, compare_contact);
    free(now);
    return true;
}

/* ---------------------------------------------------------------- motion of the whole ---- */

/* What parts that hang together are as one body. */
typedef struct whole {
    double mass;
    tl_vec3 centre, spin, spin_after; /* angular velocity now, and after this kick */
    tl_vec3 force, acceleration, angular;
    tl_mat3 inertia;
} whole;

/* The solution x of a x = b, a symmetric. */
static tl_vec3 solve3(const tl_mat3 *a, tl_vec3 b)
{
    return tl_solve3(tl_m3_column(a, 0), tl_m3_column(a, 1), tl_m3_column(a, 2), b);
}

/* w x I w */
static tl_vec3 gyration(const tl_mat3 *inertia, tl_vec3 w)
{
    return tl_v3_cross(w, tl_m3_mul(inertia, w));
}

static void add_inertia(tl_mat3 *to, const tl_split_part *p, tl_vec3 r)
{
    const double at[3] = {r.x, r.y, r.z}, r2 = tl_v3_norm2(r);
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            to->m[j][k] += p->inertia.m[j][k] + p->mass * ((j == k ? r2 : 0) - at[j] * at[k]);
}

/* The kick spans h, of which `until` lies before the present places. */
static whole whole_of_parts(const tl_model *m, const tl_split_part *parts, size_t count, double h, double until)
{
    const tl_bodies *b = &m->bodies;
    whole all = {.mass = 0};
    tl_vec3 momentum = {0, 0, 0}, turning = {0, 0, 0}, torque = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const tl_split_part *p = &parts[i];
        all.mass += p->mass;
        all.centre = tl_v3_madd(all.centre, p->mass, tl_v3_sub(p->place, parts[0].place));
        all.force = tl_v3_add(all.force, p->outer.force);
        momentum = tl_v3_madd(momentum, p->mass, b->v[p->body]);
    }
    all.centre = tl_v3_madd(parts[0].place, 1 / all.mass, all.centre);
    tl_vec3 v = tl_v3_scale(1 / all.mass, momentum);
    for (size_t i = 0; i < count; i++) {
        const tl_split_part *p = &parts[i];
        tl_vec3 r = tl_v3_sub(p->place, all.centre);
        add_inertia(&all.inertia, p, r);
        tl_vec3 moves = tl_v3_scale(p->mass, tl_v3_sub(b->v[p->body], v));
        turning = tl_v3_add(turning, tl_m3_mul(&p->inertia, b->w[p->body]));
        turning = tl_v3_add(turning, tl_v3_cross(r, moves));
        torque = tl_v3_add(torque, tl_v3_add(p->outer.moment, tl_v3_cross(r, p->outer.force)));
    }
    all.acceleration = tl_v3_scale(1 / all.mass, all.force);
    all.spin = solve3(&all.inertia, tl_v3_madd(turning, until, torque));
    all.spin_after = solve3(&all.inertia, tl_v3_madd(turning, h, torque));
    all.angular = solve3(&all.inertia, tl_v3_sub(torque, gyration(&all.inertia, all.spin)));
    return all;
}

/* alpha x r + w x (w x r) */
static tl_vec3 turn_of(tl_vec3 angular, tl_vec3 spin, tl_vec3 r)
{
    return tl_v3_add(tl_v3_cross(angular, r), tl_v3_cross(spin, tl_v3_cross(spin, r)));
}

/* The forces of this step lie in the middle of the kick. Where they turn with the body that is wrong by what the turn
 * in the two half steps does to velocities. Those of the parts are found with their arms at the present places. They
 * are to be those of the middle of the next step, dt, in which the whole would turn freely. Finds the difference. */
static void find_turn(const whole *all, tl_split_part *p, tl_vec3 spin_before, double h, double dt)
{
    tl_vec3 r = tl_v3_sub(p->place, all->centre), w = all->spin_after;
    tl_vec3 free = tl_v3_neg(solve3(&all->inertia, gyration(&all->inertia, w)));
    tl_vec3 gained = tl_v3_sub(w, spin_before);
    tl_vec3 turned = tl_v3_madd(tl_v3_cross(gained, r), 0.5 * dt, turn_of(free, w, r));
    p->turn_v = tl_v3_madd(turned, -h, turn_of(all->angular, all->spin, r));
    tl_vec3 spun = tl_v3_add(tl_m3_mul(&p->inertia, free), gyration(&p->inertia, w));
    spun = tl_v3_madd(tl_m3_mul(&p->inertia, gained), 0.5 * dt, spun);
    p->turn_w = solve3(&p->inertia, tl_v3_madd(spun, -h, p->wanted.moment));
}

/* Finds what the parts need to go on as the whole in a kick that leads into a step of dt. */
static void find_wanted(const tl_model *m, tl_split_part *parts, size_t count, double dt)
{
    double until = 0.5 * m->dt, h = until + 0.5 * dt;
    whole all = whole_of_parts(m, parts, count, h, until);
    whole before = whole_of_parts(m, parts, count, 0, 0);
    for (size_t i = 0; i < count; i++) {
        tl_split_part *p = &parts[i];
        tl_vec3 r = tl_v3_sub(p->place, all.centre);
        tl_vec3 goes = tl_v3_add(all.acceleration, turn_of(all.angular, all.spin, r));
        p->wanted.force = tl_v3_scale(p->mass, goes);
        p->wanted.moment = tl_v3_add(tl_m3_mul(&p->inertia, all.angular), gyration(&p->inertia, all.spin));
        if (m->config.rotation == TL_ROTATION_EXACT)
            find_turn(&all, p, before.spin, h, dt);
    }
}

/* ---------------------------------------------------------------- tractions -------------- */

/* Adds x f of the contacts of a body, x from the whole's centroid, f on the body, but for those of new faces. */
static void add_stress(const tl_model *m, uint32_t body, tl_vec3 centre, tl_sym3 *sum)
{
    const tl_detect *d = m->detect;
    const tl_point_lanes *lanes = &d->lanes[0];
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        uint32_t c = at.contact;
        if (is_inner(m, c))
            continue;
        tl_contact_places(m, c, lanes);
        tl_vec3 from = tl_side_place(m, tl_contact_sides(m, c).a);
        size_t count = tl_contact_areas(d, c);
        double sign = tl_contact_sign(&d->contacts, c, at.block);
        for (size_t k = 0; k < count; k++) {
            size_t i = tl_point_row(&d->contacts, c, k);
            tl_vec3 f =
                tl_v3_madd(tl_columns_get(d->points.f_s, i), d->points.f_n[i], tl_columns_get(lanes->normal, k));
            f = tl_v3_scale(sign, f);
            tl_vec3 x = tl_v3_sub(tl_v3_add(from, tl_columns_get(lanes->arm, k)), centre);
            sum->xx += x.x * f.x;
            sum->yy += x.y * f.y;
            sum->zz += x.z * f.z;
            sum->xy += 0.5 * (x.x * f.y + x.y * f.x);
            sum->yz += 0.5 * (x.y * f.z + x.z * f.y);
            sum->zx += 0.5 * (x.z * f.x + x.x * f.z);
        }
    }
}

/* The mean stress in the whole under the contacts of its parts, tension positive: (1/V) sum x f. */
static tl_sym3 mean_stress(const tl_model *m, const tl_split_part *parts, size_t count)
{
    tl_sym3 sum = {0, 0, 0, 0, 0, 0};
    double volume = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t body = parts[i].body;
        add_stress(m, body, parts[0].place, &sum);
        for (uint32_t k = 0; k < m->bodies.member_count[body]; k++)
            volume += m->blocks.volume[tl_body_blocks(m, body)[k]];
    }
    return tl_s3_scale(1 / volume, sum);
}

/* The points of the contacts of a system, with the tractions of a stress. */
static void list_points(const tl_split_system *s, const tl_sym3 *stress)
{
    tl_detect *d = s->m->detect;
    const tl_point_lanes *lanes = &d->lanes[0];
    for (size_t i = 0; i < s->contact_count; i++) {
        const tl_split_contact *c = &s->contacts[i];
        tl_contact_places(s->m, c->row, lanes);
        for (size_t k = 0; k < d->contacts.point_count[c->row]; k++) {
            tl_split_point *p = &s->points[c->first + k];
            tl_split_part *a = &s->parts[c->a], *b = &s->parts[c->b];
            tl_vec3 arm = tl_columns_get(lanes->arm, k), n = tl_columns_get(lanes->normal, k);
            size_t row = tl_point_row(&d->contacts, c->row, k);
            double area = d->points.area[row];
            /* as it was made: what its law has made of roundings in this step would be there by chance */
            d->points.flags[row] &= TL_POINT_APART;
            tl_point_initial_state(&d->points, row, s->m->joint_laws[d->contacts.law[c->row]].kind);
            *p = (tl_split_point){.a = c->a, .b = c->b, .area = area, .arm_a = arm, .n = n};
            p->arm_b = tl_v3_sub(arm, tl_v3_sub(b->place, a->place));
            a->area += area;
            b->area += area;
            tl_vec3 t = tl_v3_neg(tl_s3_mul(*stress, n));
            tl_traction *start = &s->start[c->first + k];
            start->normal = tl_v3_dot(t, n);
            start->shear = tl_v3_madd(t, -start->normal, n);
        }
    }
}

/* Puts tractions on the points: their closure counts from the present place. */
static void load_contacts(tl_model *m, const tl_split_system *s)
{
    tl_detect *d = m->detect;
    tl_points_table *p = &d->points;
    const tl_point_lanes *lanes = &d->lanes[0];
    for (size_t i = 0; i < s->contact_count; i++) {
        uint32_t c = s->contacts[i].row;
        tl_vec3 force = {0, 0, 0}, moment = {0, 0, 0};
        tl_contact_places(m, c, lanes);
        for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
            size_t row = tl_point_row(&d->contacts, c, k);
            const tl_traction *t = &s->borne[s->contacts[i].first + k];
            double area = p->area[row];
            p->reference[row] += lanes->closure[k];
            p->f_n0[row] = p->f_n[row] = area * t->normal;
            tl_vec3 shear = tl_v3_scale(area, t->shear);
            tl_columns_put(p->f_s, row, shear);
            tl_vec3 f = tl_v3_madd(shear, p->f_n[row], tl_columns_get(lanes->normal, k));
            force = tl_v3_add(force, f);
            moment = tl_v3_add(moment, tl_v3_cross(tl_columns_get(lanes->arm, k), f));
        }
        d->contacts.force[c] = force;
        d->contacts.moment[c] = moment;
        d->contacts.stored[c] = NAN;
        d->contacts.holds_over_gap[c] = true; /* perhaps: the next step tells */
    }
}

/* ---------------------------------------------------------------- the step --------------- */

static bool some_held(const tl_model *m, const tl_split_part *parts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (m->bodies.fixed[parts[i].body])
            return true;
    return false;
}

/* A whole whose parts, contacts and points are those from the first given on. */
static tl_split_system system_of(const tl_model *m, const struct tl_split_work *w, size_t part, size_t contact,
                                 size_t point)
{
    tl_split_system s = {
        .m = m, .parts = w->parts + part, .contacts = w->contacts + contact, .points = w->points + point};
    while (part + s.part_count < w->part_count && s.parts[s.part_count].whole == s.parts[0].whole)
        s.part_count++;
    while (contact + s.contact_count < w->contact_count && s.contacts[s.contact_count].a < part + s.part_count) {
        tl_split_contact *c = &s.contacts[s.contact_count++];
        c->a -= (uint32_t)part;
        c->b -= (uint32_t)part;
        c->first = s.point_count;
        s.point_count += m->detect->contacts.point_count[c->row];
    }
    s.start = w->tractions + 4 * point;
    s.given = s.start + s.point_count;
    s.borne = s.given + s.point_count;
    s.best = s.borne + s.point_count;
    return s;
}

/* Lets the parts of a whole go on as it does. Parts that cannot all move get the tractions of the mean stress, as far
 * as the laws bear them, where there is an initial stress. */
static bool hold(tl_model *m, tl_split_system *s, bool stressed, double dt)
{
    bool held = some_held(m, s->parts, s->part_count);
    if (s->contact_count == 0 || (held && !stressed))
        return true;
    const tl_sym3 stress = mean_stress(m, s->parts, s->part_count);
    list_points(s, &stress);
    if (held)
        memcpy(s->given, s->start, s->point_count * sizeof *s->given);
    else
        find_wanted(m, s->parts, s->part_count, dt);
    if (held ? !split_bear(s) : !split_solve(s))
        return false;
    load_contacts(m, s);
    for (size_t i = 0; i < s->part_count; i++)
        s->parts[i].goes = !held;
    return true;
}

/* Whether some point has an initial force. */
static bool is_stressed(const tl_detect *d)
{
    for (size_t i = 0; i < d->points.table.rows; i++)
        if (d->points.f_n0[i] != 0)
            return true;
    return false;
}

static bool hold_all(tl_model *m, struct tl_split_work *w, double dt)
{
    bool stressed = is_stressed(m->detect);
    tl_addends stored = {.count = 0};
    for (size_t part = 0, contact = 0, point = 0; part < w->part_count;) {
        tl_split_system s = system_of(m, w, part, contact, point);
        if (!hold(m, &s, stressed, dt))
            return false;
        tl_addends_put(&stored, s.stored);
        part += s.part_count;
        contact += s.contact_count;
        point += s.point_count;
    }
    m->cycle->split_stored = tl_addends_sum(&stored);
    return true;
}

/* The parts and what is between them; false: out of memory. */
static bool find_parts(const tl_model *m, struct tl_split_work *w)
{
    if (!list_parts(m, w) || !list_contacts(m, w) || !sort_wholes(w))
        return false;
    w->points = malloc((w->point_count + 1) * sizeof *w->points);
    w->tractions = calloc(4 * w->point_count + 1, sizeof *w->tractions);
    return w->points && w->tractions;
}

bool tl_split_prepare(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    tl_split_free(c); /* of a step that failed */
    if (m->split_count == 0)
        return true;
    c->split = calloc(1, sizeof *c->split);
    return c->split && tl_detect_hold_initial(m->detect) && find_parts(m, c->split);
}

tl_status tl_split_hold(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    c->split_stored = 0;
    if (!c->split)
        return TL_OK;
    for (size_t i = 0; i < c->split->part_count; i++) {
        tl_split_part *p = &c->split->parts[i];
        p->outer = (tl_wrench){m->bodies.force[p->body], m->bodies.moment[p->body]};
    }
    if (!hold_all(m, c->split, dt))
        return tl_fail(&m->error, TL_E_NUMERIC,
                       "cycle %lld: the law of a new face failed when it was asked what the face "
                       "bears of the forces in the block that was cut",
                       (long long)m->cycles + 1);
    tl_gather(m); /* with what the new faces carry */
    for (size_t i = 0; i < c->split->part_count; i++) {
        const tl_split_part *p = &c->split->parts[i];
        if (!p->goes)
            continue;
        m->bodies.force[p->body] = p->wanted.force;
        m->bodies.moment[p->body] = p->wanted.moment;
    }
    return TL_OK;
}

void tl_split_turn(tl_model *m)
{
    const struct tl_split_work *w = m->cycle->split;
    for (size_t i = 0; w && i < w->part_count; i++) {
        const tl_split_part *p = &w->parts[i];
        if (!p->goes)
            continue;
        m->bodies.v[p->body] = tl_v3_add(m->bodies.v[p->body], p->turn_v);
        m->bodies.w[p->body] = tl_v3_add(m->bodies.w[p->body], p->turn_w);
    }
}

void tl_split_free(struct tl_cycle *c)
{
    struct tl_split_work *w = c->split;
    if (!w)
        return;
    free(w->parts);
    free(w->contacts);
    free(w->points);
    free(w->tractions);
    free(w);
    c->split = NULL;
}
