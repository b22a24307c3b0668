/* follow.c - what a step does with every contact whose facets stand: gaps, normals and relative motion
 * of its points in the present place.
 *
 * Shear forces are turned with the common plane, exactly from the old normal to the new and by the bodies' mean spin
 * about it; (5) of Hart, Cundall and Lemos (1988) is the first order of this. Two bodies that turn as one make no
 * slip, and their forces turn with them.
 *
 * Eight contacts are worked on side by side (tl_rank). What is the same for all points of a contact is brought into
 * matrices first, one in each lane (*frames*), so that what is left for a point are a few products, in loops over
 * columns without a branch. Ranks of one flush patch in each lane, as most are, take the shortest way; else
 * facets are taken one after the other, the first of every contact, the second ..., each in its own part of the
 * slots. */
#include "detect/facing.h"

#include <string.h>

/* Angles below which sine and cosine are taken from their series, whose next term is then below
 * rounding. */
#define SERIES_ANGLE 0.1

/* ---------------------------------------------------------------- bodies ----------------- */

/* A body's motion in the last step, as it acts on a point at `arm` from the centroid now: way + m arm.
 * Exact, so a rolling contact and one that is turned as a whole gather no slip. */
static tl_moving moving_of(tl_vec3 v, tl_vec3 w, double dt)
{
    tl_moving out = {.way = tl_v3_scale(dt, v)};
    tl_vec3 t = tl_v3_scale(dt, w); /* axis times angle */
    double a2 = tl_v3_norm2(t);
    double sine, versine, tangent; /* sin a / a, (1 - cos a) / a^2, tan(a/2) / a */
    if (a2 < SERIES_ANGLE * SERIES_ANGLE) {
        sine = 1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72)));
        versine = 0.5 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90))));
        tangent = 0.5 + a2 * (1. / 24 + a2 * (1. / 240 + a2 * (17. / 40320 + a2 * 31. / 725760)));
    } else {
        double a = sqrt(a2);
        sine = sin(a) / a;
        versine = (1 - cos(a)) / a2;
        tangent = tan(0.5 * a) / a;
    }
    out.half = tl_v3_scale(tangent, t);
    /* sine [t] - versine [t]^2 */
    double d = versine * a2;
    out.m = (tl_mat3){{{d - versine * t.x * t.x, -versine * t.x * t.y - sine * t.z,
                        -versine * t.x * t.z + sine * t.y},
                       {-versine * t.y * t.x + sine * t.z, d - versine * t.y * t.y,
                        -versine * t.y * t.z - sine * t.x},
                       {-versine * t.z * t.x - sine * t.y, -versine * t.z * t.y + sine * t.x,
                        d - versine * t.z * t.z}}};
    return out;
}

static void moving_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    tl_model *m = user;
    for (size_t i = begin; i < end; i++)
        m->detect->moving[i] = moving_of(m->bodies.v_moved[i], m->bodies.w_moved[i], m->dt);
}

void tl_follow_bodies(tl_model *m)
{
    enum { CHUNK = 256 };
    tl_parallel_for(m->pool, m->bodies.table.rows, CHUNK, moving_range, m);
}

/* ---------------------------------------------------------------- frames ----------------- */

/* A vector or a matrix in each lane. */
typedef struct lane_vec3 {
    double x[TL_LANES], y[TL_LANES], z[TL_LANES];
} lane_vec3;

typedef struct lane_mat3 {
    double m[3][3][TL_LANES];
} lane_mat3;

TL_INLINE tl_vec3 vec_at(const lane_vec3 *v, size_t l)
{
    return tl_v3(v->x[l], v->y[l], v->z[l]);
}

TL_INLINE void vec_put(lane_vec3 *v, size_t l, tl_vec3 value)
{
    v->x[l] = value.x;
    v->y[l] = value.y;
    v->z[l] = value.z;
}

TL_INLINE tl_mat3 mat_at(const lane_mat3 *m, size_t l)
{
    return (tl_mat3){{{m->m[0][0][l], m->m[0][1][l], m->m[0][2][l]},
                      {m->m[1][0][l], m->m[1][1][l], m->m[1][2][l]},
                      {m->m[2][0][l], m->m[2][1][l], m->m[2][2][l]}}};
}

