/* act.c - segments follow their sides, and push them apart by the laws of their joints.
 *
 * Let s be the share of the outline that is B's (overlay.h), and p = s n_A - (1 - s) n_B. Then the common normal is
 * n = p / |p|, and the gap n . e, e = x_B - x_A. So a point on the side with the outline presses along the normal of
 * the other side, by its distance from that: the gradient of the energy, however far the sides tilt.
 *
 * Forces act at the place x_A + s e. The motion is that of both sides there. Shear turns from the last normal to this
 * one, and by the spin of s A + (1 - s) B about it. A force f on B acts on the corners by the weights. The rest is
 * couples,
 *
 *     on A  -s e x f_s + f_n s n_A x t / |p|,    on B  -(1 - s) e x f_s - f_n (1 - s) n_B x t / |p|
 *
 * with t the part of e along the plane, for it turns with the normals. Couples act by the transpose of the turn. So
 * work, forces, moments and energy agree whatever the triangles do. */
#include "segment/act.h"

#include "base/columns.h"
#include "base/inside.h"
#include "base/parallel.h"
#include "base/series.h"
#include "contact/contacts.h"
#include "contact/plane_turn.h"
#include "force/joint_laws.h"
#include "segment/blend.h"
#include "segment/closed.h"
#include "segment/lay.h"
#include "segment/side.h"

#include <math.h>
#include <string.h>

/* SIMD groups that a law gets at a time. */
#define TILE 4
/* Points of a group, and of a tile. */
#define GROUP_POINTS (TL_SEGMENT_POINTS * TL_LANES)
#define TILE_POINTS (TILE * GROUP_POINTS)
/* Tolerance: slide or stretch of a segment over its size, from which on it is laid anew. */
#define SLID 1e-3

/* Tolerance: how far corners of a segment may be beyond its points, over the largest difference of these: of a triangle
 * 1, of slivers cut off of one somewhat more. */
#define CORNERS_BEYOND 4.0

/* What is known of a tile's points only in a step. */
typedef struct lanes {
    _Alignas(TL_ALIGN) double closure[TILE_POINTS];
    double du_n[TILE_POINTS], normal[3][TILE_POINTS], du_s[3][TILE_POINTS];
    double stored[TILE_POINTS], dissipated[TILE_POINTS], zero[TILE_POINTS];
    double apart[3][TILE_POINTS];                          /* e */
    tl_side_now side[TILE * TL_LANES][2];                  /* of the segments */
    double share[TILE * TL_LANES], per_p[TILE * TL_LANES]; /* s, and 1 / |p| */
    bool partly[TILE * TL_LANES];                          /* a part of it is closed, and a part is apart: */
    tl_closed closed[TILE * TL_LANES];
} lanes;

/* ---------------------------------------------------------------- following -------------- */

static void put(double (*to)[TILE_POINTS], size_t at, tl_vec3 v)
{
    to[0][at] = v.x;
    to[1][at] = v.y;
    to[2][at] = v.z;
}

/* The lane of the first point of a segment of a tile. */
static size_t lane_of(size_t number)
{
    return number / TL_LANES * GROUP_POINTS + number % TL_LANES;
}

/* Follows a segment, by its number in the tile: its points' lanes, and their shear. Notes when it has slid. */
static void follow(tl_model *m, uint32_t row, size_t number, lanes *l)
{
    const size_t lane = lane_of(number);
    struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    tl_segment_points *p = &s->points;
    tl_side_now *sides = l->side[number], *a = &sides[0], *b = &sides[1];
    *a = tl_side_now_of(m, &of->a, of->normal_a);
    *b = tl_side_now_of(m, &of->b, of->normal_b);
    const double share = s->meet[of->meet].share;
    const tl_vec3 mixed = tl_v3_madd(tl_v3_scale(share, a->normal), share - 1, b->normal);
    l->share[number] = share;
    l->per_p[number] = 1 / tl_v3_norm(mixed);
    const tl_vec3 n = tl_v3_scale(l->per_p[number], mixed), last = tl_columns_get(s->table.normal, row);
    const tl_vec3 half = tl_v3_scale(0.5, tl_v3_madd(tl_v3_scale(share, a->turn), 1 - share, b->turn));
    double slid2 = 0;
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t at = lane + k * TL_LANES;
        const size_t point = tl_segment_point_row(row, k);
        const tl_vec3 at_a = tl_columns_get(p->at_a, point), at_b = tl_columns_get(p->at_b, point);
        const tl_vec3 on_a = tl_side_now_place(m, a, at_a), apart = tl_v3_sub(tl_side_now_place(m, b, at_b), on_a);
        const tl_vec3 off_a = tl_v3_scale(share, apart), off_b = tl_v3_scale(share - 1, apart);
        const tl_vec3 place = tl_v3_add(on_a, off_a);
        const tl_vec3 du =
            tl_v3_sub(tl_side_now_motion(m, b, at_b, off_b, place), tl_side_now_motion(m, a, at_a, off_a, place));
        const double gap = tl_v3_dot(apart, n), du_n = tl_v3_dot(du, n);
        l->closure[at] = -gap - (p->reference ? p->reference[point] : 0);
        l->du_n[at] = du_n;
        const tl_vec3 du_s = tl_v3_madd(du, -du_n, n);
        put(l->normal, at, n);
        put(l->du_s, at, du_s);
        put(l->apart, at, apart);
        tl_columns_put(p->f_s, point, tl_turn_one(tl_columns_get(p->f_s, point), last, n, half));
        slid2 = fmax(slid2, tl_v3_norm2(tl_v3_madd(apart, -gap, n)));
    }
    tl_columns_put(s->table.normal, row, n);
    s->table.slid[row] = slid2 > SLID * SLID * s->table.area[row];
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
                                .f_n0 = p->f_n0 ? p->f_n0 + first : l->zero,
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
                                .closure_apart = l->zero};
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

