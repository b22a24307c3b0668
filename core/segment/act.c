/* act.c - segments follow their sides, and push them apart by the laws of their joints.
 *
 * A SIMD group of segments is taken at a time.
 *
 * A side carries the three points of a segment with it. Let x be the places of the corners of its triangle, and d how
 * they have moved in the last step. A point of weights w lies at sum w x and has moved by sum w d. The triangle spins
 * about its own outward normal by
 *
 *     spin = (e_2 . d_1 - e_1 . d_2) / (2 size),    size = |e_1 x e_2|
 *
 * with its edges e_1 and e_2 from the first corner, and d_1, d_2 how their ends have moved beside that. A rigid side
 * carries its points likewise: x are then the axes of its frame, from its centroid.
 *
 * The common normal n bisects those of both sides. The gap is n . (x_B - x_A), its closure what a law gets, the motion
 * d_B - d_A. Shear turns from the last normal to this one and by the mean spin about it: with the outward normals a and
 * b, (spin_A - spin_B) / |a - b|, which is that of two sides that turn together. What a point bears acts on the corners
 * by the same weights, so work, forces and energy agree whatever the triangles do. */
#include "segment/act.h"

#include "base/columns.h"
#include "base/lanes.h"
#include "base/parallel.h"
#include "base/series.h"
#include "contact/contacts.h"
#include "contact/plane_turn.h"
#include "force/joint_laws.h"
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
/* Tolerance: slide or stretch of a segment over its size, from which on it is laid anew. */
#define SLID 1e-3

/* What is known of a tile's points only in a step. */
typedef struct lanes {
    _Alignas(TL_ALIGN) double closure[TILE_POINTS];
    double du_n[TILE_POINTS], normal[3][TILE_POINTS], du_s[3][TILE_POINTS];
    double stored[TILE_POINTS], dissipated[TILE_POINTS], zero[TILE_POINTS];
} lanes;

/* What points have where there is nothing. */
static const double none[TILE_POINTS];

/* ---------------------------------------------------------------- sides ------------------ */

/* One side of a SIMD group of segments now. A point of weights w lies at origin + sum w x, and has moved by shift +
 * sum w d. Of a triangle x are the places of its corners, and d how they have moved in the last step. Of a rigid body
 * they are the axes of its frame, and what the ends of these have moved beside its centroid. */
typedef struct side_lanes {
    _Alignas(TL_ALIGN) double x[3][3][TL_LANES]; /* by corner, component */
    double d[3][3][TL_LANES];
    double (*origin)[TL_LANES], (*shift)[TL_LANES]; /* zeros unless there are rigid sides: `own` */
    double own[2][3][TL_LANES];
    double normal[3][TL_LANES], spin[TL_LANES]; /* outward, and the turn about it in the last step */
} side_lanes;

/* Of triangles. */
static double zeros[3][TL_LANES];

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
static void put_rigid(const tl_model *m, uint32_t body, tl_vec3 normal, size_t lane, side_lanes *to)
{
    const tl_pose *pose = &m->bodies.pose[body];
    const tl_vec3 turn = tl_v3_scale(m->dt, pose->w_moved), outward = tl_m3_mul(&pose->r, normal);
    const tl_mat3 back = turned_back(turn);
    for (int k = 0; k < 3; k++) {
        const tl_vec3 axis = axis_of(&pose->r, k);
        put(to->x[k], lane, axis);
        put(to->d[k], lane, tl_m3_mul(&back, axis));
    }
    put(to->origin, lane, tl_body_place(&m->bodies, body));
    put(to->shift, lane, tl_v3_scale(m->dt, pose->v_moved));
    put(to->normal, lane, outward);
    to->spin[lane] = tl_v3_dot(turn, outward);
}

/* The corners of triangles. */
TL_INLINE void load_corners(const struct tl_segments *s, size_t row, bool is_b, side_lanes *restrict to)
{
    const double *place = tl_gridpoints_aligned(s->now)->place, *way = tl_gridpoints_aligned(s->now)->way;
    for (int k = 0; k < 3; k++) {
        const uint32_t *corner = s->table.corner[is_b][k] + row;
        for (size_t l = 0; l < TL_LANES; l += 4) {
            tl_lanes_turn3(place, corner + l, to->x[k][0] + l);
            tl_lanes_turn3(way, corner + l, to->d[k][0] + l);
        }
    }
}