TL_INLINE tl_vec3 mat_row(const tl_mat3 *m, size_t i)
{
    return tl_v3(m->m[i][0], m->m[i][1], m->m[i][2]);
}

/* Row by row, not in loops: a loop over lanes with loops in it does not become SIMD code. */
TL_INLINE void row_put(double (*restrict row)[TL_LANES], size_t l, tl_vec3 value)
{
    row[0][l] = value.x;
    row[1][l] = value.y;
    row[2][l] = value.z;
}

TL_INLINE void mat_put(lane_mat3 *m, size_t l, const tl_mat3 *value)
{
    row_put(m->m[0], l, mat_row(value, 0));
    row_put(m->m[1], l, mat_row(value, 1));
    row_put(m->m[2], l, mat_row(value, 2));
}

/* One facet in each lane, in its present place, and how its points move. */
typedef struct frames {
    tl_facet *facet[TL_LANES]; /* NULL: none */
    lane_mat3 to;              /* from the frame of its points ... */
    lane_vec3 from;            /* ... and that frame's origin */
    lane_vec3 n, mean, lean, plane;
    double mean2[TL_LANES], l2[TL_LANES], offset[TL_LANES];
    lane_vec3 last, last_lean; /* of the facet */
    /* the motion of B against A in the last step at an arm from A's centroid: way + m arm; the mean spin of
     * both, as axis times the tangent of half its angle */
    lane_vec3 way, half;
    lane_mat3 m;
    double carry[TL_LANES]; /* half; 0 for points placed after that motion */
    /* flush patches: turn of their common plane, and whether it turns at all */
    lane_mat3 turn;
    double turns[TL_LANES];
    uint32_t end[TL_LANES]; /* slot behind its points */
} frames;

/* What is known of a patch and its bodies, a lane each, before the lanes work out together what follows from it. */
typedef struct patches {
    double a[TL_MOVING_ROW][TL_LANES], b[TL_MOVING_ROW][TL_LANES]; /* tl_moving */
    double facet[TL_FACET_ROW][TL_LANES];                          /* tl_facet */
    lane_mat3 rb;
    lane_vec3 d;
} patches;

/* A patch, its bodies' motions and rotations, and how far these are apart. */
typedef struct patch_rows {
    const double *a[TL_LANES], *b[TL_LANES], *ra[TL_LANES], *rb[TL_LANES], *facet[TL_LANES];
    lane_vec3 d;
} patch_rows;

typedef double quad __attribute__((vector_size(32)));
typedef double octet __attribute__((vector_size(64)));

/* Turns four doubles of the rows of four lanes into a row of four lanes for each double. */
TL_INLINE void transpose_quads(quad out[4], const double *const *row, size_t k)
{
    quad a, b, c, d;
    memcpy(&a, row[0] + k, sizeof a);
    memcpy(&b, row[1] + k, sizeof b);
    memcpy(&c, row[2] + k, sizeof c);
    memcpy(&d, row[3] + k, sizeof d);
    quad ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6);
    quad ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    quad cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    quad cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    out[0] = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
    out[1] = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    out[2] = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    out[3] = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

/* Turns `count` doubles, a multiple of four, of a row for each lane into a row of lanes for each double. What is
 * loaded as one vector is stored as one: a load cannot wait for two stores. */
TL_INLINE void transpose(double (*restrict to)[TL_LANES], const double *const *row, size_t count)
{
    for (size_t k = 0; k < count; k += 4) {
        quad low[4], high[4];
        transpose_quads(low, row, k);
        transpose_quads(high, row + 4, k);
        for (size_t i = 0; i < 4; i++) {
            octet all = __builtin_shufflevector(low[i], high[i], 0, 1, 2, 3, 4, 5, 6, 7);
            memcpy(to[k + i], &all, sizeof all);
        }
    }
}

/* A matrix of each lane; its last element does not fit into fours. */
TL_INLINE void transpose_matrices(lane_mat3 *to, const double *const *row)
{
    transpose(to->m[0], row, 8);
    for (size_t l = 0; l < TL_LANES; l++)
        to->m[2][2][l] = row[l][8];
}