/* Whether the closure of some point is below 0, or may be at a corner. */
static bool may_be_apart(const lanes *l, size_t lane)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        low = fmin(low, l->closure[lane + k * TL_LANES]);
        high = fmax(high, l->closure[lane + k * TL_LANES]);
    }
    return low - CORNERS_BEYOND * (high - low) < 0;
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
        if (s->table.of[row].meet == TL_NO_ROW || !may_be_apart(l, lane) || !pulls_not(law, &s->points, row))
            continue;
        if (!known)
            find_lifts(job, TL_SEGMENT_POINTS * first, TL_SEGMENT_POINTS * count, l, lift);
        known = true;
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
            u[k] = l->closure[lane + k * TL_LANES] + lift[lane + k * TL_LANES];
        l->partly[i] = tl_closed_part(s->outline + s->table.outline[row], s->table.corners[row], u, &l->closed[i]);
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

/* ---------------------------------------------------------------- forces ----------------- */

/* What a segment does to its sides. */
static void push(tl_model *m, uint32_t row, size_t number, const lanes *l)
{
    struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    const tl_segment_points *p = &s->points;
    const tl_side_now *a = &l->side[number][0], *b = &l->side[number][1];
    const double share = l->share[number];
    const size_t lane = lane_of(number);
    const double stiffness = stiffness_of(p, row, l, number);
    double sums[2][9] = {{0}}, bears = 0;
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t at = lane + k * TL_LANES;
        const size_t point = tl_segment_point_row(row, k);
        const tl_vec3 n = tl_v3(l->normal[0][at], l->normal[1][at], l->normal[2][at]);
        const double more = stiffness > 0 ? stiffness * p->area[point] * l->closed[number].rest[k] : 0;
        const double normal = p->f_n[point] + more;
        const tl_vec3 shear = tl_columns_get(p->f_s, point), on_b = tl_v3_madd(shear, normal, n);
        const tl_vec3 apart = {l->apart[0][at], l->apart[1][at], l->apart[2][at]};
        const tl_vec3 along = tl_v3_madd(apart, -tl_v3_dot(apart, n), n), couple = tl_v3_cross(apart, shear);
        const double tilts = normal * l->per_p[number];
        bears += tl_v3_norm(on_b);
        tl_side_push(m, &of->a, tl_columns_get(p->at_a, point), tl_v3_neg(on_b), sums[0]);
        tl_side_push(m, &of->b, tl_columns_get(p->at_b, point), on_b, sums[1]);
        const tl_vec3 on_normal_a = tl_v3_cross(a->normal, along), on_normal_b = tl_v3_cross(b->normal, along);
        tl_side_turn(a, tl_v3_madd(tl_v3_scale(-share, couple), tilts * share, on_normal_a), sums[0]);
        tl_side_turn(b, tl_v3_scale(share - 1, tl_v3_madd(couple, tilts, on_normal_b)), sums[1]);
    }
    for (int side = 0; side < 2; side++)
        for (int c = 0; c < 9; c++)
            s->table.push[side][c][row] = sums[side][c];
    s->table.bears[row] = bears;
}

