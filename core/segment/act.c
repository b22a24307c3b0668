/* act.c - segments follow their sides, and push them apart by the laws of their joints.
 *
 * A SIMD group of segments is taken at a time. A side carries the three points of a segment with it. Let x be the
 * place of the first corner of its triangle, and a and b the edges from there. Let x', a' and b' be how these have
 * changed in the last step. A point of weights w lies at x + w1 a + w2 b and has moved by x' + w1 a' + w2 b'. With the
 * normal m and size = |a x b| the triangle turns by
 *
 *     turn = ((b . a' - a . b') m / 2 + (m . b') a - (m . a') b) / size
 *
 * A rigid side carries its points likewise: x is then its centroid, and it has three edges, the axes of its frame.
 *
 * Let s be the share of the outline that is B's (overlay.h), and p = s n_A - (1 - s) n_B. Then the common normal is
 * n = p / |p|, and the gap n . e, e = x_B - x_A. So a point on the side with the outline presses along the normal of
 * the other side, by its distance from that: the gradient of the energy, however far the sides tilt.
 *
 * Forces act at the place x_A + s e. The motion is that of both sides there. Shear v turns from the last normal to this
 * one, v - (n . v) (n_last + n) / (1 + n_last . n), and by the spin of s A + (1 - s) B about it. A force f on B acts on
 * the corners by the weights. Weights add up to 1, so the first corner gets what the others leave. The rest is couples,
 *
 *     on A  -s e x f_s + f_n s n_A x t / |p|,    on B  -(1 - s) e x f_s - f_n (1 - s) n_B x t / |p|
 *
 * with t the part of e along the plane, for it turns with the normals. Couples act by the transpose of the turn. So
 * work, forces, moments and energy agree whatever the triangles do. */
#include "segment/act.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "base/inside.h"
#include "base/lanes.h"
#include "base/parallel.h"
#include "base/series.h"
#include "contact/contacts.h"
#include "force/contact_damping.h"
#include "force/joint_laws.h"
#include "model/law_time.h"
#include "segment/blend.h"
#include "segment/closed.h"
#include "segment/lay.h"

#include <math.h>
#include <string.h>
#include <talus/elementary.h>

/* SIMD groups that a law gets at a time. */
#define TILE 4
/* Gridpoints that a thread takes at a time. */
#define CHUNK 1024
/* Points of a group, and of a tile. */
#define GROUP_POINTS (TL_SEGMENT_POINTS * TL_LANES)
#define TILE_POINTS (TILE * GROUP_POINTS)
/* Tolerance: slide or stretch over the size of the smaller triangle, the root of its area, from which on a segment is
 * laid anew. Areas of all, slivers too, are off by such a share of that of the triangle. */
#define SLID 1e-3

/* Tolerance: how far corners of a segment may be beyond its points, over the largest difference of these: of a triangle
 * 1, of slivers cut off of one somewhat more. */
#define CORNERS_BEYOND 4.0

/* One side of a SIMD group of segments now, as couples act on it. */
typedef struct side_lanes {
    _Alignas(TL_ALIGN) double normal[3][TL_LANES]; /* outward */
    double edge[2][3][TL_LANES];                   /* a and b over the size, 1/m; of rigid sides 0 */
} side_lanes;

/* How the sides of a group, A and B, carry points. A point of weights w lies at x[0] + w1 x[1] + w2 x[2], and has moved
 * by d[0] + w1 d[1] + w2 d[2]. Of a triangle x are the place of the first corner and the edges from it. d are their
 * changes in the last step. Of a rigid body x are its centroid and two axes of its frame. */
typedef struct carry_lanes {
    _Alignas(TL_ALIGN) double x[2][3][3][TL_LANES]; /* by side, number, component */
    double d[2][3][3][TL_LANES];
    double turn[2][3][TL_LANES];
    double size[2][TL_LANES]; /* twice the area of a triangle, m2; INFINITY of a rigid body */
} carry_lanes;

/* What a group has more where some sides are rigid: w0 times the first axis of the frame, which of triangles is 0. What
 * lies off a side by e has moved by `off` e beside it, of triangles turn x e. */
typedef struct rigid_lanes {
    _Alignas(TL_ALIGN) double x[2][3][TL_LANES], d[2][3][TL_LANES];
    double off[2][3][3][TL_LANES]; /* by side, row, column */
} rigid_lanes;

/* What is known of a tile's points only in a step. */
typedef struct lanes {
    _Alignas(TL_ALIGN) double closure[TILE_POINTS];
    double du_n[TILE_POINTS], normal[3][TILE_POINTS], du_s[3][TILE_POINTS];
    double stored[TILE_POINTS], dissipated[TILE_POINTS], zero[TILE_POINTS];
    double apart[3][TILE_POINTS];  /* e */
    double beside[TILE_POINTS];    /* normal forces that laws do not know: of segments that are closed in part, N */
    side_lanes side[TILE][2];      /* of the groups */
    double per_p[TILE * TL_LANES]; /* 1 / |p| */
    bool rigid[TILE];              /* there may be rigid sides in the group: */
    bool rigid_side[TILE][2][TL_LANES];
    bool parts;                   /* some segments are closed in part */
    bool partly[TILE * TL_LANES]; /* a part of it is closed, and a part is apart: */
    tl_closed closed[TILE * TL_LANES];
} lanes;

/* What points have where there is nothing. */
static const double nothing[TILE_POINTS];

/* ---------------------------------------------------------------- sides ------------------ */

static void put(double (*to)[TL_LANES], size_t lane, tl_vec3 v)
{
    to[0][lane] = v.x;
    to[1][lane] = v.y;
    to[2][lane] = v.z;
}

