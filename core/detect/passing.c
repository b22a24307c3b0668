/* passing.c - blocks that a step would carry into each other too far.
 *
 * Contacts are looked for at the end of a step only. So a block that travels far in one step may end on the far side of
 * another. Or it ends so deep in it that the nearest way out is not the one it came. Where a step may do that is told
 * before the step:
 *
 *   1. A body that travels by less than half of what the thinnest block allows is none of those that pass.
 *   2. The bounds of blocks are swept from where they are to where the step takes them, and sorted along x. Pairs
 *      whose swept bounds meet are looked at: the others cannot touch in this step.
 *   3. A pair may close along a face that parts it now, or along which it overlaps the least. Along the normal of any
 *      other face its overlap is large already. The gap along a fixed normal is a concave function of time, as no
 *      corner moves on a curve. So the straight line between the gaps before and after the step is below it.
 *
 * Two blocks that are both held may overlap as they like, and blocks of one body do not move against each other. Turns
 * are taken as small. All is serial and in the order of rows, and nothing is done while all blocks are slow. */
#include "detect/passing.h"

#include "contact/pair_view.h"
#include "geometry/measure.h"

#include <stdlib.h>

typedef struct sweep {
    const tl_model *m;
    const tl_step_motion *motion;
    double share;
    tl_swept *list;
    size_t count;
} sweep;

double tl_least_thickness(const tl_model *m, uint32_t row)
{
    const tl_blocks *b = &m->blocks;
    return 2 * b->volume[row] / (b->mean_face[row] * b->shape[row]->face_count);
}

/* ---------------------------------------------------------------- swept bounds ----------- */

static void include(tl_bounds *box, tl_vec3 x)
{
    box->min = tl_v3_min(box->min, x);
    box->max = tl_v3_max(box->max, x);
}

static tl_swept sweep_block(const sweep *s, uint32_t row, bool moves)
{
    const tl_poly *shape = s->m->blocks.shape[row];
    uint32_t body = s->m->blocks.body[row];
    const tl_mat3 *r = &s->m->bodies.pose[body].r;
    const tl_step_motion *by = &s->motion[body];
    tl_vec3 place = tl_body_place(&s->m->bodies, body);
    tl_bounds box = {place, place};
    for (uint32_t i = 0; i < shape->vertex_count; i++) {
        tl_vec3 arm = tl_m3_mul(r, shape->vertex[i]), x = tl_v3_add(place, arm);
        if (i == 0)
            box.min = box.max = x;
        include(&box, x);
        include(&box, tl_v3_add(x, tl_v3_add(by->shift, tl_v3_cross(by->turn, arm))));
    }
    return (tl_swept){box, row, moves};
}

static int compare_swept(const void *a, const void *b)
{
    const tl_swept *x = a, *y = b;
    int along = (x->box.min.x > y->box.min.x) - (x->box.min.x < y->box.min.x);
    return along ? along : (x->row > y->row) - (x->row < y->row);
}

/* Lists the blocks that move far, and then those that they may meet. */
static void list_swept(sweep *s, double far)
{
    const tl_model *m = s->m;
    tl_bounds all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        if (!(tl_step_travel(m, s->motion, m->blocks.body[row]) > far))
            continue;
        tl_swept swept = s->list[s->count++] = sweep_block(s, row, true);
        include(&all, swept.box.min);
        include(&all, swept.box.max);
    }
    for (uint32_t row = 0; s->count > 0 && row < m->blocks.table.rows; row++) {
        uint32_t body = m->blocks.body[row];
        if (tl_step_travel(m, s->motion, body) > far)
            continue;
        double reach = m->bodies.radius[body] + far;
        tl_vec3 grow = {reach, reach, reach}, place = tl_body_place(&m->bodies, body);
        tl_bounds ball = {tl_v3_sub(place, grow), tl_v3_add(place, grow)};
        if (tl_bounds_meet(&ball, &all))
            s->list[s->count++] = sweep_block(s, row, false);
    }
    if (s->count > 0)
        qsort(s->list, s->count, sizeof *s->list, compare_swept);
}

/* ---------------------------------------------------------------- one pair --------------- */

/* A block of a pair in the frame of A's body: its corners and faces, and how the step moves it there. */
typedef struct side {
    const tl_poly *shape;
    tl_mat3 turn; /* from the block's frame to A's body's */
    tl_vec3 centre;
    tl_step_motion by;
} side;

/* How the step moves a body, in the frame of another one. */
static tl_step_motion motion_in(const sweep *s, uint32_t frame, uint32_t body)
{
    const tl_mat3 *r = &s->m->bodies.pose[frame].r;
    const tl_step_motion *by = &s->motion[body];
    return (tl_step_motion){tl_m3_tmul(r, by->shift), tl_m3_tmul(r, by->turn)};
}

