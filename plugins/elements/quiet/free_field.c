/* free_field.c - element "free_field": vertical sides of rigid blocks that move as the ground far away.
 *
 * Blocks in level rows on a side are cut off from ground that goes on for ever. That moves as one column of levels
 * (Cundall, Hansteen, Lacasse and Selnes 1980): the same lattice in one dimension. A level has the
 * height h, width w and density rho. Per area of its base its mass is rho h, its moment of inertia rho h (w^2 + h^2) /
 * 12. It moves by u and turns by t about the horizontal axis along the side. With e the outward normal it meets:
 *
 *     level above      (ks, kn) D,  D = u2 - u1 - (t1 h1 + t2 h2) / 2 e,     and the moment kn w^2 / 12 (t2 - t1)
 *     column beside    ks w t along z on both sides, and so the moment -ks h w t
 *     base             as behind a quiet face (half_space.h), with the wave that comes in, or it moves with its blocks
 *
 * Levels are integrated as blocks are, with their damping alpha and beta. A node of a side moves by v, and the point of
 * its level that is there by v_ff. With the impedance Z of the rock, behind the spring K of half a block,
 *
 *     f = Z (s' ) = K (d - s),  d' = v - v_ff,    force on the block = -f A + ks w t A z
 *
 * So waves that come from inside leave, and those of the free field go along the side as if nothing had been cut off.
 *
 * An element has the levels as its first nodes, on the ground, and then nodes of faces. Components in which the
 * blocks of a level are held follow those blocks. */
#include "half_space.h"
#include "kinds.h"

/* Limit: levels of a side. The nodes of 85 faces are left for an element. */
#define LEVELS 256
/* Limit: numbers of a face in the list: block, face, area, width, density and held components. */
#define ROW 6
/* Tolerance: over the height of a face, by so much its level may begin or end elsewhere. Test: lua/test_free_field. */
#define SAME_LEVEL 1e-3
/* Tolerance: z of the normal of a face that is vertical, and 1 - cosine of the angle between normals of one side. */
#define UPRIGHT 1e-4

/* Bits of components that are held, as the program has them. */
enum { HELD_X = 1, HELD_Y = 2, HELD_Z = 4, HELD_ALL_WAYS = 7, HELD_TURN = 8 };

/* What `create` makes of the parameters. */
typedef struct side_kind {
    wave wave[3]; /* first: half_space.h */
    free_field_params given;
    bool quiet; /* the base */
} side_kind;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const free_field_params *p = given;
    tl_status status = half_space_check(p->kn, p->ks, p->p_velocity, p->s_velocity, report);
    if (status != TL_OK)
        return status;
    const bool base_joint = !isnan(p->base_kn), base_rock = !isnan(p->base_p_velocity);
    if (base_joint != !isnan(p->base_ks) || base_rock != !isnan(p->base_s_velocity) || (base_joint && base_rock))
        return tl_refuse(report, "a quiet base has either base_kn and base_ks, or base_p_velocity and base_s_velocity");
    const char *const input[] = {p->input_x, p->input_y, p->input_z};
    status = half_space_order(p->base_p_velocity, p->base_s_velocity, report);
    if (status != TL_OK)
        return status;
    status = half_space_create(input, sizeof(side_kind), self, report);
    side_kind *k = *self;
    if (k) {
        k->given = *p;
        k->quiet = base_joint || base_rock;
    }
    return status;
}

/* ---------------------------------------------------------------- placing ---------------- */

/* A face of the side, between two heights. */
typedef struct side_face {
    const tl_element_face *face;
    const double *row;
    double low, high;
    size_t level;
} side_face;

/* A level to be: sums over its faces by their areas, until they are divided. */
typedef struct new_level {
    double low, high, area, width, density;
    unsigned held;
    const side_face *first;
} new_level;

typedef struct side {
    const tl_element_host *host;
    double *rows;
    size_t row_count;
    side_face *face;
    size_t face_count;
    new_level level[LEVELS];
    size_t level_count;
} side;