TL_INLINE double dot_of(tl_vec3 a, tl_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

TL_INLINE tl_vec3 get(double (*from)[TL_LANES], size_t lane)
{
    return (tl_vec3){from[0][lane], from[1][lane], from[2][lane]};
}

/* What a point has moved beside the centroid as the body turned by w, as it acts on its arm now (force/follow.c). */
static tl_mat3 turned_back(tl_vec3 w)
{
    const double a = tl_v3_norm(w);
    const tl_vec3 h = tl_v3_scale(a > 0 ? tl_tan(0.5 * a) / a : 0.5, w), s = tl_v3_scale(2 / (1 + tl_v3_norm2(h)), h);
    return (tl_mat3){{{s.y * h.y + s.z * h.z, -s.x * h.y - s.z, -s.x * h.z + s.y},
                      {-s.y * h.x + s.z, s.z * h.z + s.x * h.x, -s.y * h.z - s.x},
                      {-s.z * h.x - s.y, -s.z * h.y + s.x, s.x * h.x + s.y * h.y}}};
}

/* An axis of a body's frame. */
static tl_vec3 axis_of(const tl_mat3 *r, int k)
{
    return tl_v3(r->m[0][k], r->m[1][k], r->m[2][k]);
}

/* A rigid side, whose normal in the body's frame is given, once the others are known. */
static void put_rigid(const tl_model *m, uint32_t body, tl_vec3 normal, size_t lane, int side, carry_lanes *to,
                      rigid_lanes *more, side_lanes *now)
{
    const tl_pose *pose = &m->bodies.pose[body];
    const tl_vec3 turn = tl_v3_scale(m->dt, pose->w_moved), zero = {0, 0, 0};
    const tl_mat3 back = turned_back(turn);
    for (int k = 0; k < 3; k++) {
        const tl_vec3 axis = axis_of(&pose->r, k);
        put(k > 0 ? to->x[side][k] : more->x[side], lane, axis);
        put(k > 0 ? to->d[side][k] : more->d[side], lane, tl_m3_mul(&back, axis));
        for (int c = 0; c < 3; c++)
            more->off[side][k][c][lane] = back.m[k][c];
    }
    put(to->x[side][0], lane, tl_body_place(&m->bodies, body));
    put(to->d[side][0], lane, tl_v3_scale(m->dt, pose->v_moved));
    put(to->turn[side], lane, turn);
    to->size[side][lane] = INFINITY;
    put(now->normal, lane, tl_m3_mul(&pose->r, normal));
    put(now->edge[0], lane, zero);
    put(now->edge[1], lane, zero);
}

/* The corners of triangles. */
TL_INLINE void load_corners(const struct tl_segments *s, size_t row, int side, carry_lanes *restrict to)
{
    const double *place = tl_gridpoints_aligned(s->now)->place, *way = tl_gridpoints_aligned(s->now)->way;
    for (int k = 0; k < 3; k++) {
        const uint32_t *corner = s->table.corner[side][k] + row;
        for (size_t l = 0; l < TL_LANES; l += 4) {
            tl_lanes_turn3(place, corner + l, to->x[side][k][0] + l);
            tl_lanes_turn3(way, corner + l, to->d[side][k][0] + l);
        }
    }
}

TL_INLINE void put_lane(double (*to)[TL_LANES], size_t l, double x, double y, double z)
{
    to[0][l] = x, to[1][l] = y, to[2][l] = z;
}

/* One side of the group whose first segment has a row, as if all were triangles. Whether some are not. */
TL_INLINE bool find_side(const struct tl_segments *s, size_t row, int side, carry_lanes *restrict to,
                         side_lanes *restrict now)
{
    double(*x)[3][TL_LANES] = to->x[side], (*d)[3][TL_LANES] = to->d[side];
    uint32_t least = UINT32_MAX;
    load_corners(s, row, side, to);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_vec3 first = get(x[0], l), moved = get(d[0], l);
        const tl_vec3 a = tl_v3_sub(get(x[1], l), first), b = tl_v3_sub(get(x[2], l), first);
        const tl_vec3 da = tl_v3_sub(get(d[1], l), moved), db = tl_v3_sub(get(d[2], l), moved);
        const tl_vec3 area = tl_v3_cross(a, b);
        const double size = sqrt(dot_of(area, area)), per = 1 / size;
        const tl_vec3 n = {per * area.x, per * area.y, per * area.z}, ea = {per * a.x, per * a.y, per * a.z};
        const tl_vec3 eb = {per * b.x, per * b.y, per * b.z};
        const double spin = 0.5 * (dot_of(eb, da) - dot_of(ea, db)), up_a = dot_of(n, da), up_b = dot_of(n, db);
        to->size[side][l] = size;
        put_lane(x[1], l, a.x, a.y, a.z);
        put_lane(x[2], l, b.x, b.y, b.z);
        put_lane(d[1], l, da.x, da.y, da.z);
        put_lane(d[2], l, db.x, db.y, db.z);
        put_lane(to->turn[side], l, spin * n.x + up_b * ea.x - up_a * eb.x, spin * n.y + up_b * ea.y - up_a * eb.y,
                 spin * n.z + up_b * ea.z - up_a * eb.z);
        put_lane(now->normal, l, n.x, n.y, n.z);
        put_lane(now->edge[0], l, ea.x, ea.y, ea.z);
        put_lane(now->edge[1], l, eb.x, eb.y, eb.z);
    }
    for (size_t l = 0; l < TL_LANES; l++)
        least = s->table.corner[side][0][row + l] < least ? s->table.corner[side][0][row + l] : least;
    return least < TL_SEGMENT_DUMMIES;
}

/* Both sides of the group. */
TL_VECTORIZED static bool find_sides(const struct tl_segments *s, size_t row, carry_lanes *to, side_lanes now[2])
{
    const bool a = find_side(s, row, 0, to, &now[0]), b = find_side(s, row, 1, to, &now[1]);
    return a || b;
}

