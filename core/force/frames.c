/* frames.c - how bodies moved in the last step, and facets in the lanes of a rank.
 *
 * What eight contacts need is scattered over their bodies and facets: it is read as rows and transposed, and then
 * worked out for all of them at once. */
#include "force/frames.h"

#include "contact/places.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

/* Angle below which a tangent is taken from its series, whose next term is then below rounding. */
#define SERIES_ANGLE 0.1

/* ---------------------------------------------------------------- bodies ----------------- */

/* The square of an angle by which a body turned is small enough for the series. */
TL_INLINE bool is_small(double a2)
{
    return a2 < SERIES_ANGLE * SERIES_ANGLE;
}

/* tan(a/2) / a by its series, from the square of a. */
TL_INLINE double tangent_series(double a2)
{
    return 0.5 + a2 * (1. / 24 + a2 * (1. / 240 + a2 * (17. / 40320 + a2 * 31. / 725760)));
}

static double tangent_of(double a2)
{
    return is_small(a2) ? tangent_series(a2) : tl_tan(0.5 * sqrt(a2)) / sqrt(a2);
}

/* Square of the angle by which a body turned in a step. */
TL_INLINE double angle2(tl_vec3 w, double dt)
{
    return tl_v3_norm2(tl_v3_scale(dt, w));
}

/* Its axis times the tangent of half of it. */
TL_INLINE tl_vec3 half_turn(tl_vec3 w, double tangent, double dt)
{
    return tl_v3_scale(tangent, tl_v3_scale(dt, w));
}

/* What a point has moved beside the centroid, as it acts on its arm from there now: 2 / (1 + h^2) ([h] - [h]^2), where h is
 * axis times the tangent of half the angle of the turn. Exact, so a rolling contact and one that is turned as a
 * whole gather no slip. */
TL_INLINE tl_mat3 turn_back(tl_vec3 h)
{
    tl_vec3 s = tl_v3_scale(2 / (1 + tl_v3_norm2(h)), h);
    return (tl_mat3){{{s.y * h.y + s.z * h.z, -s.x * h.y - s.z, -s.x * h.z + s.y},
                      {-s.y * h.x + s.z, s.z * h.z + s.x * h.x, -s.y * h.z - s.x},
                      {-s.z * h.x - s.y, -s.z * h.y + s.x, s.x * h.x + s.y * h.y}}};
}

/* ---------------------------------------------------------------- lanes ------------------ */

/* What is known of a patch and its bodies, a lane each, before the lanes work out together what follows from it. */
typedef struct patches {
    double a[TL_POSE_ROW][TL_LANES], b[TL_POSE_ROW][TL_LANES]; /* tl_pose */
    double facet[TL_FACET_ROW][TL_LANES];                      /* tl_facet */
} patches;

/* Where the members of a facet and of a pose are in their rows. */
#define AT(type, member) (offsetof(type, member) / sizeof(double))
enum {
    NA = AT(tl_facet, na),
    NB = AT(tl_facet, nb),
    OFFSET = AT(tl_facet, offset),
    LAST = AT(tl_facet, last),
    LAST_LEAN = AT(tl_facet, last_lean),
    X_REF = AT(tl_pose, x_ref),
    U = AT(tl_pose, u),
    V_MOVED = AT(tl_pose, v_moved),
    W_MOVED = AT(tl_pose, w_moved),
    POSE_END = AT(tl_pose, unused)
};
static_assert(sizeof(tl_facet) >= TL_FACET_ROW * sizeof(double), "a facet is shorter than its row");
static_assert(sizeof(tl_pose) == TL_POSE_ROW * sizeof(double), "a pose is not its row");
static_assert(sizeof(tl_pose) % TL_ALIGN == 0, "poses do not begin where lines of memory do");
static_assert(AT(tl_pose, r) == 0, "a pose does not begin with its matrix");

typedef double pair __attribute__((vector_size(16)));
typedef double quad __attribute__((vector_size(32)));
typedef double octet __attribute__((vector_size(64)));