static int compare_faces(const void *a, const void *b)
{
    const side_face *x = a, *y = b;
    if (x->level != y->level)
        return x->level < y->level ? -1 : 1;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    return x->row < y->row ? -1 : x->row > y->row;
}

/* Whether a face ends below and above in level edges: at another height there is no corner. */
static bool is_level(const side_face *f)
{
    const double near = SAME_LEVEL * (f->high - f->low);
    for (size_t k = 0; k < f->face->corner_count; k++) {
        const double z = f->face->corners[k].z;
        if (z - f->low > near && f->high - z > near)
            return false;
    }
    return true;
}

/* Finds the faces of the list among the outer ones. */
static tl_status find_faces(side *s)
{
    const tl_element_face *faces;
    size_t count, from = 0;
    tl_status status = s->host->faces(s->host, NULL, tl_v3(0, 0, 0), 0, &faces, &count);
    for (size_t i = 0; status == TL_OK && i < count; i++) {
        const tl_element_face *f = &faces[i];
        const double *row = half_space_row(s->rows, ROW, s->row_count, &from, f);
        if (!row)
            continue;
        const tl_vec3 first = s->face_count ? s->face[0].face->normal : f->normal;
        side_face one = {.face = f, .row = row, .low = INFINITY, .high = -INFINITY};
        for (size_t k = 0; k < f->corner_count; k++) {
            one.low = fmin(one.low, f->corners[k].z);
            one.high = fmax(one.high, f->corners[k].z);
        }
        if (fabs(f->normal.z) > UPRIGHT || 1 - tl_v3_dot(first, f->normal) > UPRIGHT)
            status = s->host->fail(s->host, TL_E_GEOMETRY,
                                   "face %u of block %u has the normal (%g, %g, %g): all faces of a side that is a "
                                   "free field are vertical and look one way",
                                   f->face + 1, f->block, f->normal.x, f->normal.y, f->normal.z);
        else if (!is_level(&one))
            status = s->host->fail(s->host, TL_E_GEOMETRY,
                                   "block %u at the side has corners between z = %g and %g m, so its top or its foot "
                                   "slopes: blocks at a free field lie in level rows; cut the side level, or make it "
                                   "quiet",
                                   f->block, one.low, one.high);
        else if (!(row[2] > 0 && row[3] > 0 && row[4] > 0))
            status =
                s->host->fail(s->host, TL_E_ARGUMENT,
                              "face %u of block %u has area = %g m2, width = %g m and density = %g kg/m3: all must "
                              "be > 0",
                              f->face + 1, f->block, row[2], row[3], row[4]);
        else
            s->face[s->face_count++] = one;
    }
    if (status == TL_OK && s->face_count < s->row_count)
        status = s->host->fail(s->host, TL_E_NOT_FOUND,
                               "%zu of %zu faces are no outer faces: list faces of blocks that are there by ascending "
                               "blocks and faces",
                               s->row_count - s->face_count, s->row_count);
    return status;
}

/* Puts a face into the uppermost level, or begins one above it. */
static tl_status put_face(side *s, side_face *f)
{
    new_level *top = s->level_count ? &s->level[s->level_count - 1] : NULL;
    const double near = SAME_LEVEL * (f->high - f->low);
    if (!top || (fabs(f->low - top->high) <= near && fabs(f->low - top->low) > near)) {
        if (s->level_count == LEVELS)
            return s->host->fail(s->host, TL_E_ARGUMENT, "the side has more than %d rows of blocks", LEVELS);
        top = &s->level[s->level_count++];
        *top = (new_level){.low = f->low, .high = f->high, .held = (unsigned)f->row[5], .first = f};
    }
    if (fabs(f->low - top->low) > near || fabs(f->high - top->high) > near)
        return s->host->fail(s->host, TL_E_GEOMETRY,
                             "block %u reaches from z = %g to %g m at the side, and the row of block %u from %g to %g "
                             "m: blocks at a free field lie in level rows, one on the other without a gap",
                             f->face->block, f->low, f->high, top->first->face->block, top->low, top->high);
    if ((unsigned)f->row[5] != top->held)
        return s->host->fail(s->host, TL_E_STATE,
                             "blocks %u and %u of one row are held in different components: hold both alike",
                             top->first->face->block, f->face->block);
    const double *row = f->row;
    top->area += row[2];
    top->width += row[2] * row[3];
    top->density += row[2] * row[4];
    f->level = s->level_count;
    return TL_OK;
}