/* Rigid sides of a group take their lanes. */
static void put_rigid_sides(const tl_model *m, size_t row, carry_lanes *to, rigid_lanes *more, side_lanes now[2],
                            bool (*rigid)[TL_LANES])
{
    const tl_segment *of = &m->segments->table.of[row];
    memset(more, 0, sizeof *more);
    for (int side = 0; side < 2; side++)
        for (size_t l = 0; l < TL_LANES; l++) {
            const tl_segment_side *one = side ? &of[l].b : &of[l].a;
            const tl_vec3 turn = get(to->turn[side], l);
            rigid[side][l] = of[l].meet != TL_NO_ROW && tl_side_is_rigid(one);
            if (rigid[side][l]) {
                put_rigid(m, one->at[0], side ? of[l].normal_b : of[l].normal_a, l, side, to, more, &now[side]);
                continue;
            }
            put(more->off[side][0], l, tl_v3(0, -turn.z, turn.y));
            put(more->off[side][1], l, tl_v3(turn.z, 0, -turn.x));
            put(more->off[side][2], l, tl_v3(-turn.y, turn.x, 0));
        }
}

/* ---------------------------------------------------------------- following -------------- */

/* The common normals of a group: from the last ones, `from`, plus these. Shear v turns into the plane of n by
 * v - swing (n . v) (from + n), and about n by an angle of which cos and sin are known. Beside that: where B's first
 * place lies from A's, how far it has moved more, and the turn of both. */
typedef struct turn_lanes {
    _Alignas(TL_ALIGN) double normal[3][TL_LANES], both[3][TL_LANES];
    double swing[TL_LANES], cosine[TL_LANES], sine[TL_LANES];
    double x[3][TL_LANES], d[3][TL_LANES], turn[3][TL_LANES];
} turn_lanes;

TL_INLINE void turn_normals(tl_segment_table *t, size_t row, carry_lanes *c, side_lanes *a, side_lanes *b,
                            turn_lanes *restrict to, double *restrict per_p)
{
    double *restrict nx = t->normal[0] + row, *restrict ny = t->normal[1] + row, *restrict nz = t->normal[2] + row;
    const double *restrict share = t->share + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const double s = share[l], rest = 1 - s;
        const tl_vec3 na = get(a->normal, l), nb = get(b->normal, l), last = {nx[l], ny[l], nz[l]};
        const tl_vec3 p = {s * na.x - rest * nb.x, s * na.y - rest * nb.y, s * na.z - rest * nb.z};
        const tl_vec3 ta = get(c->turn[0], l), tb = get(c->turn[1], l);
        const tl_vec3 turn = {s * ta.x + rest * tb.x, s * ta.y + rest * tb.y, s * ta.z + rest * tb.z};
        const tl_vec3 x = tl_v3_sub(get(c->x[1][0], l), get(c->x[0][0], l));
        const tl_vec3 d = tl_v3_sub(get(c->d[1][0], l), get(c->d[0][0], l));
        const double per = 1 / sqrt(dot_of(p, p));
        const tl_vec3 n = {per * p.x, per * p.y, per * p.z};
        const double half = 0.5 * dot_of(turn, n), half2 = half * half, scale = 1 / (1 + half2);
        const double cosine = 1 + dot_of(last, n);
        const double same = n.x == last.x ? (n.y == last.y ? (n.z == last.z ? 1 : 0) : 0) : 0;
        const double swings = cosine > 0 ? 1 / (cosine > 0 ? cosine : 1) : 0;
        per_p[l] = per;
        nx[l] = n.x, ny[l] = n.y, nz[l] = n.z;
        put_lane(to->normal, l, n.x, n.y, n.z);
        put_lane(to->both, l, last.x + n.x, last.y + n.y, last.z + n.z);
        put_lane(to->x, l, x.x, x.y, x.z);
        put_lane(to->d, l, d.x, d.y, d.z);
        put_lane(to->turn, l, turn.x, turn.y, turn.z);
        to->swing[l] = same > 0 ? 0 : swings;
        to->cosine[l] = (1 - half2) * scale;
        to->sine[l] = 2 * half * scale;
    }
}

/* What B moved more than A where sides are rigid, and points lie apart by e, but for the motion of both sides. */
TL_INLINE tl_vec3 carried_off(rigid_lanes *of, double share, tl_vec3 e, size_t l)
{
    double sum[3];
    for (int k = 0; k < 3; k++) {
        const double x = share * of->off[0][k][0][l] + (1 - share) * of->off[1][k][0][l];
        const double y = share * of->off[0][k][1][l] + (1 - share) * of->off[1][k][1][l];
        const double z = share * of->off[0][k][2][l] + (1 - share) * of->off[1][k][2][l];
        sum[k] = x * e.x + y * e.y + z * e.z;
    }
    return (tl_vec3){sum[0], sum[1], sum[2]};
}

/* What a point adds to the first place of a side, or to its motion. */
TL_INLINE tl_vec3 carried(double (*x)[3][TL_LANES], tl_vec3 w, size_t l)
{
    return (tl_vec3){w.y * x[1][0][l] + w.z * x[2][0][l], w.y * x[1][1][l] + w.z * x[2][1][l],
                     w.y * x[1][2][l] + w.z * x[2][2][l]};
}

/* How a point is turned that was shear of the last plane. */
TL_INLINE tl_vec3 turned_shear(tl_vec3 f, const turn_lanes *turn, tl_vec3 n, size_t l)
{
    const double off = turn->swing[l] * dot_of(f, n), cosine = turn->cosine[l], sine = turn->sine[l];
    const tl_vec3 v = {f.x - off * turn->both[0][l], f.y - off * turn->both[1][l], f.z - off * turn->both[2][l]};
    const tl_vec3 across = tl_v3_cross(n, v);
    return (tl_vec3){cosine * v.x + sine * across.x, cosine * v.y + sine * across.y, cosine * v.z + sine * across.z};
}