/* Two doubles of each of two rows. */
TL_INLINE void of_rows(quad *out, const double *low, const double *high)
{
    pair a, b;
    memcpy(&a, low, sizeof a);
    memcpy(&b, high, sizeof b);
    *out = __builtin_shufflevector(a, b, 0, 1, 2, 3);
}

TL_INLINE void put_octet(double *to, const quad *low, const quad *high)
{
    octet all = __builtin_shufflevector(*low, *high, 0, 1, 2, 3, 4, 5, 6, 7);
    memcpy(to, &all, sizeof all);
}

/* Turns `count` doubles, an even number, of a row for each lane into a row of lanes for each double. What is loaded
 * as one vector is stored as one: a load cannot wait for two stores. */
TL_INLINE void transpose(double (*restrict to)[TL_LANES], const double *const *row, size_t count)
{
#pragma GCC unroll 1
    for (size_t k = 0; k < count; k += 2) {
        quad even, odd, low[2], high[2];
        of_rows(&even, row[0] + k, row[2] + k);
        of_rows(&odd, row[1] + k, row[3] + k);
        low[0] = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
        low[1] = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
        of_rows(&even, row[4] + k, row[6] + k);
        of_rows(&odd, row[5] + k, row[7] + k);
        high[0] = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
        high[1] = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
        put_octet(to[k], &low[0], &high[0]);
        put_octet(to[k + 1], &low[1], &high[1]);
    }
}