TL_INLINE tl_mat3 matrix_of(tl_vec3 g, double g2)
{
    const double s = 2 / (1 + g2), d = 1 - s * g2;
    const tl_vec3 h = tl_v3_scale(s, g);
    return (tl_mat3){{{d + h.x * g.x, h.x * g.y - h.z, h.x * g.z + h.y},
                      {h.y * g.x + h.z, d + h.y * g.y, h.y * g.z - h.x},
                      {h.z * g.x - h.y, h.z * g.y + h.x, d + h.z * g.z}}};
}

/* A facet in its present place, and its normals before. */
TL_INLINE void put_facing(frames *f, size_t l, tl_facing to, tl_vec3 last, tl_vec3 last_lean)
{
    vec_put(&f->n, l, to.n);
    vec_put(&f->mean, l, to.mean);
    vec_put(&f->lean, l, to.lean);
    vec_put(&f->plane, l, to.plane);
    f->mean2[l] = to.mean2;
    f->l2[l] = to.l2;
    f->offset[l] = to.offset;
    vec_put(&f->last, l, last);
    vec_put(&f->last_lean, l, last_lean);
}

/* Element k and the two behind it as a vector of lane l. */
TL_INLINE tl_vec3 row_vec3(double (*row)[TL_LANES], size_t k, size_t l)
{
    return tl_v3(row[k][l], row[k + 1][l], row[k + 2][l]);
}

TL_INLINE tl_mat3 row_mat3(double (*row)[TL_LANES], size_t l)
{
    return (tl_mat3){{{row[0][l], row[1][l], row[2][l]},
                      {row[3][l], row[4][l], row[5][l]},
                      {row[6][l], row[7][l], row[8][l]}}};
}

/* Motion of B against A in the last step; `d` is the way from A's centroid to B's. */
TL_INLINE void put_motion(frames *f, size_t l, const tl_mat3 *ma, const tl_mat3 *mb, tl_vec3 way,
                          tl_vec3 half, tl_vec3 d)
{
    vec_put(&f->way, l, tl_v3_sub(way, tl_m3_mul(mb, d)));
    vec_put(&f->half, l, tl_v3_scale(0.5, half));
    row_put(f->m.m[0], l, tl_v3_sub(mat_row(mb, 0), mat_row(ma, 0)));
    row_put(f->m.m[1], l, tl_v3_sub(mat_row(mb, 1), mat_row(ma, 1)));
    row_put(f->m.m[2], l, tl_v3_sub(mat_row(mb, 2), mat_row(ma, 2)));
}

/* Brings a patch in each lane into its present place; false when none is or was tilted. */
TL_VECTORIZED static bool place_patches(frames *restrict f, const patch_rows *restrict rows)
{
    patches p;
    transpose(p.a, rows->a, TL_MOVING_ROW);
    transpose(p.b, rows->b, TL_MOVING_ROW);
    transpose(p.facet, rows->facet, TL_FACET_ROW);
    transpose_matrices(&f->to, rows->ra);
    transpose_matrices(&p.rb, rows->rb);
    double tilted[TL_LANES];
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 d = vec_at(&rows->d, l), last = row_vec3(p.facet, 7, l);
        tl_vec3 last_lean = row_vec3(p.facet, 10, l);
        tl_mat3 ma = row_mat3(p.a, l), mb = row_mat3(p.b, l);
        tl_vec3 way = tl_v3_sub(row_vec3(p.b, 9, l), row_vec3(p.a, 9, l));
        tl_vec3 half = tl_v3_add(row_vec3(p.a, 12, l), row_vec3(p.b, 12, l));
        put_motion(f, l, &ma, &mb, way, half, d);
        tl_mat3 ra = mat_at(&f->to, l), rb = mat_at(&p.rb, l);
        tl_vec3 na = tl_m3_mul(&ra, row_vec3(p.facet, 0, l));
        tl_vec3 nb = tl_m3_mul(&rb, row_vec3(p.facet, 3, l));
        tl_facing to = tl_facing_patch(na, nb, d, p.facet[6][l]);
        put_facing(f, l, to, last, last_lean);
        vec_put(&f->from, l, tl_v3(0, 0, 0));
        tl_vec3 by = tl_turn_between(last, to.n, tl_v3_dot(vec_at(&f->half, l), to.n));
        double g2 = tl_v3_norm2(by);
        tl_mat3 turn = matrix_of(by, g2);
        mat_put(&f->turn, l, &turn);
        f->turns[l] = g2 > 0 ? 1 : 0;
        tilted[l] = to.l2 + tl_v3_norm2(last_lean);
    }
    double any = 0;
    for (size_t l = 0; l < TL_LANES; l++)
        any += tilted[l];
    return any != 0;
}