/* Point k of each segment of a group: what a law gets of it, from `at` on, and its shear. `slid2`: the square of the
 * farthest that the points of a segment have slid. `more`: NULL where no side is rigid. */
TL_INLINE void follow_points(const struct tl_segments *s, size_t row, size_t k, carry_lanes *c, rigid_lanes *more,
                             turn_lanes *turn, size_t at, lanes *restrict to, double slid2[TL_LANES])
{
    const tl_segment_points *p = &s->points;
    const size_t point = TL_SEGMENT_POINTS * row + k * TL_LANES;
    const double *restrict ax = p->at_a[0] + point, *restrict ay = p->at_a[1] + point,
                           *restrict az = p->at_a[2] + point;
    const double *restrict bx = p->at_b[0] + point, *restrict by = p->at_b[1] + point,
                           *restrict bz = p->at_b[2] + point;
    double *restrict sx = p->f_s[0] + point, *restrict sy = p->f_s[1] + point, *restrict sz = p->f_s[2] + point;
    const double *restrict reference = p->reference ? p->reference + point : nothing;
    const double *restrict share = s->table.share + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_vec3 wa = {more ? ax[l] : 0, ay[l], az[l]}, wb = {more ? bx[l] : 0, by[l], bz[l]};
        const tl_vec3 n = get(turn->normal, l), t = get(turn->turn, l), f = {sx[l], sy[l], sz[l]};
        tl_vec3 on_b = carried(c->x[1], wb, l), on_a = carried(c->x[0], wa, l);
        tl_vec3 b_moved = carried(c->d[1], wb, l), a_moved = carried(c->d[0], wa, l);
        if (more) {
            on_a = tl_v3_madd(on_a, wa.x, get(more->x[0], l));
            on_b = tl_v3_madd(on_b, wb.x, get(more->x[1], l));
            a_moved = tl_v3_madd(a_moved, wa.x, get(more->d[0], l));
            b_moved = tl_v3_madd(b_moved, wb.x, get(more->d[1], l));
        }
        const tl_vec3 apart = tl_v3_add(get(turn->x, l), tl_v3_sub(on_b, on_a));
        const tl_vec3 of_sides = tl_v3_add(get(turn->d, l), tl_v3_sub(b_moved, a_moved));
        const tl_vec3 off = more ? carried_off(more, share[l], apart, l) : tl_v3_cross(t, apart);
        const tl_vec3 du = tl_v3_sub(of_sides, off);
        const double gap = dot_of(apart, n), du_n = dot_of(du, n), aside2 = dot_of(apart, apart) - gap * gap;
        const tl_vec3 turned = turned_shear(f, turn, n, l);
        to->closure[at + l] = -gap - reference[l];
        to->du_n[at + l] = du_n;
        to->apart[0][at + l] = apart.x, to->apart[1][at + l] = apart.y, to->apart[2][at + l] = apart.z;
        to->normal[0][at + l] = n.x, to->normal[1][at + l] = n.y, to->normal[2][at + l] = n.z;
        to->du_s[0][at + l] = du.x - du_n * n.x;
        to->du_s[1][at + l] = du.y - du_n * n.y;
        to->du_s[2][at + l] = du.z - du_n * n.z;
        sx[l] = turned.x, sy[l] = turned.y, sz[l] = turned.z;
        slid2[l] = aside2 > slid2[l] ? aside2 : slid2[l];
    }
}

/* Whether the closure of a point of some segment is below 0, or may be at a corner. */
TL_INLINE bool may_be_apart(const double *restrict closure)
{
    double least[TL_LANES], all = INFINITY;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const double c0 = closure[l], c1 = closure[l + TL_LANES], c2 = closure[l + 2 * TL_LANES];
        const double low = tl_smaller(c0, tl_smaller(c1, c2)), high = tl_larger(c0, tl_larger(c1, c2));
        least[l] = low - CORNERS_BEYOND * (high - low);
    }
    for (size_t l = 0; l < TL_LANES; l++)
        all = tl_smaller(least[l], all);
    return all < 0;
}

/* Follows a group, by its number in the tile: its points' lanes, and their shear. Notes which segments have slid. true:
 * some segments may be apart in part. */
TL_INLINE bool follow_lanes(struct tl_segments *s, size_t row, size_t number, carry_lanes *c, rigid_lanes *more,
                            lanes *to)
{
    const size_t at = number * GROUP_POINTS;
    turn_lanes turn;
    double slid2[TL_LANES];
    tl_lanes_clear(slid2);
    turn_normals(&s->table, row, c, &to->side[number][0], &to->side[number][1], &turn, to->per_p + number * TL_LANES);
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
        follow_points(s, row, k, c, more, &turn, at + k * TL_LANES, to, slid2);
    for (size_t l = 0; l < TL_LANES; l++)
        s->table.slid[row + l] = slid2[l] > 0.5 * SLID * SLID * tl_smaller(c->size[0][l], c->size[1][l]);
    return may_be_apart(to->closure + at);
}

TL_VECTORIZED static bool follow_group(struct tl_segments *s, size_t row, size_t number, carry_lanes *c, lanes *to)
{
    return follow_lanes(s, row, number, c, NULL, to);
}

TL_VECTORIZED static bool follow_rigid_group(struct tl_segments *s, size_t row, size_t number, carry_lanes *c,
                                             rigid_lanes *more, lanes *to)
{
    return follow_lanes(s, row, number, c, more, to);
}