/* The poses of a body in each lane. */
TL_INLINE void transpose_poses(double (*restrict to)[TL_LANES], const double *const *row)
{
    transpose(to, row, (POSE_END + 1) / 2 * 2);
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

/* How shear forces of a facet turn: from its normal `from` in the last step to n, then by twice the angle of tangent w about
 * that. With h = from x n + w (from + n) that is 1 + p [h] + p q [h]^2, p = 1 / (1 + w^2), q = 1 / (1 + from . n). What has not
 * turned stays as it is, to the bit. */
TL_INLINE void put_turn(tl_frames *f, size_t l, tl_vec3 last, tl_vec3 last_lean)
{
    double last_l2 = tl_v3_norm2(last_lean), flush = f->l2[l] + last_l2 > 0 ? 0 : 1;
    tl_vec3 n = tl_lanes3_get(&f->n, l);
    tl_vec3 from = tl_v3_scale(tl_unit_scale(last2(last, last_l2) - 1), last);
    double w = tl_v3_dot(tl_lanes3_get(&f->half, l), n), c = 1 + tl_v3_dot(from, n);
    tl_vec3 h = tl_v3_madd(tl_v3_cross(from, n), w, tl_v3_add(from, n));
    tl_vec3 s = tl_v3_scale(1 / (1 + w * w), h), g = tl_v3_scale(1 / (c > 0 ? c : 1), h);
    tl_mat3 turn = {{{1 - (s.y * g.y + s.z * g.z), s.x * g.y - s.z, s.x * g.z + s.y},
                     {s.y * g.x + s.z, 1 - (s.z * g.z + s.x * g.x), s.y * g.z - s.x},
                     {s.z * g.x - s.y, s.z * g.y + s.x, 1 - (s.x * g.x + s.y * g.y)}}};
    /* out of it what is along `from`: rounding would lead out of the plane in the course of many steps */
    tl_vec3 out = tl_v3_scale(tl_v3_norm2(h) > 0 ? flush : 0, n);
    tl_mat3 along = {{{out.x * from.x, out.x * from.y, out.x * from.z},
                      {out.y * from.x, out.y * from.y, out.y * from.z},
                      {out.z * from.x, out.z * from.y, out.z * from.z}}};
    turn = difference(&turn, &along);
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

TL_INLINE tl_mat3 row_mat3(double (*row)[TL_LANES], size_t l)
{
    return (tl_mat3){{{row[0][l], row[1][l], row[2][l]},
                      {row[3][l], row[4][l], row[5][l]},
                      {row[6][l], row[7][l], row[8][l]}}};
}

/* tan(a/2) / a of the turns of a body in each lane. */
TL_INLINE void put_tangents(double *restrict tangent, double (*row)[TL_LANES], double dt)
{
    double wide = 0;
#pragma omp simd reduction(+ : wide)
    for (size_t l = 0; l < TL_LANES; l++) {
        double a2 = angle2(row_vec3(row, W_MOVED, l), dt);
        tangent[l] = tangent_series(a2);
        wide += is_small(a2) ? 0 : 1;
    }
    for (size_t l = 0; wide > 0 && l < TL_LANES; l++)
        tangent[l] = tangent_of(angle2(row_vec3(row, W_MOVED, l), dt));
}

/* From A's body to B's in lane l. */
TL_INLINE tl_vec3 rows_apart(double (*a)[TL_LANES], double (*b)[TL_LANES], size_t l)
{
    return tl_apart(row_vec3(a, X_REF, l), row_vec3(a, U, l), row_vec3(b, X_REF, l),
                    row_vec3(b, U, l));
}

/* The way of B against A in the last step, at their centroids. */
TL_INLINE tl_vec3 way_between(tl_vec3 v_a, tl_vec3 v_b, double dt)
{
    return tl_v3_scale(dt, tl_v3_sub(v_b, v_a));
}

/* Motion of B against A in the last step, by half their turns; `d` is the way from A's centroid to B's. */
TL_INLINE void put_motion(tl_frames *f, size_t l, tl_vec3 half_a, tl_vec3 half_b, tl_vec3 way,
                          tl_vec3 d)
{
    tl_mat3 ma = turn_back(half_a), mb = turn_back(half_b);
    tl_lanes3_put(&f->way, l, tl_v3_sub(way, tl_m3_mul(&mb, d)));
    tl_lanes3_put(&f->half, l, tl_v3_scale(0.5, tl_v3_add(half_a, half_b)));
    tl_mat3 moved = difference(&mb, &ma);
    tl_lanes9_put(&f->m, l, &moved);
}

/* The same of the bodies of lane l, whose turns have these tangents. */
TL_INLINE void put_rows_motion(tl_frames *f, size_t l, double (*a)[TL_LANES], double (*b)[TL_LANES],
                               double tangent_a, double tangent_b, double dt, tl_vec3 d)
{
    tl_vec3 half_a = half_turn(row_vec3(a, W_MOVED, l), tangent_a, dt);
    tl_vec3 half_b = half_turn(row_vec3(b, W_MOVED, l), tangent_b, dt);
    put_motion(f, l, half_a, half_b,
               way_between(row_vec3(a, V_MOVED, l), row_vec3(b, V_MOVED, l), dt), d);
}

TL_VECTORIZED static bool put_patches(tl_frames *restrict f, const tl_patch_rows *restrict rows)
{
    double any = 0, tangent_a[TL_LANES], tangent_b[TL_LANES];
    patches p;
    const tl_body_rows *bodies = &rows->bodies;
    transpose_poses(p.a, bodies->a);
    transpose_poses(p.b, bodies->b);
    transpose(p.facet, rows->facet, TL_FACET_ROW);
    put_tangents(tangent_a, p.a, bodies->dt);
    put_tangents(tangent_b, p.b, bodies->dt);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 d = rows_apart(p.a, p.b, l);
        put_rows_motion(f, l, p.a, p.b, tangent_a[l], tangent_b[l], bodies->dt, d);
        tl_mat3 ra = row_mat3(p.a, l), rb = row_mat3(p.b, l);
        tl_lanes9_put(&f->to, l, &ra);
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

TL_VECTORIZED static void put_bodies(tl_frames *restrict f, tl_facet_rows *restrict facets,
                                     const tl_body_rows *restrict bodies)
{
    double a[TL_POSE_ROW][TL_LANES], b[TL_POSE_ROW][TL_LANES];
    double tangent_a[TL_LANES], tangent_b[TL_LANES];
    transpose_poses(a, bodies->a);
    transpose_poses(b, bodies->b);
    put_tangents(tangent_a, a, bodies->dt);
    put_tangents(tangent_b, b, bodies->dt);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 d = rows_apart(a, b, l), nothing = {0, 0, 0};
        put_rows_motion(f, l, a, b, tangent_a[l], tangent_b[l], bodies->dt, d);
        tl_mat3 ra = row_mat3(a, l), rb = row_mat3(b, l);
        tl_lanes9_put(&facets->ra, l, &ra);
        tl_lanes9_put(&facets->rb, l, &rb);
        tl_lanes3_put(&facets->d, l, d);
        tl_lanes3_put(&facets->from_a, l, nothing);
        tl_lanes3_put(&facets->from_b, l, nothing);
        tl_lanes3_put(&facets->along_a, l, nothing);
        tl_lanes3_put(&facets->along_b, l, nothing);
        tl_lanes3_put(&facets->edge_n, l, nothing);
        facets->edge_offset[l] = 0;
    }
}

void tl_frames_put_bodies(tl_frames *f, tl_facet_rows *facets, const tl_body_rows *bodies)
{
    put_bodies(f, facets, bodies);
    facets->new_edges = false;
}

/* Normals and offsets of the edges; the operations are those of places.c. */
TL_VECTORIZED static void put_edges(tl_facet_rows *restrict rows)
{
    double facet[4][TL_LANES];
    transpose(facet, rows->facet, 4);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_mat3 ra = tl_lanes9_get(&rows->ra, l), rb = tl_lanes9_get(&rows->rb, l);
        tl_vec3 along_a = tl_m3_mul(&ra, tl_lanes3_get(&rows->along_a, l));
        tl_vec3 along_b = tl_m3_mul(&rb, tl_lanes3_get(&rows->along_b, l));
        tl_vec3 foot_a = tl_m3_mul(&ra, tl_lanes3_get(&rows->from_a, l));
        tl_vec3 foot_b =
            tl_v3_add(tl_m3_mul(&rb, tl_lanes3_get(&rows->from_b, l)), tl_lanes3_get(&rows->d, l));
        tl_vec3 n = tl_facing_edges(along_a, along_b, tl_m3_mul(&ra, row_vec3(facet, NA, l)));
        tl_lanes3_put(&rows->edge_n, l, n);
        rows->edge_offset[l] = -tl_v3_dot(n, tl_v3_sub(foot_b, foot_a));
    }
}

TL_INLINE double choose(double yes, double a, double b)
{
    return yes > 0 ? a : b;
}

TL_INLINE tl_vec3 choose3(double yes, tl_vec3 a, tl_vec3 b)
{
    return tl_v3(choose(yes, a.x, b.x), choose(yes, a.y, b.y), choose(yes, a.z, b.z));
}

/* The facing of the kind of facet that lane l has: all are made, and one is chosen. */
TL_INLINE tl_facing facing_in(const tl_facet_rows *restrict rows, size_t l, tl_vec3 na, tl_vec3 nb,
                              double offset)
{
    double kind = rows->kind[l], level = kind == TL_FACET_PATCH ? 0 : 1;
    double on_a = kind == TL_FACET_FACE_A ? 1 : 0, on_b = kind == TL_FACET_FACE_B ? 1 : 0;
    double crosses = kind == TL_FACET_EDGES ? 1 : 0;
    tl_vec3 d = tl_lanes3_get(&rows->d, l), nothing = {0, 0, 0};
    tl_facing to = tl_facing_patch(na, nb, d, offset);
    to.n = choose3(on_a, na, to.n);
    to.n = choose3(on_b, tl_v3_neg(nb), to.n);
    to.n = choose3(crosses, tl_lanes3_get(&rows->edge_n, l), to.n);
    to.mean = choose3(level, to.n, to.mean);
    to.lean = choose3(level, nothing, to.lean);
    to.mean2 = choose(level, 1, to.mean2);
    to.l2 = choose(level, 0, to.l2);
    to.plane = choose3(on_a, na, to.plane);
    to.plane = choose3(on_b, nb, to.plane);
    to.plane = choose3(crosses, nothing, to.plane);
    to.offset = choose(on_a, offset, to.offset); /* B's face: as of a patch */
    to.offset = choose(crosses, rows->edge_offset[l], to.offset);
    return to;
}

TL_VECTORIZED static void put_facets(tl_frames *restrict f, const tl_facet_rows *restrict rows)
{
    double facet[TL_FACET_ROW][TL_LANES];
    transpose(facet, rows->facet, TL_FACET_ROW);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_mat3 ra = tl_lanes9_get(&rows->ra, l), rb = tl_lanes9_get(&rows->rb, l);
        tl_vec3 na = tl_m3_mul(&ra, row_vec3(facet, NA, l));
        tl_vec3 nb = tl_m3_mul(&rb, row_vec3(facet, NB, l));
        tl_vec3 last = row_vec3(facet, LAST, l), last_lean = row_vec3(facet, LAST_LEAN, l);
        put_facing(f, l, facing_in(rows, l, na, nb, facet[OFFSET][l]));
        put_turn(f, l, last, last_lean);
        put_tilt(f, l, last, last_lean, rows->carry[l]);
        double in_b = rows->kind[l] == TL_FACET_FACE_A ? 1 : 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                f->to.m[i][j][l] = choose(in_b, rb.m[i][j], ra.m[i][j]);
        tl_lanes3_put(&f->from, l, choose3(in_b, tl_lanes3_get(&rows->d, l), tl_v3(0, 0, 0)));
    }
}