/* Sorts faces into levels, and looks at what holds these. */
static tl_status find_levels(side *s, bool quiet)
{
    tl_status status = TL_OK;
    qsort(s->face, s->face_count, sizeof *s->face, compare_faces);
    for (size_t i = 0; i < s->face_count && status == TL_OK; i++)
        status = put_face(s, &s->face[i]);
    for (size_t k = 0; k < s->level_count && status == TL_OK; k++) {
        new_level *l = &s->level[k];
        const bool held = (l->held & HELD_ALL_WAYS) == HELD_ALL_WAYS;
        const tl_id block = l->first->face->block;
        l->width /= l->area;
        l->density /= l->area;
        if (k == 0 && !held && !quiet)
            status = s->host->fail(s->host, TL_E_STATE,
                                   "block %u in the lowest row of the side is not held, and the base is not quiet: a "
                                   "free field needs a base that is driven or held, or zmin = {quiet = true} in the "
                                   "same call",
                                   block);
        if (k > 0 && held && (s->level[k - 1].held & HELD_ALL_WAYS) != HELD_ALL_WAYS)
            status = s->host->fail(s->host, TL_E_STATE,
                                   "block %u is held, and the row below it is not: a free field moves, so let the "
                                   "block go, or leave it out by a box",
                                   block);
        if (k + 1 == s->level_count && held)
            status = s->host->fail(s->host, TL_E_STATE, "all blocks of the side are held: a free field moves");
    }
    return status;
}

/* The nodes of all levels, and their states. */
static void put_levels(const side *s, const free_field_params *p, tl_element_node *node, double *state)
{
    for (size_t k = 0; k < s->level_count; k++) {
        const new_level *l = &s->level[k];
        const tl_element_face *f = l->first->face;
        tl_vec3 at[POINTS];
        half_space_points(f, at);
        const tl_vec3 middle = tl_v3_scale(1.0 / POINTS, tl_v3_add(at[0], tl_v3_add(at[1], at[2])));
        const tl_vec3 inside = tl_v3_madd(middle, -0.5 * l->width, f->normal);
        node[k] = (tl_element_node){
            .block = TL_NO_ID, .place = {inside.x, inside.y, 0.5 * (l->low + l->high)}, .weight = l->width};
        double *to = state + NODE_STATES * k;
        to[LEVEL] = l->held;
        to[HEIGHT] = l->high - l->low;
        to[DENSITY] = l->density;
        const half_space of = half_space_rock(p->kn, p->ks, p->p_velocity, p->s_velocity, to[HEIGHT], l->density, 0);
        to[KN] = 0.5 * of.k[0];
        to[KS] = 0.5 * of.k[1];
    }
}