/* Farthest reach of a block along a direction, before the step and after it. */
typedef struct reach {
    double before, after;
} reach;

static reach reach_along(const side *s, tl_vec3 n)
{
    reach out = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < s->shape->vertex_count; i++) {
        tl_vec3 arm = tl_m3_mul(&s->turn, s->shape->vertex[i]);
        tl_vec3 moved = tl_v3_add(s->by.shift, tl_v3_cross(s->by.turn, arm));
        double x = tl_v3_dot(n, tl_v3_add(s->centre, arm));
        out.before = fmax(out.before, x);
        out.after = fmax(out.after, x + tl_v3_dot(n, moved));
    }
    return out;
}

/* Gap of a pair along the outward normal of a face, before the step and after it. B's faces come after those of A. */
static reach gap_along(const side *a, const side *b, uint32_t face)
{
    const bool of_b = face >= a->shape->face_count;
    const side *owner = of_b ? b : a, *other = of_b ? a : b;
    face -= of_b ? a->shape->face_count : 0;
    tl_vec3 n = tl_m3_mul(&owner->turn, owner->shape->plane[face].normal);
    reach own = reach_along(owner, n), its = reach_along(other, tl_v3_neg(n));
    return (reach){-its.before - own.before, -its.after - own.after};
}

/* The part of the step after which a pair has closed by what is allowed: INFINITY when it does not in this step. */
static double part_of_step(const side *a, const side *b, double allowed, double *deeper)
{
    const uint32_t faces = a->shape->face_count + b->shape->face_count;
    double widest = -INFINITY, part = 0;
    for (uint32_t f = 0; f < faces; f++)
        widest = fmax(widest, gap_along(a, b, f).before);
    double deepest = fmax(-widest, 0) + allowed; /* that the overlap may become */
    for (uint32_t f = 0; f < faces; f++) {
        reach gap = gap_along(a, b, f);
        if (gap.before < -deepest)
            continue;
        if (gap.after >= -deepest)
            return INFINITY;
        double along = (gap.before + deepest) / (gap.before - gap.after);
        if (along > part) {
            part = along;
            *deeper = -gap.after - fmax(-widest, 0);
        }
    }
    return part;
}

static bool may_pass(const sweep *s, const tl_swept *a, const tl_swept *b)
{
    const tl_model *m = s->m;
    uint32_t body_a = m->blocks.body[a->row], body_b = m->blocks.body[b->row];
    return body_a != body_b && (a->moves || b->moves) && tl_bounds_meet(&a->box, &b->box) &&
           !tl_blocks_fixed(m, a->row, b->row) &&
           tl_step_travel(m, s->motion, body_a) + tl_step_travel(m, s->motion, body_b) >
               s->share * fmin(tl_least_thickness(m, a->row), tl_least_thickness(m, b->row));
}

/* Notes a pair that passes earlier in the step than any before. */
static void look_at(const sweep *s, uint32_t a, uint32_t b, tl_passing *out)
{
    const tl_model *m = s->m;
    const tl_pair_view view = tl_pair_view_of(m, a, b);
    uint32_t body_a = m->blocks.body[a], body_b = m->blocks.body[b];
    const tl_vec3 zero = {0, 0, 0};
    side side_a = {view.a, tl_m3_identity(), zero, motion_in(s, body_a, body_a)};
    side side_b = {view.b, view.turn, view.shift, motion_in(s, body_a, body_b)};
    double thickness = fmin(tl_poly_thickness(view.a), tl_poly_thickness(view.b)), deeper = 0;
    double part = part_of_step(&side_a, &side_b, s->share * thickness, &deeper);
    bool lower = a < out->a || (a == out->a && b < out->b);
    if (part < out->part || (part == out->part && isfinite(part) && lower))
        *out = (tl_passing){part, a, b, deeper, s->share * thickness};
}

tl_passing tl_passing_find(const tl_model *m, const tl_step_motion *motion, double share, double thinnest,
                           tl_swept *list)
{
    sweep s = {.m = m, .motion = motion, .share = share, .list = list};
    tl_passing out = {INFINITY, TL_NO_ROW, TL_NO_ROW, 0, 0};
    list_swept(&s, 0.5 * share * thinnest);
    for (size_t i = 0; i < s.count; i++)
        for (size_t j = i + 1; j < s.count && s.list[j].box.min.x <= s.list[i].box.max.x; j++)
            if (may_pass(&s, &s.list[i], &s.list[j])) {
                uint32_t a = s.list[i].row, b = s.list[j].row;
                look_at(&s, a < b ? a : b, a < b ? b : a, &out);
            }
    return out;
}