/* The sides A, or B, of the group whose first segment has a row, as if all were triangles. false: some are not. */
TL_VECTORIZED static bool find_sides(const struct tl_segments *s, size_t row, bool is_b, side_lanes *to)
{
    uint32_t least = UINT32_MAX;
    load_corners(s, row, is_b, to);
    to->origin = to->shift = zeros;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_vec3 x = get(to->x[0], l), d = get(to->d[0], l);
        const tl_vec3 a = tl_v3_sub(get(to->x[1], l), x), b = tl_v3_sub(get(to->x[2], l), x);
        const tl_vec3 da = tl_v3_sub(get(to->d[1], l), d), db = tl_v3_sub(get(to->d[2], l), d);
        const tl_vec3 area = tl_v3_cross(a, b);
        const double per = 1 / sqrt(dot_of(area, area));
        to->normal[0][l] = per * area.x, to->normal[1][l] = per * area.y, to->normal[2][l] = per * area.z;
        to->spin[l] = 0.5 * per * (dot_of(b, da) - dot_of(a, db));
    }
    for (size_t l = 0; l < TL_LANES; l++)
        least = s->table.corner[is_b][0][row + l] < least ? s->table.corner[is_b][0][row + l] : least;
    return least >= TL_SEGMENT_DUMMIES;
}

/* Rigid sides of a group take their lanes. */
static void put_rigid_sides(const tl_model *m, size_t row, bool is_b, side_lanes *to)
{
    const tl_segment *of = &m->segments->table.of[row];
    memset(to->own, 0, sizeof to->own);
    to->origin = to->own[0];
    to->shift = to->own[1];
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_segment_side *side = is_b ? &of[l].b : &of[l].a;
        if (of[l].meet != TL_NO_ROW && tl_side_is_rigid(side))
            put_rigid(m, side->at[0], is_b ? of[l].normal_b : of[l].normal_a, l, to);
    }
}

/* ---------------------------------------------------------------- following -------------- */

/* Where a point of a side is, or with `d` and `shift` how it has moved. */
TL_INLINE tl_vec3 carried(double (*x)[3][TL_LANES], double (*from)[TL_LANES], tl_vec3 w, size_t l)
{
    return (tl_vec3){from[0][l] + w.x * x[0][0][l] + w.y * x[1][0][l] + w.z * x[2][0][l],
                     from[1][l] + w.x * x[0][1][l] + w.y * x[1][1][l] + w.z * x[2][1][l],
                     from[2][l] + w.x * x[0][2][l] + w.y * x[1][2][l] + w.z * x[2][2][l]};
}

/* The common normals of a group, and how shear turns: g and 2 / (1 + g.g), and whether it does. */
typedef struct turn_lanes {
    _Alignas(TL_ALIGN) double normal[3][TL_LANES], g[3][TL_LANES], scale[TL_LANES], turns[TL_LANES];
} turn_lanes;

TL_INLINE void turn_normals(tl_segment_table *t, size_t row, side_lanes *a, side_lanes *b, turn_lanes *restrict to)
{
    double *restrict nx = t->normal[0] + row, *restrict ny = t->normal[1] + row, *restrict nz = t->normal[2] + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_vec3 both = tl_v3_sub(get(a->normal, l), get(b->normal, l)), last = {nx[l], ny[l], nz[l]};
        const double per = 1 / sqrt(dot_of(both, both));
        const tl_vec3 n = {per * both.x, per * both.y, per * both.z};
        const tl_vec3 g = tl_turn_between(last, n, 0.5 * per * (a->spin[l] - b->spin[l]));
        const double g2 = dot_of(g, g);
        nx[l] = to->normal[0][l] = n.x;
        ny[l] = to->normal[1][l] = n.y;
        nz[l] = to->normal[2][l] = n.z;
        to->g[0][l] = g.x, to->g[1][l] = g.y, to->g[2][l] = g.z;
        to->scale[l] = 2 / (1 + g2);
        to->turns[l] = g2 > 0 ? 1 : 0;
    }
}

/* Point k of each segment of a group: what a law gets of it, from `at` on, and its shear. `slid2`: the square of the
 * farthest that the points of a segment have slid. */