void tl_frames_put_facets(tl_frames *f, tl_facet_rows *rows)
{
    if (rows->new_edges)
        put_edges(rows);
    rows->new_edges = false;
    put_facets(f, rows);
}

/* The turn of A's frame is the same in all rows. */
TL_VECTORIZED static void put_couples(double *const couple[3], size_t begin, size_t end,
                                      const tl_lanes9 *restrict ra, const tl_lanes3 *restrict swing)
{
    tl_lanes3 turned;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_mat3 turn = tl_lanes9_get(ra, l);
        tl_lanes3_put(&turned, l, tl_m3_mul(&turn, tl_lanes3_get(swing, l)));
    }
    for (size_t at = begin * TL_LANES; at < end * TL_LANES; at += TL_LANES) {
        memcpy(couple[0] + at, turned.x, sizeof turned.x);
        memcpy(couple[1] + at, turned.y, sizeof turned.y);
        memcpy(couple[2] + at, turned.z, sizeof turned.z);
    }
}

void tl_frames_put_couples(double *const couple[3], size_t begin, size_t end, const tl_lanes9 *ra,
                           const tl_lanes3 *swing)
{
    put_couples(couple, begin, end, ra, swing);
}

void tl_frames_put(tl_frames *f, size_t l, const tl_model *m, uint32_t c, const tl_facet *facet,
                   double carry)
{
    tl_sight s = tl_sight_of(m, c);
    tl_facing to = tl_facing_of(facet, &s);
    bool in_b = tl_facet_in_b(facet);
    const tl_pose *a = &m->bodies.pose[m->blocks.body[s.a]];
    const tl_pose *b = &m->bodies.pose[m->blocks.body[s.b]];
    tl_vec3 half_a = half_turn(a->w_moved, tangent_of(angle2(a->w_moved, m->dt)), m->dt);
    tl_vec3 half_b = half_turn(b->w_moved, tangent_of(angle2(b->w_moved, m->dt)), m->dt);
    put_motion(f, l, half_a, half_b, way_between(a->v_moved, b->v_moved, m->dt), s.d);
    tl_lanes9_put(&f->to, l, in_b ? s.rb : s.ra);
    tl_lanes3_put(&f->from, l, in_b ? s.d : tl_v3(0, 0, 0));
    put_facing(f, l, to);
    put_turn(f, l, facet->last, facet->last_lean);
    put_tilt(f, l, facet->last, facet->last_lean, carry);
}