/* Makes the elements: the levels again in each, and as many faces as there is place for. */
static tl_status add_all(const side *s, const free_field_params *p)
{
    tl_element_node node[TL_ELEMENT_NODES];
    double *state = calloc((size_t)TL_ELEMENT_NODES * NODE_STATES, sizeof *state);
    if (!state)
        return s->host->fail(s->host, TL_E_MEMORY, "out of memory");
    const tl_vec3 n = s->face[0].face->normal;
    const double whole[WHOLE_STATES] = {n.x, n.y, (double)s->level_count, 0, 0};
    tl_status status = TL_OK;
    put_levels(s, p, node, state);
    for (size_t i = 0; i < s->face_count && status == TL_OK;) {
        size_t count = s->level_count;
        for (; i < s->face_count && count + POINTS <= TL_ELEMENT_NODES; i++) {
            tl_vec3 at[POINTS];
            half_space_points(s->face[i].face, at);
            for (int k = 0; k < POINTS; k++, count++) {
                node[count] = (tl_element_node){s->face[i].face->block, at[k], s->face[i].face->normal,
                                                s->face[i].row[2] / POINTS};
                state[NODE_STATES * count + LEVEL] = (double)s->face[i].level;
            }
        }
        status = s->host->add(
            s->host,
            &(tl_new_element){
                .size = sizeof(tl_new_element), .nodes = node, .count = count, .node_state = state, .state = whole});
    }
    free(state);
    return status;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const free_field_params *p = given;
    const size_t numbers = half_space_numbers(p->faces, NULL);
    if (numbers == SIZE_MAX || numbers == 0 || numbers % ROW)
        return host->fail(host, TL_E_ARGUMENT,
                          "faces must be rows of %d finite numbers: block, face, area, width, density, held", ROW);
    side *s = calloc(1, sizeof *s);
    if (s) {
        s->host = host;
        s->row_count = numbers / ROW;
        s->rows = malloc(numbers * sizeof *s->rows);
        s->face = malloc(s->row_count * sizeof *s->face);
    }
    tl_status status = s && s->rows && s->face ? TL_OK : host->fail(host, TL_E_MEMORY, "out of memory");
    if (status == TL_OK) {
        half_space_numbers(p->faces, s->rows);
        status = find_faces(s);
    }
    if (status == TL_OK)
        status = find_levels(s, !isnan(p->base_kn) || !isnan(p->base_p_velocity));
    if (status == TL_OK)
        status = add_all(s, p);
    if (s) {
        free(s->rows);
        free(s->face);
    }
    free(s);
    return status;
}

/* ---------------------------------------------------------------- levels ----------------- */

static const tl_vec3 up = {0, 0, 1};

/* A level now, with what acts on it per area of the base. */
typedef struct level {
    tl_vec3 u, v, force;
    double turn, spin, moment;
    double height, width, density, kn, ks, z;
    double beside;  /* stiffness of the joints beside over that of the ones above and below */
    double pressed; /* Pa, traction along z on the side: what turns the level; before the step, then after it */
    unsigned held;
} level;

/* The column of an element. */
typedef struct column {
    const side_kind *kind;
    tl_vec3 n;
    level level[LEVELS];
    size_t count;
    half_space base;
    tl_vec3 shift; /* of the dashpot of the base */
    double shift_turn;
} column;

/* Traction on the side by the column beside, along z, Pa. */
static double pressed_of(const column *c, const level *l)
{
    return l->beside * l->ks * l->width * (l->turn + c->kind->given.beta * l->spin);
}

static void read_column(column *c, const side_kind *kind, const tl_element_batch *b, uint32_t e)
{
    double *const *of = b->state;
    const uint32_t first = b->start[e];
    c->kind = kind;
    c->n = tl_v3(b->element_state[NORMAL_X][e], b->element_state[NORMAL_Y][e], 0);
    c->count = (size_t)b->element_state[COUNT][e];
    c->shift = tl_v3(of[SHIFT_X][first], of[SHIFT_Y][first], of[SHIFT_Z][first]);
    c->shift_turn = b->element_state[BASE_TURN][e];
    for (size_t k = 0; k < c->count; k++) {
        const size_t i = first + k;
        level *l = &c->level[k];
        *l = (level){.u = {of[MOVED_X][i], of[MOVED_Y][i], of[MOVED_Z][i]},
                     .v = {of[SPEED_X][i], of[SPEED_Y][i], of[SPEED_Z][i]},
                     .turn = of[TURN][i],
                     .spin = of[SPIN][i],
                     .height = of[HEIGHT][i],
                     .width = b->weight[i],
                     .density = of[DENSITY][i],
                     .kn = of[KN][i],
                     .ks = of[KS][i],
                     .z = b->rest[2][i],
                     .held = (unsigned)of[LEVEL][i]};
        l->beside = isnan(kind->given.kn) ? l->height / l->width : 1;
        l->pressed = pressed_of(c, l);
    }
    const free_field_params *p = &kind->given;
    if (kind->quiet)
        c->base = half_space_rock(p->base_kn, p->base_ks, p->base_p_velocity, p->base_s_velocity, c->level[0].height,
                                  isnan(p->base_density) ? c->level[0].density : p->base_density, b->dt);
}