TL_INLINE void follow_points(const tl_segment_points *p, size_t point, side_lanes *a, side_lanes *b, turn_lanes *turn,
                             size_t at, lanes *restrict to, double slid2[TL_LANES])
{
    const double *restrict ax = p->at_a[0] + point, *restrict ay = p->at_a[1] + point,
                           *restrict az = p->at_a[2] + point;
    const double *restrict bx = p->at_b[0] + point, *restrict by = p->at_b[1] + point,
                           *restrict bz = p->at_b[2] + point;
    double *restrict sx = p->f_s[0] + point, *restrict sy = p->f_s[1] + point, *restrict sz = p->f_s[2] + point;
    const double *restrict reference = p->reference ? p->reference + point : none;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const tl_vec3 wa = {ax[l], ay[l], az[l]}, wb = {bx[l], by[l], bz[l]}, n = get(turn->normal, l);
        const tl_vec3 apart = tl_v3_sub(carried(b->x, b->origin, wb, l), carried(a->x, a->origin, wa, l));
        const tl_vec3 du = tl_v3_sub(carried(b->d, b->shift, wb, l), carried(a->d, a->shift, wa, l));
        const double gap = tl_v3_dot(apart, n), du_n = tl_v3_dot(du, n);
        const tl_vec3 aside = tl_v3_madd(apart, -gap, n), f = {sx[l], sy[l], sz[l]};
        const double aside2 = dot_of(aside, aside);
        to->closure[at + l] = -gap - reference[l];
        to->du_n[at + l] = du_n;
        to->normal[0][at + l] = n.x, to->normal[1][at + l] = n.y, to->normal[2][at + l] = n.z;
        to->du_s[0][at + l] = du.x - du_n * n.x;
        to->du_s[1][at + l] = du.y - du_n * n.y;
        to->du_s[2][at + l] = du.z - du_n * n.z;
        const tl_vec3 turned = tl_turn_into(f, get(turn->g, l), turn->scale[l], turn->turns[l], n);
        sx[l] = turned.x, sy[l] = turned.y, sz[l] = turned.z;
        slid2[l] = aside2 > slid2[l] ? aside2 : slid2[l];
    }
}

/* Follows a group: its points' lanes, and their shear. Notes which segments have slid. */
TL_VECTORIZED static void follow_group(struct tl_segments *s, size_t row, side_lanes *a, side_lanes *b, size_t at,
                                       lanes *to)
{
    turn_lanes turn;
    double slid2[TL_LANES];
    tl_lanes_clear(slid2);
    turn_normals(&s->table, row, a, b, &turn);
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
        follow_points(&s->points, TL_SEGMENT_POINTS * row + k * TL_LANES, a, b, &turn, at + k * TL_LANES, to, slid2);
    for (size_t l = 0; l < TL_LANES; l++)
        s->table.slid[row + l] = slid2[l] > SLID * SLID * s->table.area[row + l];
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
                                .dt = job->m->dt,
                                .area = p->area + first,
                                .closure = l->closure,
                                .f_n0 = p->f_n0 ? p->f_n0 + first : none,
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
                                .closure_apart = none};
    tl_report report;
    const tl_status status = tl_law_update(law, &batch, &report);
    const size_t bad = report.first_bad < count ? report.first_bad : 0;
    if (status != TL_OK)
        tl_failure_note(job->failure, first, status, first + bad, tl_report_text(&report, status));
    return status == TL_OK;
}

/* ---------------------------------------------------------------- pushing ---------------- */

/* What a group does to its sides: forces on the corners, on a rigid side likewise on the ends of its axes, with their
 * sizes. The force on B, and the sum of the sizes of its points' forces. */
typedef struct push_lanes {
    _Alignas(TL_ALIGN) double corner[2][3][4][TL_LANES]; /* by side, corner, component */
    double force[3][TL_LANES];
} push_lanes;

/* The force of a point on B. */
TL_INLINE tl_vec3 force_of(const tl_segment_points *p, const lanes *of, size_t point, size_t at)
{
    const double f = p->f_n[point];
    return (tl_vec3){p->f_s[0][point] + f * of->normal[0][at], p->f_s[1][point] + f * of->normal[1][at],
                     p->f_s[2][point] + f * of->normal[2][at]};
}

TL_INLINE double size_of(tl_vec3 v)
{
    return sqrt(dot_of(v, v));
}

/* The force on a corner of which three points have the weights w[0], w[TL_LANES] and w[2 TL_LANES], and its size. */
TL_INLINE void push_corner(double (*to)[TL_LANES], size_t l, const double *w, double sign, tl_vec3 f0, tl_vec3 f1,
                           tl_vec3 f2)
{
    const double w0 = sign * w[0], w1 = sign * w[TL_LANES], w2 = sign * w[2 * TL_LANES];
    const tl_vec3 f = {w0 * f0.x + w1 * f1.x + w2 * f2.x, w0 * f0.y + w1 * f1.y + w2 * f2.y,
                       w0 * f0.z + w1 * f1.z + w2 * f2.z};
    to[0][l] = f.x, to[1][l] = f.y, to[2][l] = f.z, to[3][l] = size_of(f);
}