/* Puts any facet into lane l. */
static void put_facet(const tl_model *m, uint32_t c, const tl_facet *facet, size_t l, frames *f)
{
    tl_sight s = tl_sight_of(m, c);
    tl_facing to = tl_facing_of(facet, &s);
    bool in_b = tl_facet_in_b(facet);
    const tl_moving *a = &m->detect->moving[m->blocks.body[s.a]];
    const tl_moving *b = &m->detect->moving[m->blocks.body[s.b]];
    put_motion(f, l, &a->m, &b->m, tl_v3_sub(b->way, a->way), tl_v3_add(a->half, b->half), s.d);
    mat_put(&f->to, l, in_b ? s.rb : s.ra);
    vec_put(&f->from, l, in_b ? s.d : tl_v3(0, 0, 0));
    put_facing(f, l, to, facet->last, facet->last_lean);
}

/* ---------------------------------------------------------------- points ----------------- */

/* Columns of points and lanes, row 0 of both the first of a rank. */
typedef struct columns {
    const float *face, *edge; /* tl_lean */
    const double *reference;
    double *p[3], *f_s[3];
    double *arm[3], *normal[3], *closure, *du_n, *du_s[3];
} columns;

static columns columns_at(const tl_points_table *p, size_t row, const tl_point_lanes *t,
                          size_t lane)
{
    return (columns){
        .p = {p->p[0] + row, p->p[1] + row, p->p[2] + row},
        .face = p->lean_face + row,
        .edge = p->lean_edge + row,
        .reference = p->reference ? p->reference + row : t->zero + lane,
        .f_s = {p->f_s[0] + row, p->f_s[1] + row, p->f_s[2] + row},
        .arm = {t->arm[0] + lane, t->arm[1] + lane, t->arm[2] + lane},
        .normal = {t->normal[0] + lane, t->normal[1] + lane, t->normal[2] + lane},
        .closure = t->closure + lane,
        .du_n = t->du_n + lane,
        .du_s = {t->du_s[0] + lane, t->du_s[1] + lane, t->du_s[2] + lane},
    };
}

TL_INLINE void put(double *const column[3], size_t i, tl_vec3 v)
{
    tl_columns_put(column, i, v);
}

/* The points of flush patches: all of a contact have one normal. */
TL_VECTORIZED static void follow_level(const columns *c, size_t slots, const frames *restrict f)
{
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = at + l;
            tl_mat3 to = mat_at(&f->to, l), motion = mat_at(&f->m, l), turn = mat_at(&f->turn, l);
            tl_vec3 n = vec_at(&f->n, l);
            tl_vec3 x = tl_m3_mul(&to, tl_columns_get(c->p, i));
            tl_vec3 du = tl_v3_add(vec_at(&f->way, l), tl_m3_mul(&motion, x));
            double du_n = tl_v3_dot(du, n);
            put(c->arm, i, x);
            put(c->normal, i, n);
            c->closure[i] = f->offset[l] - tl_v3_dot(vec_at(&f->plane, l), x) - c->reference[i];
            c->du_n[i] = du_n;
            put(c->du_s, i, tl_v3_madd(du, -du_n, n));
            /* what has not turned stays as it is, to the bit */
            tl_vec3 v = tl_m3_mul(&turn, tl_columns_get(c->f_s, i));
            put(c->f_s, i, tl_v3_madd(v, -f->turns[l] * tl_v3_dot(v, n), n));
        }
}

/* Points of any facets. Features of a tilted patch move: a vertex of A with A (lean -1), one of B with B (lean 1), what
 * lies between with both; so do the points until the patch is made anew, and the gap opens along the point's
 * normal. */