static void act_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const act_job *job = user;
    tl_model *m = job->m;
    struct tl_segments *s = m->segments;
    lanes l;
    const size_t first = (job->span->group_begin + begin) * TL_LANES, count = (end - begin) * TL_LANES;
    memset(&l, 0, sizeof l);
    for (size_t k = 0; k < count; k++)
        if (s->table.of[first + k].meet != TL_NO_ROW)
            follow(m, (uint32_t)(first + k), k, &l);
    close_parts(job, first, count, &l);
    if (!call_law(job, TL_SEGMENT_POINTS * first, TL_SEGMENT_POINTS * count, &l))
        return;
    for (size_t k = 0; k < count; k++) {
        const size_t lane = lane_of(k);
        if (s->table.of[first + k].meet == TL_NO_ROW)
            continue;
        push(m, (uint32_t)(first + k), k, &l);
        const double stiffness = stiffness_of(&s->points, (uint32_t)(first + k), &l, k);
        s->table.stored[first + k] = 0.5 * stiffness * s->table.area[first + k] * l.closed[k].second;
        s->table.heat[first + k] = 0;
        for (size_t i = 0; i < TL_SEGMENT_POINTS; i++) {
            s->table.stored[first + k] += l.stored[lane + i * TL_LANES];
            s->table.heat[first + k] += l.dissipated[lane + i * TL_LANES];
        }
    }
}

tl_status tl_segments_apply(tl_model *m, tl_failure *failure)
{
    struct tl_segments *s = m->segments;
    for (size_t k = 0; s && k < s->span_count && failure->error.status == TL_OK; k++) {
        act_job job = {m, failure, &s->span[k]};
        if (job.span->law != TL_NO_ROW)
            tl_parallel_for(m->pool, job.span->group_end - job.span->group_begin, TILE, act_range, &job);
    }
    if (s && failure->error.status == TL_OK)
        tl_blends_apply(m);
    return failure->error.status;
}

/* ---------------------------------------------------------------- initial stress --------- */

void tl_segment_preload(tl_model *m, uint32_t row, tl_sym3 (*stress)(const void *user, tl_vec3 place), const void *user)
{
    struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    tl_segment_points *p = &s->points;
    const double share = s->meet[of->meet].share;
    const tl_side_now a = tl_side_now_of(m, &of->a, of->normal_a), b = tl_side_now_of(m, &of->b, of->normal_b);
    const tl_vec3 mixed = tl_v3_madd(tl_v3_scale(share, a.normal), share - 1, b.normal);
    const tl_vec3 n = tl_v3_scale(1 / tl_v3_norm(mixed), mixed); /* as the step finds it, to the bit */
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t point = tl_segment_point_row(row, k);
        const tl_vec3 on_a = tl_side_now_place(m, &a, tl_columns_get(p->at_a, point));
        const tl_vec3 apart = tl_v3_sub(tl_side_now_place(m, &b, tl_columns_get(p->at_b, point)), on_a);
        const tl_vec3 traction = tl_s3_mul(stress(user, tl_v3_madd(on_a, share, apart)), n);
        const double normal = tl_v3_dot(n, traction);
        p->reference[point] = -tl_v3_dot(apart, n);
        p->f_n0[point] = p->f_n[point] = -normal * p->area[point];
        tl_columns_put(p->f_s, point, tl_v3_scale(-p->area[point], tl_v3_madd(traction, -normal, n)));
        p->flags[point] = 0;
    }
    tl_columns_put(s->table.normal, row, n);
}

/* ---------------------------------------------------------------- who gets what ---------- */

void tl_segments_gather(const tl_model *m, uint32_t gridpoint, tl_vec3 *force, double *bears)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t k = s->use_start[gridpoint]; k < s->use_start[gridpoint + 1]; k++) {
        const tl_segment_use *use = &s->use[k];
        double *const *push = &s->table.push[use->side][3 * use->corner];
        const tl_vec3 f = tl_v3(push[0][use->segment], push[1][use->segment], push[2][use->segment]);
        *force = tl_v3_add(*force, f);
        *bears += tl_v3_norm(f);
    }
}

void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t k = s->body_start[body]; k < s->body_start[body + 1]; k++) {
        const tl_segment_use *use = &s->body_use[k];
        double *const *push = s->table.push[use->side];
        const uint32_t row = use->segment;
        on->force = tl_v3_add(on->force, tl_v3(push[0][row], push[1][row], push[2][row]));
        on->moment = tl_v3_add(on->moment, tl_v3(push[3][row], push[4][row], push[5][row]));
        on->magnitude += s->table.bears[row];
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