/* Sums of the points of a group, and what it stores and turns into heat. */
TL_INLINE void sum_points(struct tl_segments *s, size_t row, size_t at, const lanes *of, push_lanes *restrict to)
{
    const tl_segment_points *p = &s->points;
    tl_segment_table *t = &s->table;
    const size_t first = TL_SEGMENT_POINTS * row;
    double *restrict stored = t->stored + row, *restrict heat = t->heat + row;
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        const size_t i = first + l, j = at + l;
        const tl_vec3 f0 = force_of(p, of, i, j), f1 = force_of(p, of, i + TL_LANES, j + TL_LANES);
        const tl_vec3 f2 = force_of(p, of, i + 2 * TL_LANES, j + 2 * TL_LANES);
        stored[l] = of->stored[j] + of->stored[j + TL_LANES] + of->stored[j + 2 * TL_LANES];
        heat[l] = of->dissipated[j] + of->dissipated[j + TL_LANES] + of->dissipated[j + 2 * TL_LANES];
        to->force[0][l] = f0.x + f1.x + f2.x;
        to->force[1][l] = f0.y + f1.y + f2.y;
        to->force[2][l] = f0.z + f1.z + f2.z;
        push_corner(to->corner[0][0], l, p->at_a[0] + i, -1, f0, f1, f2);
        push_corner(to->corner[0][1], l, p->at_a[1] + i, -1, f0, f1, f2);
        push_corner(to->corner[0][2], l, p->at_a[2] + i, -1, f0, f1, f2);
        push_corner(to->corner[1][0], l, p->at_b[0] + i, 1, f0, f1, f2);
        push_corner(to->corner[1][1], l, p->at_b[1] + i, 1, f0, f1, f2);
        push_corner(to->corner[1][2], l, p->at_b[2] + i, 1, f0, f1, f2);
    }
}

TL_VECTORIZED static void push_group(struct tl_segments *s, size_t row, size_t at, const lanes *of, push_lanes *by)
{
    sum_points(s, row, at, of, by);
    for (size_t l = 0; l < TL_LANES; l += 4) {
        tl_segment_push *to = s->table.push + row + l;
        for (int side = 0; side < 2; side++)
            for (int c = 0; c < 3; c++) {
                double(*corner)[TL_LANES] = by->corner[side][c];
                const double *const column[4] = {corner[0] + l, corner[1] + l, corner[2] + l, corner[3] + l};
                tl_lanes_turn(column, to[0].of[side][c], to[1].of[side][c], to[2].of[side][c], to[3].of[side][c]);
            }
    }
}

/* A rigid side gets the force, and the moment about its centroid of the forces on the ends of its axes. */
static void push_rigid(const tl_model *m, uint32_t body, tl_vec3 force, double (*to)[4])
{
    tl_vec3 moment = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        moment =
            tl_v3_add(moment, tl_v3_cross(axis_of(&m->bodies.pose[body].r, k), tl_v3(to[k][0], to[k][1], to[k][2])));
    const tl_vec3 both[2] = {force, moment};
    for (int k = 0; k < 2; k++) {
        to[k][0] = both[k].x;
        to[k][1] = both[k].y;
        to[k][2] = both[k].z;
    }
}

/* `rigid`: the group may have rigid sides. */
static void push_sides(tl_model *m, size_t row, size_t at, bool rigid, const lanes *of)
{
    struct tl_segments *s = m->segments;
    push_lanes by;
    push_group(s, row, at, of, &by);
    for (size_t l = 0; l < TL_LANES && rigid; l++) {
        const tl_segment *one = &s->table.of[row + l];
        if (one->meet == TL_NO_ROW)
            continue;
        const tl_vec3 on_b = get(by.force, l);
        s->table.bears[row + l] = 0;
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
            s->table.bears[row + l] +=
                size_of(force_of(&s->points, of, tl_segment_point_row(row + l, k), at + l + k * TL_LANES));
        if (tl_side_is_rigid(&one->a))
            push_rigid(m, one->a.at[0], tl_v3_neg(on_b), s->table.push[row + l].of[0]);
        if (tl_side_is_rigid(&one->b))
            push_rigid(m, one->b.at[0], on_b, s->table.push[row + l].of[1]);
    }
}