TL_VECTORIZED static void follow_any(const columns *c, size_t begin, size_t end,
                                     const frames *restrict f)
{
    for (size_t slot = begin; slot < end; slot++) {
        double face[TL_LANES], edge[TL_LANES]; /* in a loop of their own: the next has no floats */
        for (size_t l = 0; l < TL_LANES; l++) {
            face[l] = c->face[slot * TL_LANES + l];
            edge[l] = c->edge[slot * TL_LANES + l];
        }
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = slot * TL_LANES + l;
            tl_mat3 to = mat_at(&f->to, l), motion = mat_at(&f->m, l);
            tl_vec3 mean = vec_at(&f->mean, l), lean = vec_at(&f->lean, l);
            tl_vec3 last = vec_at(&f->last, l), last_lean = vec_at(&f->last_lean, l);
            tl_vec3 p = tl_columns_get(c->p, i),
                    x = tl_v3_add(tl_m3_mul(&to, p), vec_at(&f->from, l));
            double l2 = f->l2[l], last_l2 = tl_v3_norm2(last_lean);
            tl_vec3 n = tl_leaning(mean, lean, f->mean2[l], l2, face[l], edge[l]);
            tl_vec3 du = tl_v3_add(vec_at(&f->way, l), tl_m3_mul(&motion, x));
            double du_n = tl_v3_dot(du, n);
            /* with the features that made it, along the faces; where two edges cross, also up the faces by how far
             * one edge has slid over the other */
            double carry = l2 > 0 ? f->carry[l] : 0, slid = carry * edge[l] / (l2 > 0 ? l2 : 1);
            tl_vec3 go = tl_v3_scale(carry * (1 + face[l]), du);
            go = tl_v3_madd(go, slid * tl_v3_dot(tl_v3_cross(mean, lean), du), lean);
            x = tl_v3_add(x, go);
            put(c->p, i, tl_v3_add(p, tl_m3_tmul(&to, go)));
            c->closure[i] = f->offset[l] - tl_v3_dot(vec_at(&f->plane, l), x) - c->reference[i];
            put(c->arm, i, x);
            put(c->normal, i, n);
            c->du_n[i] = du_n;
            put(c->du_s, i, tl_v3_madd(du, -du_n, n));
            double last2 = last_l2 > 0 ? tl_v3_norm2(last) : 1;
            tl_vec3 before = tl_leaning(last, last_lean, last2, last_l2, face[l], edge[l]);
            tl_vec3 v = tl_turn_one(tl_columns_get(c->f_s, i), before, n, vec_at(&f->half, l));
            put(c->f_s, i, v);
        }
    }
}

/* ---------------------------------------------------------------- ranks ------------------ */

/* Turns the tangent states of a contact's points. */
static void turn_states(tl_model *m, uint32_t contact, const tl_facet *f, const columns *c,
                        size_t l, tl_vec3 half, uint32_t tangents)
{
    tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k + 2 < p->state_columns; k++) {
        double *v[3] = {p->state[k], p->state[k + 1], p->state[k + 2]};
        for (uint32_t j = f->begin; j < f->begin + (uint32_t)f->count && tangents >> k & 1; j++) {
            size_t row = tl_point_row(&m->detect->contacts, contact, j), lane = j * TL_LANES + l;
            tl_vec3 before = tl_facet_last_normal(f, tl_point_lean(p, row));
            tl_columns_put(
                v, row,
                tl_turn_one(tl_columns_get(v, row), before, tl_columns_get(c->normal, lane), half));
        }
    }
}

/* The states that turn, and the normal to turn from in the next step. */
static void finish_facet(tl_model *m, const tl_rank *rank, const columns *c, const frames *f,
                         size_t l, uint32_t tangents)
{
    tl_facet *facet = f->facet[l];
    if (!facet)
        return;
    if (tangents)
        turn_states(m, rank->contact[l], facet, c, l, vec_at(&f->half, l), tangents);
    facet->last = vec_at(&f->mean, l);
    facet->last_lean = vec_at(&f->lean, l);
}

/* Lanes of the rank that hold a contact of one patch and nothing else, or no contact: all of them? `some` is one of the
 * former. */
static bool take_patches(tl_detect *d, const tl_rank *rank, frames *f, size_t *some)
{
    tl_contacts *c = &d->contacts;
    *some = TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = rank->contact[l];
        f->facet[l] = NULL;
        if (contact == TL_NO_ROW)
            continue;
        f->facet[l] = &c->facet[c->facet_start[contact]];
        if (c->facet_count[contact] != 1 || f->facet[l]->kind != TL_FACET_PATCH)
            return false;
        *some = l;
    }
    return *some < TL_LANES;
}