static void write_column(const column *c, const tl_element_batch *b, uint32_t e)
{
    double *const *of = b->state;
    const uint32_t first = b->start[e];
    of[SHIFT_X][first] = c->shift.x;
    of[SHIFT_Y][first] = c->shift.y;
    of[SHIFT_Z][first] = c->shift.z;
    b->element_state[BASE_TURN][e] = c->shift_turn;
    for (size_t k = 0; k < c->count; k++) {
        const level *l = &c->level[k];
        const size_t i = first + k;
        of[MOVED_X][i] = l->u.x;
        of[MOVED_Y][i] = l->u.y;
        of[MOVED_Z][i] = l->u.z;
        of[SPEED_X][i] = l->v.x;
        of[SPEED_Y][i] = l->v.y;
        of[SPEED_Z][i] = l->v.z;
        of[TURN][i] = l->turn;
        of[SPIN][i] = l->spin;
    }
}

/* Of two levels that meet: half of each is a spring. */
static double between(double below, double above)
{
    return below == above ? below : 2 / (1 / below + 1 / above);
}

static void join(const column *c, level *a, level *b)
{
    const double beta = c->kind->given.beta, kn = between(a->kn, b->kn), ks = between(a->ks, b->ks);
    const double k[2] = {kn, ks}, width = fmin(a->width, b->width);
    const double turn = 0.5 * (a->height * (a->turn + beta * a->spin) + b->height * (b->turn + beta * b->spin));
    const tl_vec3 d = tl_v3_madd(tl_v3_sub(b->u, a->u), beta, tl_v3_sub(b->v, a->v));
    const tl_vec3 f = half_space_parts(k, tl_v3_madd(d, -turn, c->n), up);
    const double along = tl_v3_dot(f, c->n);
    const double bend = kn * width * width / 12 * (b->turn - a->turn + beta * (b->spin - a->spin));
    a->force = tl_v3_add(a->force, f);
    b->force = tl_v3_sub(b->force, f);
    a->moment += 0.5 * a->height * along + bend;
    b->moment += 0.5 * b->height * along - bend;
}

/* How the middle of the underside of a level has moved, or moves. */
static tl_vec3 underside(const column *c, const level *l, tl_vec3 u, double turn)
{
    return tl_v3_madd(u, -0.5 * l->height * turn, c->n);
}

/* What acts on the levels where they are. */
static void press(column *c)
{
    for (size_t k = 0; k < c->count; k++)
        c->level[k].moment = -c->level[k].height * c->level[k].pressed;
    for (size_t k = 0; k + 1 < c->count; k++)
        join(c, &c->level[k], &c->level[k + 1]);
    level *low = &c->level[0];
    if (!c->kind->quiet)
        return;
    const tl_vec3 d = tl_v3_sub(underside(c, low, low->u, low->turn), c->shift);
    const tl_vec3 f = half_space_parts(c->base.k, d, up);
    low->force = tl_v3_sub(low->force, f);
    low->moment += 0.5 * low->height * tl_v3_dot(f, c->n) -
                   c->base.k[0] * low->width * low->width / 12 * (low->turn - c->shift_turn);
}

/* The mean displacement of the nodes on each level that is held in a component; it follows them. */
static void follow_blocks(column *c, const tl_element_batch *b, uint32_t e)
{
    unsigned any = 0;
    double area[LEVELS];
    tl_vec3 sum[LEVELS];
    for (size_t k = 0; k < c->count; k++) {
        any |= c->level[k].held & HELD_ALL_WAYS;
        area[k] = 0;
        sum[k] = tl_v3(0, 0, 0);
    }
    for (uint32_t i = b->start[e] + (uint32_t)c->count; any && i < b->start[e + 1]; i++) {
        const size_t k = (size_t)b->state[LEVEL][i] - 1;
        area[k] += b->weight[i];
        sum[k] = tl_v3_madd(sum[k], b->weight[i], tl_v3(b->u[0][i], b->u[1][i], b->u[2][i]));
    }
    for (size_t k = 0; any && k < c->count; k++) {
        level *l = &c->level[k];
        const tl_vec3 to = area[k] > 0 ? tl_v3_scale(1 / area[k], sum[k]) : l->u;
        const double mean[] = {to.x, to.y, to.z};
        double *const u[] = {&l->u.x, &l->u.y, &l->u.z}, *const v[] = {&l->v.x, &l->v.y, &l->v.z};
        for (int i = 0; i < 3; i++)
            if (l->held & (unsigned)(HELD_X << i)) {
                *v[i] = b->dt > 0 ? (mean[i] - *u[i]) / b->dt : 0;
                *u[i] = mean[i];
            }
    }
}