/* Finds the sides of a group, and follows them. */
static bool follow_sides(const tl_model *m, size_t row, size_t number, lanes *to)
{
    carry_lanes carry;
    rigid_lanes more;
    to->rigid[number] = find_sides(m->segments, row, &carry, to->side[number]);
    if (!to->rigid[number])
        return follow_group(m->segments, row, number, &carry, to);
    put_rigid_sides(m, row, &carry, &more, to->side[number], to->rigid_side[number]);
    return follow_rigid_group(m->segments, row, number, &carry, &more, to);
}

/* ---------------------------------------------------------------- laws ------------------- */

typedef struct act_job {
    tl_model *m;
    tl_failure *failure;
    const tl_segment_span *span;
} act_job;

static bool call_law(const act_job *job, size_t first, size_t count, lanes *l)
{
    tl_segment_points *p = &job->m->segments->points;
    const tl_law *law = &job->m->joint_laws[job->span->law];
    double *state[TL_STATE_COLUMNS];
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < p->state_columns ? p->state[k] + first : l->zero;
    memset(l->stored, 0, count * sizeof *l->stored);
    memset(l->dissipated, 0, count * sizeof *l->dissipated);
    memset(l->zero, 0, count * sizeof *l->zero);
    const tl_law_batch batch = {.size = sizeof batch,
                                .count = (uint32_t)count,
                                .dt = tl_law_time(job->m, job->m->dt),
                                .area = p->area + first,
                                .closure = l->closure,
                                .f_n0 = p->f_n0 ? p->f_n0 + first : nothing,
                                .normal = {l->normal[0], l->normal[1], l->normal[2]},
                                .du_n = l->du_n,
                                .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
                                .f_n = p->f_n + first,
                                .f_s = {p->f_s[0] + first, p->f_s[1] + first, p->f_s[2] + first},
                                .state = state,
                                .flags = p->flags + first,
                                .stored = l->stored,
                                .dissipated = l->dissipated,
                                .closure_edge = l->closure,
                                .closure_apart = nothing};
    tl_report report;
    const tl_status status = tl_law_update(law, &batch, &report);
    const size_t bad = report.first_bad < count ? report.first_bad : 0;
    if (status != TL_OK)
        tl_failure_note(job->failure, first, status, first + bad, tl_report_text(&report, status));
    return status == TL_OK;
}

/* ---------------------------------------------------------------- partly closed ---------- */

/* Whether the points of a segment that are apart do not pull. */
static bool pulls_not(const tl_law *law, const tl_segment_points *p, uint32_t row)
{
    bool none = law->pulls != TL_PULL_ANY;
    for (size_t k = 0; k < TL_SEGMENT_POINTS && law->pulls == TL_PULL_BONDED; k++)
        none = none && (p->flags[tl_segment_point_row(row, k)] & TL_POINT_FAILED);
    return none;
}

/* How far slip and initial stress have lifted the walls of points. */
static void find_lifts(const act_job *job, size_t first, size_t count, lanes *l, double *lift)
{
    const tl_segment_points *p = &job->m->segments->points;
    const tl_law *law = &job->m->joint_laws[job->span->law];
    const tl_law_ops *ops = law->kind->ops;
    double hold[TILE_POINTS], *state[TL_STATE_COLUMNS];
    memset(lift, 0, count * sizeof *lift);
    memset(l->zero, 0, count * sizeof *l->zero);
    if (!ops->across_gap)
        return;
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < p->state_columns ? p->state[k] + first : l->zero;
    const tl_law_batch batch = {.size = sizeof batch,
                                .count = (uint32_t)count,
                                .area = p->area + first,
                                .f_n0 = p->f_n0 ? p->f_n0 + first : l->zero,
                                .state = state,
                                .flags = p->flags + first};
    tl_enter(law->kind, "across_gap");
    ops->across_gap(law->self, &batch, lift, hold);
    tl_leave();
}

/* The lane of the first point of a segment of a tile. */
static size_t lane_of(size_t number)
{
    return number / TL_LANES * GROUP_POINTS + number % TL_LANES;
}

/* Gives points of segments that are closed in part the closures of what presses. */
static void close_parts(const act_job *job, size_t first, size_t count, lanes *l)
{
    const struct tl_segments *s = job->m->segments;
    const tl_law *law = &job->m->joint_laws[job->span->law];
    double lift[TILE_POINTS];
    bool known = false;
    for (size_t i = 0; i < count; i++) {
        const uint32_t row = (uint32_t)(first + i);
        const size_t lane = lane_of(i);
        double u[TL_SEGMENT_POINTS];
        l->partly[i] = false;
        if (s->table.of[row].meet == TL_NO_ROW || !pulls_not(law, &s->points, row))
            continue;
        if (!known)
            find_lifts(job, TL_SEGMENT_POINTS * first, TL_SEGMENT_POINTS * count, l, lift);
        known = true;
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
            u[k] = l->closure[lane + k * TL_LANES] + lift[lane + k * TL_LANES];
        l->parts |= l->partly[i] =
            tl_closed_part(s->outline + s->table.outline[row], s->table.corners[row], u, &l->closed[i]);
        for (size_t k = 0; k < TL_SEGMENT_POINTS && l->partly[i]; k++)
            l->closure[lane + k * TL_LANES] = l->closed[i].even[k] - lift[lane + k * TL_LANES];
    }
}

/* The stiffness, N/m3, with which the law presses on a segment that is closed in part; 0 for others. */
static double stiffness_of(const tl_segment_points *p, uint32_t row, const lanes *l, size_t number)
{
    double force = 0, closed = 0;
    for (size_t k = 0; k < TL_SEGMENT_POINTS && l->partly[number]; k++) {
        const size_t point = tl_segment_point_row(row, k);
        force += p->f_n[point];
        closed += p->area[point] * l->closed[number].even[k];
    }
    return closed > 0 ? force / closed : 0;
}