static double carry_of(const tl_contacts *contacts, uint32_t contact)
{
    return contact == TL_NO_ROW || contacts->fresh[contact] ? 0 : 0.5;
}

/* The patches that have been taken; lanes without a contact do as another. false when all are flush and were. */
static bool follow_patches(tl_model *m, const tl_rank *rank, const columns *c, frames *f,
                           size_t some)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_bodies *bodies = &m->bodies;
    patch_rows rows;
    for (size_t l = 0; l < TL_LANES; l++) {
        size_t from = f->facet[l] ? l : some;
        uint32_t contact = rank->contact[from];
        uint32_t a = m->blocks.body[contacts->a[contact]], b = m->blocks.body[contacts->b[contact]];
        rows.a[l] = &m->detect->moving[a].m.m[0][0];
        rows.b[l] = &m->detect->moving[b].m.m[0][0];
        rows.ra[l] = &bodies->r[a].m[0][0];
        rows.rb[l] = &bodies->r[b].m[0][0];
        rows.facet[l] = &f->facet[from]->na.x;
        vec_put(&rows.d, l, tl_body_apart(bodies, a, b));
    }
    if (!place_patches(f, &rows)) {
        follow_level(c, rank->slots, f);
        return false;
    }
    for (size_t l = 0; l < TL_LANES; l++)
        f->carry[l] = carry_of(contacts, rank->contact[l]);
    follow_any(c, 0, rank->slots, f);
    return true;
}

/* The facet of lane l that begins in a slot; where its contact ends before, the lane goes on as it is, inert. */
static void next_facet(tl_model *m, const tl_rank *rank, frames *f, size_t l, uint32_t slot)
{
    tl_contacts *contacts = &m->detect->contacts;
    uint32_t contact = rank->contact[l];
    uint32_t facets = contact == TL_NO_ROW ? 0 : contacts->facet_count[contact];
    f->facet[l] = NULL;
    for (uint32_t k = 0; k < facets && !f->facet[l]; k++) {
        tl_facet *facet = &contacts->facet[contacts->facet_start[contact] + k];
        if (facet->begin == slot && facet->count > 0)
            f->facet[l] = facet;
    }
    f->carry[l] = f->facet[l] ? carry_of(contacts, contact) : 0;
    f->end[l] = f->facet[l] ? slot + f->facet[l]->count : rank->slots;
    if (f->facet[l])
        put_facet(m, contact, f->facet[l], l, f);
}

/* Whatever facets the rank has: from where one begins in some lane to where the next does. */
static void follow_facets(tl_model *m, const tl_rank *rank, const columns *c, frames *f,
                          uint32_t tangents)
{
    uint32_t slot = 0;
    memset(f, 0, sizeof *f); /* lanes without a contact: inert, but finite */
    for (size_t l = 0; l < TL_LANES; l++)
        f->mean2[l] = 1;
    while (slot < rank->slots) {
        uint32_t until = rank->slots;
        for (size_t l = 0; l < TL_LANES; l++) {
            if (f->end[l] == slot) {
                finish_facet(m, rank, c, f, l, tangents);
                next_facet(m, rank, f, l, slot);
            }
            until = f->end[l] < until ? f->end[l] : until;
        }
        follow_any(c, slot, until, f);
        slot = until;
    }
}

bool tl_rank_follow(tl_model *m, const tl_rank *rank, const tl_point_lanes *t, size_t lane,
                    uint32_t tangents)
{
    uint8_t *fresh = m->detect->contacts.fresh;
    columns c = columns_at(&m->detect->points, rank->start, t, lane);
    frames f;
    size_t some;
    bool tilted = true;
    if (take_patches(m->detect, rank, &f, &some))
        tilted = follow_patches(m, rank, &c, &f, some);
    else
        follow_facets(m, rank, &c, &f, tangents);
    for (size_t l = 0; l < TL_LANES; l++) {
        finish_facet(m, rank, &c, &f, l, tangents);
        if (rank->contact[l] != TL_NO_ROW && fresh[rank->contact[l]])
            fresh[rank->contact[l]] = false;
    }
    return tilted;
}