static void act_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const act_job *job = user;
    tl_model *m = job->m;
    const size_t first = (job->span->group_begin + begin) * TL_LANES, groups = end - begin;
    bool rigid[TILE];
    side_lanes side[2];
    lanes l;
    for (size_t g = 0; g < groups; g++) {
        const size_t row = first + g * TL_LANES;
        rigid[g] = false;
        for (int k = 0; k < 2; k++)
            if (!find_sides(m->segments, row, k, &side[k])) {
                put_rigid_sides(m, row, k, &side[k]);
                rigid[g] = true;
            }
        follow_group(m->segments, row, &side[0], &side[1], g * GROUP_POINTS, &l);
    }
    if (!call_law(job, TL_SEGMENT_POINTS * first, groups * GROUP_POINTS, &l))
        return;
    for (size_t g = 0; g < groups; g++)
        push_sides(m, first + g * TL_LANES, g * GROUP_POINTS, rigid[g], &l);
}

static void touch_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    tl_gridpoint_now *now = tl_gridpoints_aligned(m->segments->now) + TL_SEGMENT_DUMMIES;
    for (size_t k = begin; k < end; k++)
        tl_gridpoint_put(&now[k], &m->zones->points, m->segments->touched[k], m->dt);
}

/* Where gridpoints are that segments touch. */
static void find_touched(tl_model *m)
{
    tl_gridpoint_now *now = tl_gridpoints_aligned(m->segments->now);
    for (int k = 0; k < TL_SEGMENT_DUMMIES; k++)
        now[k] = (tl_gridpoint_now){{k == 1, k == 2, 0}, {0}};
    tl_parallel_for(m->pool, m->segments->touched_count, CHUNK, touch_range, m);
}

tl_status tl_segments_prepare(tl_model *m)
{
    struct tl_segments *s = m->segments;
    const size_t need = s ? s->touched_count + TL_SEGMENT_DUMMIES + 1 : 0;
    return !s || tl_fit(&s->now, &s->now_capacity, need, sizeof *s->now) ? TL_OK : tl_fail_memory(&m->error);
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
    return failure->error.status;
}

/* ---------------------------------------------------------------- who gets what ---------- */

void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t k = s->body_start[body]; k < s->body_start[body + 1]; k++) {
        const tl_segment_use *use = &s->body_use[k];
        double(*push)[4] = s->table.push[use->segment].of[use->side];
        on->force = tl_v3_add(on->force, tl_v3(push[0][0], push[0][1], push[0][2]));
        on->moment = tl_v3_add(on->moment, tl_v3(push[1][0], push[1][1], push[1][2]));
        on->magnitude += s->table.bears[use->segment];
    }
}

/* Twice k w of each point, for each corner: w its weight there. */
void tl_segments_stiffen(tl_model *m)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t row = 0; s && row < s->table.table.rows; row++) {
        const tl_segment *of = &s->table.of[row];
        if (of->meet == TL_NO_ROW || s->meet[of->meet].law == TL_NO_ROW)
            continue;
        const double k = tl_law_stiffness(&m->joint_laws[s->meet[of->meet].law]);
        for (size_t i = 0; i < TL_SEGMENT_POINTS; i++) {
            const size_t point = tl_segment_point_row(row, i);
            for (int side = 0; side < 2; side++) {
                const tl_segment_side *to = side ? &of->b : &of->a;
                for (int c = 0; c < 3 && !tl_side_is_rigid(to); c++)
                    m->zones->points.holds[to->at[c]] +=
                        2 * k * s->points.area[point] * fabs((side ? s->points.at_b : s->points.at_a)[c][point]);
            }
        }
    }
}

void tl_segments_hold(const tl_model *m, uint32_t body, tl_holding *sum)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t k = s->body_start[body]; k < s->body_start[body + 1]; k++) {
        const tl_segment *of = &s->table.of[s->body_use[k].segment];
        const uint32_t law = s->meet[of->meet].law;
        if (law == TL_NO_ROW)
            continue;
        const double stiff = tl_law_stiffness(&m->joint_laws[law]);
        sum->law = fmax(sum->law, stiff);
        sum->presses = true;
        for (size_t i = 0; i < TL_SEGMENT_POINTS; i++) {
            const uint32_t row = s->body_use[k].segment;
            const size_t point = tl_segment_point_row(row, i);
            double *const *at = s->body_use[k].side ? s->points.at_b : s->points.at_a;
            sum->stiffness.sum += stiff * s->points.area[point];
            sum->stiffness.r2 += stiff * s->points.area[point] * tl_v3_norm2(tl_columns_get(at, point));
        }
    }
}

tl_energies tl_segments_energies(tl_model *m)
{
    struct tl_segments *s = m->segments;
    tl_energies sum = {0, s ? s->lost : 0};
    for (size_t row = 0; s && row < s->table.table.rows; row++)
        if (s->table.of[row].meet != TL_NO_ROW) {
            sum.stored += s->table.stored[row];
            sum.heat += s->table.heat[row];
        }
    if (s)
        s->lost = 0;
    return sum;
}