/* What presses on segments that are closed in part beside what their law knows. */
static void press_parts(const tl_segment_points *p, size_t first, size_t count, lanes *l)
{
    memset(l->beside, 0, TL_SEGMENT_POINTS * count * sizeof *l->beside);
    for (size_t i = 0; i < count; i++) {
        const double stiffness = stiffness_of(p, (uint32_t)(first + i), l, i);
        for (size_t k = 0; k < TL_SEGMENT_POINTS && stiffness > 0; k++)
            l->beside[lane_of(i) + k * TL_LANES] =
                stiffness * p->area[tl_segment_point_row(first + i, k)] * l->closed[i].rest[k];
    }
}

/* And what they store beside that. */
static void store_parts(struct tl_segments *s, size_t first, size_t count, const lanes *l)
{
    for (size_t i = 0; i < count; i++)
        if (l->partly[i])
            s->table.stored[first + i] += 0.5 * stiffness_of(&s->points, (uint32_t)(first + i), l, i) *
                                          s->table.area[first + i] * l->closed[i].second;
}

/* ---------------------------------------------------------------- pushing ---------------- */

/* What a group does to its sides: forces on the corners, with their sizes. Where sides are rigid, also what these come
 * from: the forces of the points on B, and the couples. */
typedef struct push_lanes {
    _Alignas(TL_ALIGN) double corner[2][3][4][TL_LANES]; /* by side, corner, component */
    double point[3][3][TL_LANES];
    double couple[2][3][TL_LANES];
} push_lanes;

/* How far the sides are apart at a point. */
TL_INLINE tl_vec3 apart_at(const lanes *of, size_t at)
{
    return (tl_vec3){of->apart[0][at], of->apart[1][at], of->apart[2][at]};
}

TL_INLINE double size_of(tl_vec3 v)
{
    return sqrt(dot_of(v, v));
}

TL_INLINE tl_vec3 sum_of(tl_vec3 a, tl_vec3 b, tl_vec3 c)
{
    return tl_v3_add(tl_v3_add(a, b), c);
}

/* Forces of the three points of a segment, by weights. */
TL_INLINE tl_vec3 weighed(const double *w, tl_vec3 f0, tl_vec3 f1, tl_vec3 f2)
{
    const double w0 = w[0], w1 = w[TL_LANES], w2 = w[2 * TL_LANES];
    return (tl_vec3){w0 * f0.x + w1 * f1.x + w2 * f2.x, w0 * f0.y + w1 * f1.y + w2 * f2.y,
                     w0 * f0.z + w1 * f1.z + w2 * f2.z};
}

TL_INLINE void put_push(double (*to)[TL_LANES], size_t l, tl_vec3 f)
{
    put_lane(to, l, f.x, f.y, f.z);
    to[3][l] = size_of(f);
}

/* The forces on the corners of a side: `sign` times those of points, by their weights from a row on, and a couple's.
 * The weights of a triangle add up to 1, so the first corner gets what the others leave of the sum. */
TL_INLINE void push_corners(push_lanes *restrict of, int number, double *const at[3], size_t row, size_t l, double sign,
                            tl_vec3 p0, tl_vec3 p1, tl_vec3 p2, tl_vec3 all, tl_vec3 couple, side_lanes *side)
{
    const tl_vec3 n = get(side->normal, l), a = get(side->edge[0], l), b = get(side->edge[1], l);
    const double spin = 0.5 * dot_of(couple, n), on_a = dot_of(couple, a), on_b = dot_of(couple, b);
    const tl_vec3 c1 = {spin * b.x - on_b * n.x, spin * b.y - on_b * n.y, spin * b.z - on_b * n.z};
    const tl_vec3 c2 = {on_a * n.x - spin * a.x, on_a * n.y - spin * a.y, on_a * n.z - spin * a.z};
    const tl_vec3 f1 = tl_v3_madd(c1, sign, weighed(at[1] + row, p0, p1, p2)),
                  f2 = tl_v3_madd(c2, sign, weighed(at[2] + row, p0, p1, p2));
    const tl_vec3 f0 = tl_v3_sub(tl_v3_scale(sign, all), tl_v3_add(f1, f2));
    put_push(of->corner[number][0], l, f0);
    put_push(of->corner[number][1], l, f1);
    put_push(of->corner[number][2], l, f2);
}

/* Forces of the points of a group, from its first one on: across and along the face, and what presses beside that. */
typedef struct point_pushes {
    const double *normal, *shear[3], *beside;
} point_pushes;

/* Those of the law. */
TL_INLINE point_pushes own_pushes(const tl_segment_points *p, size_t row, size_t number, const lanes *of)
{
    const size_t first = TL_SEGMENT_POINTS * row;
    return (point_pushes){p->f_n + first,
                          {p->f_s[0] + first, p->f_s[1] + first, p->f_s[2] + first},
                          of->parts ? of->beside + number * GROUP_POINTS : nothing};
}

/* Sums of the points of a group, by its number in the tile: what they do to both sides, store and turn into heat.
 * `any_rigid`: some sides may be. `own`: they are the law's, else only what they do to the sides is wanted. */
