/* frames.c - how bodies moved in the last step, and facets in the lanes of a rank.
 *
 * What eight contacts need is scattered over their bodies and facets: it is read as rows and transposed, and then
 * worked out for all of them at once. */
#include "detect/frames.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

/* Angle below which a tangent is taken from its series, whose next term is then below rounding. */
#define SERIES_ANGLE 0.1

/* ---------------------------------------------------------------- bodies ----------------- */

static tl_moving moving_of(tl_vec3 w, double dt)
{
    tl_vec3 t = tl_v3_scale(dt, w);            /* axis times angle */
    double a2 = tl_v3_norm2(t), tangent = 0.5; /* tan(a/2) / a */
    if (a2 < SERIES_ANGLE * SERIES_ANGLE)
        tangent += a2 * (1. / 24 + a2 * (1. / 240 + a2 * (17. / 40320 + a2 * 31. / 725760)));
    else
        tangent = tan(0.5 * sqrt(a2)) / sqrt(a2);
    tl_vec3 half = tl_v3_scale(tangent, t);
    return (tl_moving){half, 2 / (1 + tl_v3_norm2(half))};
}

/* What a point has moved beside the centroid, as it acts on its arm from there now: scale ([half] - [half]^2). Exact, so a
 * rolling contact and one that is turned as a whole gather no slip. */
TL_INLINE tl_mat3 turn_back(tl_vec3 h, double scale)
{
    tl_vec3 s = tl_v3_scale(scale, h);
    return (tl_mat3){{{s.y * h.y + s.z * h.z, -s.x * h.y - s.z, -s.x * h.z + s.y},
                      {-s.y * h.x + s.z, s.z * h.z + s.x * h.x, -s.y * h.z - s.x},
                      {-s.z * h.x - s.y, -s.z * h.y + s.x, s.x * h.x + s.y * h.y}}};
}

static void moving_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    tl_model *m = user;
    for (size_t i = begin; i < end; i++)
        m->detect->moving[i] = moving_of(m->bodies.w_moved[i], m->dt);
}

void tl_follow_bodies(tl_model *m)
{
    enum { CHUNK = 256 };
    tl_parallel_for(m->pool, m->bodies.table.rows, CHUNK, moving_range, m);
}

/* ---------------------------------------------------------------- lanes ------------------ */

/* What is known of a patch and its bodies, a lane each, before the lanes work out together what follows from it. */
typedef struct patches {
    double a[TL_MOVING_ROW][TL_LANES], b[TL_MOVING_ROW][TL_LANES]; /* tl_moving */
    double facet[TL_FACET_ROW][TL_LANES];                          /* tl_facet */
    tl_lanes9 rb;
} patches;

/* Where the members of a facet and of a motion are in their rows. */
#define AT(type, member) (offsetof(type, member) / sizeof(double))
enum {
    NA = AT(tl_facet, na),
    NB = AT(tl_facet, nb),
    OFFSET = AT(tl_facet, offset),
    LAST = AT(tl_facet, last),
    LAST_LEAN = AT(tl_facet, last_lean),
    HALF = AT(tl_moving, half),
    SCALE = AT(tl_moving, scale)
};
static_assert(sizeof(tl_facet) >= TL_FACET_ROW * sizeof(double), "a facet is shorter than its row");
static_assert(sizeof(tl_moving) == TL_MOVING_ROW * sizeof(double), "a motion is not its row");

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
#pragma GCC unroll 1
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
TL_INLINE void transpose_matrices(tl_lanes9 *to, const double *const *row)
{
    transpose(to->m[0], row, 8);
    for (size_t l = 0; l < TL_LANES; l++)
        to->m[2][2][l] = row[l][8];
}

/* A facet in its present place. */
TL_INLINE void put_facing(tl_frames *f, size_t l, tl_facing to)
{
    tl_lanes3_put(&f->n, l, to.n);
    tl_lanes3_put(&f->mean, l, to.mean);
    tl_lanes3_put(&f->lean, l, to.lean);
    tl_lanes3_put(&f->plane, l, to.plane);
    f->mean2[l] = to.mean2;
    f->l2[l] = to.l2;
    f->offset[l] = to.offset;
}

/* Square of the mean normal in the last step: 1 of facets that were flush. */
TL_INLINE double last2(tl_vec3 last, double last_l2)
{
    return last_l2 > 0 ? tl_v3_norm2(last) : 1;
}

TL_INLINE tl_mat3 difference(const tl_mat3 *a, const tl_mat3 *b)
{
    return (tl_mat3){{{a->m[0][0] - b->m[0][0], a->m[0][1] - b->m[0][1], a->m[0][2] - b->m[0][2]},
                      {a->m[1][0] - b->m[1][0], a->m[1][1] - b->m[1][1], a->m[1][2] - b->m[1][2]},
                      {a->m[2][0] - b->m[2][0], a->m[2][1] - b->m[2][1], a->m[2][2] - b->m[2][2]}}};
}

/* How shear forces of a facet turn, from its normals in the last step. What has not turned stays as it is, to the bit. */
TL_INLINE void put_turn(tl_frames *f, size_t l, tl_vec3 last, tl_vec3 last_lean)
{
    double last_l2 = tl_v3_norm2(last_lean);
    tl_vec3 n = tl_lanes3_get(&f->n, l);
    tl_vec3 from = tl_v3_scale(tl_unit_scale(last2(last, last_l2) - 1), last);
    tl_vec3 g = tl_turn_between(from, n, tl_v3_dot(tl_lanes3_get(&f->half, l), n));
    double g2 = tl_v3_norm2(g), flush = f->l2[l] + last_l2 > 0 ? 0 : 1;
    tl_mat3 back = turn_back(tl_v3_neg(g), 2 / (1 + g2)), one = tl_m3_identity();
    tl_mat3 turn = difference(&one, &back);
    /* into the plane: rounding would lead out of it in the course of many steps */
    tl_vec3 along = tl_v3_scale(g2 > 0 ? flush : 0, tl_m3_tmul(&turn, n));
    tl_mat3 out = {{{n.x * along.x, n.x * along.y, n.x * along.z},
                    {n.y * along.x, n.y * along.y, n.y * along.z},
                    {n.z * along.x, n.z * along.y, n.z * along.z}}};
    turn = difference(&turn, &out);
    tl_lanes9_put(&f->turn, l, &turn);
    f->tilted[l] = 1 - flush;
}