/* Moves the levels by a step, and the dashpot of the base. */
static void step_column(column *c, const tl_element_batch *b, uint32_t e)
{
    const double dt = b->dt, kick = 0.5 * (b->element_state[STEP][e] + dt), half = 0.5 * c->kind->given.alpha * kick;
    level *low = &c->level[0];
    const tl_vec3 was = underside(c, low, low->u, low->turn);
    const double turned = low->turn;
    press(c);
    for (size_t k = 0; k < c->count; k++) {
        level *l = &c->level[k];
        const double mass = l->density * l->height, inertia = mass * (l->width * l->width + l->height * l->height) / 12;
        const tl_vec3 v = tl_v3_scale(1 / (1 + half), tl_v3_madd(tl_v3_scale(1 - half, l->v), kick / mass, l->force));
        const double spin = ((1 - half) * l->spin + kick / inertia * l->moment) / (1 + half);
        const bool stiff = l->held & HELD_TURN || (l->held & HELD_ALL_WAYS) == HELD_ALL_WAYS;
        l->v.x = l->held & HELD_X ? l->v.x : v.x;
        l->v.y = l->held & HELD_Y ? l->v.y : v.y;
        l->v.z = l->held & HELD_Z ? l->v.z : v.z;
        l->spin = stiff ? 0 : spin;
        l->u.x += l->held & HELD_X ? 0 : dt * v.x;
        l->u.y += l->held & HELD_Y ? 0 : dt * v.y;
        l->u.z += l->held & HELD_Z ? 0 : dt * v.z;
        l->turn += dt * l->spin;
    }
    follow_blocks(c, b, e);
    b->element_state[STEP][e] = dt;
    if (!c->kind->quiet)
        return;
    const tl_vec3 in = half_space_came(c->kind->wave, b->time, dt), now = underside(c, low, low->u, low->turn);
    c->shift = half_space_follow(&c->base, c->shift, now, tl_v3_sub(now, was), in, up);
    c->shift_turn = c->base.inverse[0] * (c->shift_turn + c->base.a[0] * (turned - c->shift_turn + low->turn));
}

/* ---------------------------------------------------------------- faces ------------------ */

/* What the nodes of an element do in a step, J: `work` is that of the blocks on them. */
typedef struct sums {
    double stored, lost, given, work;
} sums;