TL_INLINE void push_points(struct tl_segments *s, size_t row, size_t number, lanes *of, const point_pushes *by,
                           bool any_rigid, bool own, push_lanes *restrict to)
{
    const tl_segment_points *p = &s->points;
    tl_segment_table *t = &s->table;
    const size_t first = TL_SEGMENT_POINTS * row, at = number * GROUP_POINTS;
    side_lanes *a = &of->side[number][0], *b = &of->side[number][1];
    const double *restrict beside = by->beside, *restrict per_p = of->per_p + number * TL_LANES;
    double *restrict bears = t->bears + row, *restrict stored = t->stored + row, *restrict heat = t->heat + row;
    const double *restrict sx = by->shear[0], *restrict sy = by->shear[1], *restrict sz = by->shear[2];
    const double *restrict f_n = by->normal, *restrict shares = t->share + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const size_t j = at + l, l1 = l + TL_LANES, l2 = l + 2 * TL_LANES, j1 = j + TL_LANES, j2 = j + 2 * TL_LANES;
        const double share = shares[l], rest = 1 - share;
        const tl_vec3 n = {of->normal[0][j], of->normal[1][j], of->normal[2][j]};
        const tl_vec3 e0 = apart_at(of, j), e1 = apart_at(of, j1), e2 = apart_at(of, j2);
        const tl_vec3 s0 = {sx[l], sy[l], sz[l]}, s1 = {sx[l1], sy[l1], sz[l1]}, s2 = {sx[l2], sy[l2], sz[l2]};
        const double q0 = f_n[l] + beside[l], q1 = f_n[l1] + beside[l1], q2 = f_n[l2] + beside[l2];
        const tl_vec3 f0 = tl_v3_madd(s0, q0, n), f1 = tl_v3_madd(s1, q1, n), f2 = tl_v3_madd(s2, q2, n);
        const tl_vec3 moment = sum_of(tl_v3_cross(e0, s0), tl_v3_cross(e1, s1), tl_v3_cross(e2, s2));
        const tl_vec3 pressed = {q0 * e0.x + q1 * e1.x + q2 * e2.x, q0 * e0.y + q1 * e1.y + q2 * e2.y,
                                 q0 * e0.z + q1 * e1.z + q2 * e2.z};
        const tl_vec3 tilting = tl_v3_madd(pressed, -dot_of(pressed, n), n), all = sum_of(f0, f1, f2);
        const tl_vec3 tilts_a = tl_v3_cross(get(a->normal, l), tilting);
        const tl_vec3 tilts_b = tl_v3_cross(get(b->normal, l), tilting);
        const double tilt_a = share * per_p[l], tilt_b = -rest * per_p[l];
        const tl_vec3 on_a = {tilt_a * tilts_a.x - share * moment.x, tilt_a * tilts_a.y - share * moment.y,
                              tilt_a * tilts_a.z - share * moment.z};
        const tl_vec3 on_b = {tilt_b * tilts_b.x - rest * moment.x, tilt_b * tilts_b.y - rest * moment.y,
                              tilt_b * tilts_b.z - rest * moment.z};
        if (own) {
            bears[l] = size_of(f0) + size_of(f1) + size_of(f2);
            stored[l] = of->stored[j] + of->stored[j1] + of->stored[j2];
            heat[l] = of->dissipated[j] + of->dissipated[j1] + of->dissipated[j2];
        }
        push_corners(to, 0, p->at_a, first + l, l, -1, f0, f1, f2, all, on_a, a);
        push_corners(to, 1, p->at_b, first + l, l, 1, f0, f1, f2, all, on_b, b);
        if (any_rigid) {
            put_lane(to->point[0], l, f0.x, f0.y, f0.z);
            put_lane(to->point[1], l, f1.x, f1.y, f1.z);
            put_lane(to->point[2], l, f2.x, f2.y, f2.z);
            put_lane(to->couple[0], l, on_a.x, on_a.y, on_a.z);
            put_lane(to->couple[1], l, on_b.x, on_b.y, on_b.z);
        }
    }
}

TL_INLINE void store_pushes(tl_segment_push *to, push_lanes *by)
{
    for (size_t l = 0; l < TL_LANES; l += 4, to += 4) {
        for (int side = 0; side < 2; side++)
            for (int c = 0; c < 3; c++) {
                double(*corner)[TL_LANES] = by->corner[side][c];
                const double *const column[4] = {corner[0] + l, corner[1] + l, corner[2] + l, corner[3] + l};
                tl_lanes_turn(column, to[0].of[side][c], to[1].of[side][c], to[2].of[side][c], to[3].of[side][c]);
            }
    }
}

TL_VECTORIZED static void push_group(struct tl_segments *s, size_t row, size_t number, lanes *of, push_lanes *by)
{
    const point_pushes own = own_pushes(&s->points, row, number, of);
    push_points(s, row, number, of, &own, false, true, by);
    store_pushes(s->table.push + row, by);
}

TL_VECTORIZED static void push_rigid_group(struct tl_segments *s, size_t row, size_t number, lanes *of, push_lanes *by)
{
    const point_pushes own = own_pushes(&s->points, row, number, of);
    push_points(s, row, number, of, &own, true, true, by);
    store_pushes(s->table.push + row, by);
}

/* A rigid side gets the force, and the moment about its centroid: a couple, and that of the forces of the points. */
static void push_rigid(const tl_model *m, size_t row, int side, push_lanes *by, tl_segment_push *push)
{
    const tl_segment_points *p = &m->segments->points;
    const tl_segment *of = &m->segments->table.of[row];
    const uint32_t body = side ? of->b.at[0] : of->a.at[0];
    double(*to)[4] = push->of[side];
    const size_t lane = row % TL_LANES;
    tl_vec3 force = {0, 0, 0}, moment = get(by->couple[side], lane);
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const tl_vec3 f = tl_v3_scale(side ? 1 : -1, get(by->point[k], lane));
        const tl_vec3 at = tl_columns_get(side ? p->at_b : p->at_a, tl_segment_point_row(row, k));
        force = tl_v3_add(force, f);
        moment = tl_v3_add(moment, tl_v3_cross(tl_m3_mul(&m->bodies.pose[body].r, at), f));
    }
    const tl_vec3 both[2] = {force, moment};
    for (int k = 0; k < 2; k++) {
        to[k][0] = both[k].x;
        to[k][1] = both[k].y;
        to[k][2] = both[k].z;
    }
}