/* What only the points of tilted facets need. */
TL_INLINE void put_tilt(tl_frames *f, size_t l, tl_vec3 last, tl_vec3 last_lean, double carry)
{
    double l2 = f->l2[l], last_l2 = tl_v3_norm2(last_lean);
    tl_mat3 turn = tl_lanes9_get(&f->turn, l);
    tl_lanes3_put(&f->across, l,
                  tl_v3_cross(tl_lanes3_get(&f->mean, l), tl_lanes3_get(&f->lean, l)));
    tl_lanes3_put(&f->was, l, tl_m3_mul(&turn, last));
    tl_lanes3_put(&f->was_lean, l, tl_m3_mul(&turn, last_lean));
    tl_lanes3_put(&f->was_across, l, tl_m3_mul(&turn, tl_v3_cross(last, last_lean)));
    f->was2[l] = last2(last, last_l2);
    f->was_l2[l] = last_l2;
    f->carry[l] = l2 > 0 ? carry : 0;
    f->slide[l] = f->carry[l] / (l2 > 0 ? l2 : 1);
}

/* Element k and the two behind it as a vector of lane l. */
TL_INLINE tl_vec3 row_vec3(double (*row)[TL_LANES], size_t k, size_t l)
{
    return tl_v3(row[k][l], row[k + 1][l], row[k + 2][l]);
}

/* Motion of B against A in the last step, by their turns; `d` is the way from A's centroid to B's. */
TL_INLINE void put_motion(tl_frames *f, size_t l, tl_vec3 half_a, double scale_a, tl_vec3 half_b,
                          double scale_b, tl_vec3 way, tl_vec3 d)
{
    tl_mat3 ma = turn_back(half_a, scale_a), mb = turn_back(half_b, scale_b);
    tl_lanes3_put(&f->way, l, tl_v3_sub(way, tl_m3_mul(&mb, d)));
    tl_lanes3_put(&f->half, l, tl_v3_scale(0.5, tl_v3_add(half_a, half_b)));
    tl_mat3 moved = difference(&mb, &ma);
    tl_lanes9_put(&f->m, l, &moved);
}

TL_VECTORIZED static bool put_patches(tl_frames *restrict f, const tl_patch_rows *restrict rows)
{
    double any = 0;
    patches p;
    transpose(p.a, rows->a, TL_MOVING_ROW);
    transpose(p.b, rows->b, TL_MOVING_ROW);
    transpose(p.facet, rows->facet, TL_FACET_ROW);
    transpose_matrices(&f->to, rows->ra);
    transpose_matrices(&p.rb, rows->rb);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 d = tl_lanes3_get(&rows->d, l), ha = row_vec3(p.a, HALF, l);
        tl_vec3 hb = row_vec3(p.b, HALF, l);
        put_motion(f, l, ha, p.a[SCALE][l], hb, p.b[SCALE][l], tl_lanes3_get(&rows->way, l), d);
        tl_mat3 ra = tl_lanes9_get(&f->to, l), rb = tl_lanes9_get(&p.rb, l);
        tl_vec3 na = tl_m3_mul(&ra, row_vec3(p.facet, NA, l));
        tl_vec3 nb = tl_m3_mul(&rb, row_vec3(p.facet, NB, l));
        put_facing(f, l, tl_facing_patch(na, nb, d, p.facet[OFFSET][l]));
        put_turn(f, l, row_vec3(p.facet, LAST, l), row_vec3(p.facet, LAST_LEAN, l));
    }
    for (size_t l = 0; l < TL_LANES; l++)
        any += f->tilted[l];
    if (!(any > 0))
        return false;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_lanes3_put(&f->from, l, tl_v3(0, 0, 0));
        put_tilt(f, l, row_vec3(p.facet, LAST, l), row_vec3(p.facet, LAST_LEAN, l), rows->carry[l]);
    }
    return true;
}

bool tl_frames_put_patches(tl_frames *f, const tl_patch_rows *rows)
{
    return put_patches(f, rows);
}

void tl_frames_put(tl_frames *f, size_t l, const tl_model *m, uint32_t c, const tl_facet *facet,
                   double carry)
{
    tl_sight s = tl_sight_of(m, c);
    tl_facing to = tl_facing_of(facet, &s);
    bool in_b = tl_facet_in_b(facet);
    uint32_t body_a = m->blocks.body[s.a], body_b = m->blocks.body[s.b];
    const tl_moving *a = &m->detect->moving[body_a], *b = &m->detect->moving[body_b];
    tl_vec3 way = tl_way_between(m, body_a, body_b);
    put_motion(f, l, a->half, a->scale, b->half, b->scale, way, s.d);
    tl_lanes9_put(&f->to, l, in_b ? s.rb : s.ra);
    tl_lanes3_put(&f->from, l, in_b ? s.d : tl_v3(0, 0, 0));
    put_facing(f, l, to);
    put_turn(f, l, facet->last, facet->last_lean);
    put_tilt(f, l, facet->last, facet->last_lean, carry);
}