/* Moves the dashpot of node i along, and puts the force on the block. */
static void act(const column *c, const half_space *h, const level *l, const tl_element_batch *b, uint32_t i, sums *sum)
{
    const double area = b->weight[i], dt = b->dt, per = dt > 0 ? 1 / dt : 0;
    const double pressed = pressed_of(c, l);
    const tl_vec3 arm = {(b->rest[2][i] - l->z) * c->n.x, (b->rest[2][i] - l->z) * c->n.y, -0.5 * l->width};
    const tl_vec3 far = tl_v3_madd(l->u, l->turn, arm), moved = tl_v3_scale(dt, tl_v3_madd(l->v, l->spin, arm));
    const tl_vec3 way = {b->du[0][i], b->du[1][i], b->du[2][i]},
                  s = {b->state[SHIFT_X][i], b->state[SHIFT_Y][i], b->state[SHIFT_Z][i]};
    const tl_vec3 u = tl_v3_sub(tl_v3(b->u[0][i], b->u[1][i], b->u[2][i]), far);
    const tl_vec3 now = half_space_follow(h, s, u, tl_v3_sub(way, moved), tl_v3(0, 0, 0), c->n);
    const tl_vec3 d = tl_v3_sub(u, now), f = tl_v3_scale(area, half_space_parts(h->k, d, c->n));
    const tl_vec3 had = {b->force[0][i], b->force[1][i], b->force[2][i]};
    const tl_vec3 force = {-f.x, -f.y, area * pressed - f.z};
    const tl_vec3 before = tl_v3_sub(tl_v3(0, 0, area * l->pressed), had); /* of the spring */
    sum->stored += 0.5 * area * half_space_square(h->k, d, c->n);
    sum->lost += per * area * half_space_square(h->z, tl_v3_sub(now, s), c->n);
    sum->given += 0.5 * area * (l->pressed + pressed) * way.z - 0.5 * tl_v3_dot(tl_v3_add(before, f), moved);
    sum->work -= 0.5 * tl_v3_dot(tl_v3_add(had, force), way);
    b->force[0][i] = force.x;
    b->force[1][i] = force.y;
    b->force[2][i] = force.z;
    b->state[SHIFT_X][i] = now.x;
    b->state[SHIFT_Y][i] = now.y;
    b->state[SHIFT_Z][i] = now.z;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const side_kind *kind = self;
    column c;
    for (uint32_t e = 0; e < b->count; e++) {
        read_column(&c, kind, b, e);
        step_column(&c, b, e);
        write_column(&c, b, e);
        sums sum = {0, 0, 0, 0};
        bool gone = false; /* a part of a block, and with it what the springs there hold */
        half_space h = {.k = {0, 0}};
        size_t of = SIZE_MAX;
        for (uint32_t i = b->start[e] + (uint32_t)c.count; i < b->start[e + 1]; i++) {
            const size_t k = (size_t)b->state[LEVEL][i] - 1;
            const level *l = &c.level[k];
            if (k != of)
                h = half_space_of(l->beside * l->kn, l->beside * l->ks, l->width, l->density, b->dt);
            of = k;
            gone = gone || b->weight[i] == 0;
            act(&c, &h, l, b, i, &sum);
        }
        b->given[e] = sum.given;
        b->lost[e] = gone ? b->stored[e] + sum.work + b->given[e] - sum.stored : sum.lost;
        b->stored[e] = sum.stored;
    }
    return TL_OK;
}

static double base_stiffness(const free_field_params *p, double height, double density)
{
    const half_space h = half_space_rock(p->base_kn, p->base_ks, p->base_p_velocity, p->base_s_velocity, height,
                                         isnan(p->base_density) ? density : p->base_density, 0);
    return fmax(h.k[0], h.k[1]);
}

/* Of each node, the spring of half a block. A block then bears no longer steps than its level does. */
static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const side_kind *kind = self;
    (void)c;
    for (uint32_t e = 0; e < b->count; e++) {
        const uint32_t first = b->start[e], count = (uint32_t)b->element_state[COUNT][e];
        double *const *of = b->state;
        for (uint32_t i = first + count; i < b->start[e + 1]; i++) {
            const uint32_t at = first + (uint32_t)of[LEVEL][i] - 1;
            const double kn = fmax(of[KN][at], of[KS][at]);
            double levels = at + 1 < first + count ? between(kn, fmax(of[KN][at + 1], of[KS][at + 1])) : 0;
            if (at > first)
                levels += between(kn, fmax(of[KN][at - 1], of[KS][at - 1]));
            else if (kind->quiet)
                levels += base_stiffness(&kind->given, of[HEIGHT][at], of[DENSITY][at]);
            const double beside = isnan(kind->given.kn) ? of[HEIGHT][at] / b->weight[at] : 1;
            k[i] = fmax(2 * kn * beside, levels * b->weight[at] / of[HEIGHT][at]) * b->weight[i];
        }
    }
}

const tl_element_ops free_field_ops = {.size = sizeof free_field_ops,
                                       .create = create,
                                       .place = place,
                                       .update = update,
                                       .stiffness = stiffness,
                                       .destroy = half_space_destroy,
                                       .never_fails = 1};