static void push_sides(const tl_model *m, size_t row, size_t number, lanes *of)
{
    push_lanes by;
    if (!of->rigid[number]) {
        push_group(m->segments, row, number, of, &by);
        return;
    }
    push_rigid_group(m->segments, row, number, of, &by);
    for (size_t l = 0; l < TL_LANES; l++)
        for (int side = 0; side < 2; side++)
            if (of->rigid_side[number][side][l])
                push_rigid(m, row + l, side, &by, &m->segments->table.push[row + l]);
}

/* ---------------------------------------------------------------- damping ---------------- */

/* What the points of a tile carry before their law is called, then their damping. */
typedef struct damping_lanes {
    _Alignas(TL_ALIGN) double of[4][TILE_POINTS];
} damping_lanes;

static tl_point_forces forces_in(damping_lanes *d)
{
    return (tl_point_forces){d->of[0], {d->of[1], d->of[2], d->of[3]}};
}

/* What the damping of the points of a group does to its sides. */
static void damp_sides(const tl_model *m, size_t row, size_t number, lanes *of, damping_lanes *d)
{
    push_lanes by;
    const size_t at = number * GROUP_POINTS;
    const point_pushes damping = {d->of[0] + at, {d->of[1] + at, d->of[2] + at, d->of[3] + at}, nothing};
    tl_segment_push *to = m->segments->damping + row;
    push_points(m->segments, row, number, of, &damping, true, false, &by);
    store_pushes(to, &by);
    for (size_t l = 0; l < TL_LANES && of->rigid[number]; l++)
        for (int side = 0; side < 2; side++)
            if (of->rigid_side[number][side][l])
                push_rigid(m, row + l, side, &by, &to[l]);
}

static void damp_tile(const act_job *job, size_t first, size_t groups, lanes *l, damping_lanes *d)
{
    const tl_segment_points *p = &job->m->segments->points;
    const size_t point = TL_SEGMENT_POINTS * first;
    const tl_damped_points of = {groups * GROUP_POINTS,
                                 p->area + point,
                                 p->f_n + point,
                                 {p->f_s[0] + point, p->f_s[1] + point, p->f_s[2] + point},
                                 l->du_n,
                                 {l->du_s[0], l->du_s[1], l->du_s[2]},
                                 p->flags + point};
    const tl_point_forces forces = forces_in(d);
    tl_damping_of_points(&job->m->joint_laws[job->span->law], &of, job->m->segments->damping_rate, &forces);
    for (size_t g = 0; g < groups; g++)
        damp_sides(job->m, first + g * TL_LANES, g, l, d);
}

static void act_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const act_job *job = user;
    tl_model *m = job->m;
    const size_t first = (job->span->group_begin + begin) * TL_LANES, groups = end - begin, count = groups * TL_LANES;
    bool apart = false;
    lanes l;
    l.parts = false;
    for (size_t g = 0; g < groups; g++)
        apart |= follow_sides(m, first + g * TL_LANES, g, &l);
    if (apart)
        close_parts(job, first, count, &l);
    damping_lanes d;
    const bool damped = m->segments->damping_rate > 0;
    if (damped) {
        const tl_point_forces forces = forces_in(&d);
        const tl_segment_points *p = &m->segments->points;
        tl_damping_note(p->f_n, p->f_s, TL_SEGMENT_POINTS * first, TL_SEGMENT_POINTS * count, &forces);
    }
    if (!call_law(job, TL_SEGMENT_POINTS * first, TL_SEGMENT_POINTS * count, &l))
        return;
    if (l.parts)
        press_parts(&m->segments->points, first, count, &l);
    for (size_t g = 0; g < groups; g++)
        push_sides(m, first + g * TL_LANES, g, &l);
    if (damped)
        damp_tile(job, first, groups, &l, &d);
    if (l.parts)
        store_parts(m->segments, first, count, &l);
}

static void touch_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    tl_gridpoint_now *now = tl_gridpoints_aligned(m->segments->now) + TL_SEGMENT_DUMMIES;
    for (size_t k = begin; k < end; k++)
        tl_gridpoint_put(&now[k], &m->zones->points, m->segments->touched[k], m->zones->moved_dt);
}

/* Where gridpoints are that segments touch. */
static void find_touched(tl_model *m)
{
    tl_gridpoint_now *now = tl_gridpoints_aligned(m->segments->now);
    for (int k = 0; k < TL_SEGMENT_DUMMIES; k++)
        now[k] = (tl_gridpoint_now){{k == 1, k == 2, 0}, {0}};
    tl_parallel_for(m->pool, m->segments->touched_count, CHUNK, touch_range, m);
}

tl_status tl_segments_prepare(tl_model *m, double damping_rate)
{
    struct tl_segments *s = m->segments;
    if (!s)
        return TL_OK;
    const size_t need = s->touched_count + TL_SEGMENT_DUMMIES + 1, rows = damping_rate > 0 ? s->table.table.rows : 0;
    s->damping_rate = damping_rate;
    const bool enough = tl_fit(&s->now, &s->now_capacity, need, sizeof *s->now) &&
                        tl_fit(&s->damping, &s->damping_capacity, rows, sizeof *s->damping);
    if (enough && rows > 0)
        memset(s->damping, 0, rows * sizeof *s->damping);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

tl_status tl_segments_apply(tl_model *m, tl_failure *failure)
{
    struct tl_segments *s = m->segments;
    if (s)
        find_touched(m);
    for (size_t k = 0; s && k < s->span_count && failure->error.status == TL_OK; k++) {
        act_job job = {m, failure, &s->span[k]};
        if (job.span->law != TL_NO_ROW)
            tl_parallel_for(m->pool, job.span->group_end - job.span->group_begin, TILE, act_range, &job);
    }
    if (s && failure->error.status == TL_OK)
        tl_blends_apply(m);
    return failure->error.status;
}
