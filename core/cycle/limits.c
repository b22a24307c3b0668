/* limits.c - how far a body may move in one step: the last look before anything moves.
 *
 * A step that would take a body farther than TL_TRAVEL times its diameter, or nowhere that is a number, has no meaning:
 * the body would turn by several radians at a time, and lose the digits of its place. Such a step fails before the
 * move, so places and velocities of a model are finite numbers always. The bound is on (|v| + |w| r) dt, v and w the
 * velocities that the kick would give (motion.c), r the farthest vertex.
 *
 * All bodies are looked at in every step: a test without roots sorts out those that are far from the limit. What it
 * finds is kept as a bound on all speeds, which tells whether blocks may pass each other. */
#include "cycle/limits.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "base/parallel.h"
#include "contact/body_contacts.h"
#include "contact/contacts.h"
#include "contact/pair_view.h"
#include "cycle/loose.h"
#include "cycle/settle.h"
#include "cycle/turn.h"
#include "cycle/undo.h"
#include "geometry/measure.h"
#include "model/body_shape.h"
#include "model/loads.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- velocities ------------- */

/* The times of a step, s: of the drift, and of the kick before it. */
typedef struct step_span {
    double dt, span;
} step_span;

typedef struct velocities {
    tl_vec3 v, w;
} velocities;

/* Forces on a body with those of the damping, and the inertia they meet. */
typedef struct push {
    tl_vec3 force, moment;
    double mass, alpha, scale, turn_scale;
} push;

TL_INLINE push push_of(const tl_model *m, uint32_t body)
{
    const struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    push p = {b->force[body], b->moment[body], b->mass[body], 0, 1, 1};
    if (tl_inertia_scaled(c)) {
        p.scale = tl_step_scale(m, body);
        p.turn_scale = tl_turn_scale(c, body);
    }
    if (tl_loads_lag(m)) {
        tl_wrench lag = tl_load_lag(m, body);
        p.force = tl_v3_sub(p.force, lag.force);
        p.moment = tl_v3_sub(p.moment, lag.moment);
    }
    if (tl_is_damped(m)) {
        p.force = tl_v3_add(p.force, tl_columns_get(c->damping_force, body));
        p.moment = tl_v3_add(p.moment, tl_columns_get(c->damping_moment, body));
        p.alpha = c->alpha[body];
    }
    return p;
}

/* Velocities after the kick, as the move makes them; with a span of 0 those of the body, or of its drive. */
static velocities kicked(const tl_model *m, uint32_t body, const step_span *k)
{
    const tl_bodies *b = &m->bodies;
    velocities out = {b->v[body], b->w[body]};
    if (b->fixed[body] == TL_FIX_ALL) {
        const tl_drive_record *drive = b->drive[body] ? &m->drives[b->drive[body] - 1] : NULL;
        return drive ? (velocities){drive->velocity, drive->angular_velocity} : out;
    }
    if (!(k->span > 0))
        return out;
    push p = push_of(m, body);
    tl_vec3 v = tl_kick(out.v, p.force, k->span / (p.mass * p.scale), p.alpha, k->span);
    out.v = tl_v3_add(tl_v3_sub(out.v, tl_free_part(out.v, b->fixed[body])), tl_free_part(v, b->fixed[body]));
    if (b->fixed[body] & TL_FIX_ROTATION)
        return out;
    tl_quat axes = tl_q_mul(b->q[body], b->axes[body]);
    tl_vec3 turn = tl_q_rotate(tl_q_conj(axes), p.moment), i = tl_moments_of(m, body);
    turn = tl_q_rotate(axes, tl_v3(turn.x / i.x, turn.y / i.y, turn.z / i.z));
    out.w = tl_kick(out.w, turn, k->span / p.turn_scale, p.alpha, k->span);
    return out;
}

/* ---------------------------------------------------------------- passing -----------------
 *
 * Contacts are looked for at the end of a step only. So a block that travels far in one step may end on the far side of
 * another. Or it ends so deep in it that the nearest way out is not the one it came. Where a step may do that is told
 * before the step:
 *
 *   1. A body that travels by less than half of what the thinnest block allows is none of those that pass.
 *   2. The bounds of thin blocks, and of those that come near them, are swept from where they are to where the step
 *      takes them, and sorted along x. Pairs whose swept bounds meet are looked at: the others cannot touch in this
 *      step.
 *   3. A pair may close along a face that parts it now, or along which it overlaps the least. Along the normal of any
 *      other face its overlap is large already. The gap along a fixed normal is a concave function of time, as no
 *      corner moves on a curve. So the straight line between the gaps before and after the step is below it.
 *
 * Two blocks that are both held may overlap as they like, and blocks of one body do not move against each other. Turns
 * are taken as small. All is serial and in the order of rows, and nothing is done while all blocks are slow. */

/* How far a corner of a body moves in the step, at the most, m. */
static double step_travel(const tl_model *m, const tl_step_motion *motion, uint32_t body)
{
    return tl_v3_norm(motion[body].shift) + tl_v3_norm(motion[body].turn) * m->bodies.radius[body];
}

/* The pair of blocks that a step carries into each other by most of what is allowed. */
typedef struct passing {
    double part;    /* of the step, at which they overlap by what is allowed; INFINITY: none do */
    uint32_t a, b;  /* rows of the blocks, a < b */
    double deeper;  /* by how much they overlap more after the whole step, m */
    double allowed; /* by how much they may, m */
} passing;

typedef struct sweep {
    const tl_model *m;
    const tl_step_motion *motion;
    double share;
    tl_swept *list;
    size_t count;
    double farthest; /* that a block goes in the step, m */
    double longest;  /* box of the list along x, m */
} sweep;

static void include(tl_bounds *box, tl_vec3 x)
{
    box->min = tl_v3_min(box->min, x);
    box->max = tl_v3_max(box->max, x);
}

static tl_swept sweep_block(const sweep *s, uint32_t row, bool thin, double far)
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
    return (tl_swept){box, row, step_travel(s->m, s->motion, body) > far, thin};
}

static int compare_swept(const void *a, const void *b)
{
    const tl_swept *x = a, *y = b;
    int along = (x->box.min.x > y->box.min.x) - (x->box.min.x < y->box.min.x);
    return along ? along : (x->row > y->row) - (x->row < y->row);
}

/* Whether a block is so thin that it, or what meets it, may be carried past the other. */
static bool is_thin(const sweep *s, uint32_t row)
{
    const double far = step_travel(s->m, s->motion, s->m->blocks.body[row]) + s->farthest;
    return far > s->share * tl_least_thickness(s->m, row);
}

/* Lists the thin blocks, and then those that they may meet. `far`: what goes no farther is none that passes. */
static void list_swept(sweep *s, double far)
{
    const tl_model *m = s->m;
    tl_bounds all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        s->farthest = fmax(s->farthest, step_travel(m, s->motion, m->blocks.body[row]));
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        if (!is_thin(s, row))
            continue;
        tl_swept swept = s->list[s->count++] = sweep_block(s, row, true, far);
        include(&all, swept.box.min);
        include(&all, swept.box.max);
    }
    for (uint32_t row = 0; s->count > 0 && row < m->blocks.table.rows; row++) {
        if (is_thin(s, row))
            continue;
        uint32_t body = m->blocks.body[row];
        double reach = m->bodies.radius[body] + step_travel(m, s->motion, body);
        tl_vec3 grow = {reach, reach, reach}, place = tl_body_place(&m->bodies, body);
        tl_bounds ball = {tl_v3_sub(place, grow), tl_v3_add(place, grow)};
        if (tl_bounds_meet(&ball, &all))
            s->list[s->count++] = sweep_block(s, row, false, far);
    }
    for (size_t i = 0; i < s->count; i++)
        s->longest = fmax(s->longest, s->list[i].box.max.x - s->list[i].box.min.x);
    if (s->count > 0)
        qsort(s->list, s->count, sizeof *s->list, compare_swept);
}

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
           step_travel(m, s->motion, body_a) + step_travel(m, s->motion, body_b) >
               s->share * fmin(tl_least_thickness(m, a->row), tl_least_thickness(m, b->row));
}

/* Notes a pair that passes earlier in the step than any before. */
static void look_at(const sweep *s, uint32_t a, uint32_t b, passing *out)
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
        *out = (passing){part, a, b, deeper, s->share * thickness};
}

/* Looks at a pair of the list. */
static void try_pair(const sweep *s, size_t i, size_t j, passing *out)
{
    const uint32_t a = s->list[i].row, b = s->list[j].row;
    if (may_pass(s, &s->list[i], &s->list[j]))
        look_at(s, a < b ? a : b, a < b ? b : a, out);
}

/* Looks at the pairs of a thin block that begin behind it along x, and with others that begin before it. */
static void try_thin(const sweep *s, size_t i, passing *out)
{
    const double begins = s->list[i].box.min.x, ends = s->list[i].box.max.x;
    for (size_t j = i + 1; j < s->count && s->list[j].box.min.x <= ends; j++)
        try_pair(s, i, j, out);
    for (size_t j = i; j-- > 0 && begins - s->list[j].box.min.x <= s->longest;)
        if (!s->list[j].thin && s->list[j].box.max.x >= begins)
            try_pair(s, i, j, out);
}

/* Finds the pair whose overlap would first grow by more than `share` of the thinner block's thickness. `motion`: of
 * each body; `thinnest`: the least thickness of all blocks, m; `list`: a place for each block, overwritten. */
static passing find_passing(const tl_model *m, const tl_step_motion *motion, double share, double thinnest,
                            tl_swept *list)
{
    sweep s = {.m = m, .motion = motion, .share = share, .list = list};
    passing out = {INFINITY, TL_NO_ROW, TL_NO_ROW, 0, 0};
    list_swept(&s, 0.5 * share * thinnest);
    for (size_t i = 0; i < s.count; i++)
        if (s.list[i].thin)
            try_thin(&s, i, &out);
    return out;
}

/* ---------------------------------------------------------------- travel ------------------
 *
 * A step heeds what moves: v dt and w dt.
 *
 * Stiffness bounds the step of blocks in contact. Between contacts a block travels by v dt whatever that is. Two things
 * go wrong when it is far. The block passes another, or goes in so deep that no contact can tell which way it came
 * (see above). And after a turn by an angle t central differences of what turns with the block are wrong by a share of
 * t^2 / 6.
 *
 * A step that the program chooses is made as short as both ask, and no block is slowed down in empty space: only what a
 * block may meet in the step counts. A step that is given stays as it is. Either is tested once more when the forces
 * are known, with limits some twice as wide. A step that exceeds them fails before anything moves.
 *
 * Bodies are looked at only when the fastest may be too fast for the thinnest block, or after something was set by
 * hand. Blocks at rest pay one comparison a step. */

/* Limit: by how much the overlap of two blocks may grow in a step, over the thickness of the thinner one. The first is
 * aimed at, the second is the most. A contact that is born with half of the thickness still knows which way it came
 * (TL_DEEPEST_BORN of overlap.c is 0.9). Test: lua/test_travel. */
#define CLOSING_AIM 0.25
#define CLOSING_MOST 0.5
/* Limit: turn of a body in a step, rad: aimed at, and the most. t^2 / 6 is 0.2 % of 0.1 and 1 % of 0.25. Passing is
 * looked for with turns taken as small. */
#define TURN_AIM 0.1
#define TURN_MOST 0.25
/* Limit: least step that is chosen, over the stable one. A model that needs a shorter one moves out of all proportion,
 * and would hardly get on. */
#define SHORTEST 1e-3

/* Least thickness that a block of the model can have; found anew after an edit. */
static double thinnest_of(const tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (c->thinnest_version == 1 + m->structure)
        return c->thinnest;
    c->thinnest = INFINITY;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        c->thinnest = fmin(c->thinnest, tl_least_thickness(m, row));
    c->thinnest_version = 1 + m->structure;
    return c->thinnest;
}

/* Whether a step so long may carry some body too far: false is sure. Takes a constant time but after an edit. */
static bool travel_may_matter(const tl_model *m, double dt)
{
    const tl_speed_bounds *b = &m->cycle->speeds;
    /* two bodies meet with the sum of their speeds */
    double closing2 = 4 * 4 * b->speed2 * dt * dt, may = CLOSING_AIM * thinnest_of(m);
    bool slow = closing2 < may * may && 2 * b->turn2 * dt * dt < TURN_AIM * TURN_AIM;
    return !slow || tl_set_by_hand(m);
}

/* What the step does to each body, with a place for the bounds of each block; NULL: out of memory. The memory is kept
 * for the steps that follow: blocks that are fast in one step are so in the next. */
static tl_step_motion *motions_of(tl_model *m, const step_span *span)
{
    struct tl_cycle *c = m->cycle;
    size_t bodies = m->bodies.table.rows, blocks = m->blocks.table.rows;
    if (!tl_fit(&c->motion, &c->motion_capacity, bodies + 1, sizeof *c->motion) ||
        !tl_fit(&c->swept, &c->swept_capacity, blocks + 1, sizeof *c->swept))
        return NULL;
    for (uint32_t body = 0; body < bodies; body++) {
        velocities at = kicked(m, body, span);
        c->motion[body] = (tl_step_motion){tl_v3_scale(span->dt, at.v), tl_v3_scale(span->dt, at.w)};
    }
    return c->motion;
}

/* The body that turns the most, or TL_NO_ROW. */
static uint32_t widest_turn(const tl_model *m, const tl_step_motion *motion, double *turn)
{
    uint32_t row = TL_NO_ROW;
    *turn = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        double angle = tl_v3_norm(motion[body].turn);
        if (angle > *turn) {
            *turn = angle;
            row = body;
        }
    }
    return row;
}

/* Of two blocks the body that travels farther in the step. */
static uint32_t faster_of(const tl_model *m, const tl_step_motion *motion, uint32_t a, uint32_t b)
{
    uint32_t body_a = m->blocks.body[a], body_b = m->blocks.body[b];
    return step_travel(m, motion, body_b) > step_travel(m, motion, body_a) ? body_b : body_a;
}

tl_status tl_travel_shorten(tl_model *m, double *dt, uint32_t *body)
{
    *body = TL_NO_ROW;
    if (m->relaxing || !travel_may_matter(m, *dt)) /* what goes too far in a relaxation is held back: hold_back */
        return TL_OK;
    const double least = SHORTEST * *dt;
    tl_step_motion *motion = motions_of(m, &(step_span){*dt, 0});
    if (!motion)
        return tl_fail_memory(&m->error);
    double turn;
    uint32_t turns = widest_turn(m, motion, &turn);
    if (turn > TURN_AIM) {
        const double part = TURN_AIM / turn;
        for (uint32_t i = 0; i < m->bodies.table.rows; i++)
            motion[i] = (tl_step_motion){tl_v3_scale(part, motion[i].shift), tl_v3_scale(part, motion[i].turn)};
        *dt *= part;
        *body = turns;
    }
    const passing by = find_passing(m, motion, CLOSING_AIM, thinnest_of(m), m->cycle->swept);
    if (by.part < 1) {
        *dt *= by.part;
        *body = faster_of(m, motion, by.a, by.b);
    }
    *dt = fmax(*dt, least);
    return TL_OK;
}

/* What to do about a step that should be `longest` s at the most. */
static const char *way_out(const tl_model *m, double longest, char *text, size_t size)
{
    if (!isnan(tl_given_step(m)) || tl_adds_mass(m))
        tl_text_print(text, size, "give a dt of %.2g s or less, or leave dt out", longest);
    else if (!m->relaxing && m->timestep.fraction > 1)
        tl_text_print(text, size, "fraction = %g of timestep is not stable; give 1 or less", m->timestep.fraction);
    else
        snprintf(text, size, "is a velocity, a load or gravity out of proportion?");
    return text;
}

static tl_status report_turn(tl_model *m, uint32_t body, double turn, double dt)
{
    char text[120];
    return tl_fail(&m->error, TL_E_NUMERIC,
                   "cycle %lld: block %u, at %.3g rad/s, would turn by %.3g rad in this step of dt = %.3g s, more than "
                   "the %g rad up to which its motion is right to 1 %%: %s",
                   (long long)m->cycles + 1, m->bodies.id[body], turn / dt, turn, dt, TURN_MOST,
                   way_out(m, dt * TURN_AIM / turn, text, sizeof text));
}

static tl_status report_passing(tl_model *m, const tl_step_motion *motion, const passing *p, double dt)
{
    uint32_t fast = faster_of(m, motion, p->a, p->b);
    uint32_t mover = m->blocks.body[p->a] == fast ? p->a : p->b;
    uint32_t other = mover == p->a ? p->b : p->a;
    char text[120];
    return tl_fail(&m->error, TL_E_NUMERIC,
                   "cycle %lld: block %u, at %.3g m/s, would be carried %.3g m into or past block %u in this step of "
                   "dt = %.3g s, more than the %.3g m, half of the thinner one's thickness, up to which their contact "
                   "can tell which way they came: %s",
                   (long long)m->cycles + 1, m->blocks.id[mover], tl_v3_norm(motion[fast].shift) / dt, p->deeper,
                   m->blocks.id[other], dt, p->allowed,
                   way_out(m, dt * p->part * CLOSING_AIM / CLOSING_MOST, text, sizeof text));
}

/* Fails with a sentence when the step would carry or turn a block too far. `span`: of the step, after its forces. */
static tl_status travel_check(tl_model *m, const step_span *span)
{
    tl_step_motion *motion = motions_of(m, span);
    if (!motion)
        return tl_fail_memory(&m->error);
    double turn;
    uint32_t turns = widest_turn(m, motion, &turn);
    if (turn > TURN_MOST)
        return report_turn(m, turns, turn, span->dt);
    const passing by = find_passing(m, motion, CLOSING_MOST, thinnest_of(m), m->cycle->swept);
    return by.part < 1 ? report_passing(m, motion, &by, span->dt) : TL_OK;
}

/* ---------------------------------------------------------------- held back -------------- */

/* Cost only: pairs of blocks that are held back one by one. */
#define MOST_HELD_BACK 100
/* Tolerance: share of what is allowed that those may go which are held back: it is not exceeded by a rounding. */
#define HELD_BACK 0.999

/* Lets a body go a part of its way in this step. */
static void go_part(tl_model *m, uint32_t body, double part, double dt)
{
    tl_step_motion *by = &m->cycle->motion[body];
    if (m->bodies.fixed[body] == TL_FIX_ALL)
        return;
    *by = (tl_step_motion){tl_v3_scale(part, by->shift), tl_v3_scale(part, by->turn)};
    tl_settle_move(m, body, tl_v3_scale(1 / dt, by->shift), tl_v3_scale(1 / dt, by->turn), dt);
}

/* In a relaxation velocities mean nothing. So a block that would be carried too far goes as far as it may. The step of
 * the others is as long as it was. */
static tl_status hold_back(tl_model *m, const step_span *span)
{
    tl_step_motion *motion = motions_of(m, span);
    if (!motion)
        return tl_fail_memory(&m->error);
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const double turn = tl_v3_norm(motion[body].turn);
        if (turn > TURN_AIM)
            go_part(m, body, TURN_AIM / turn, span->dt);
    }
    for (int k = 0; k <= MOST_HELD_BACK; k++) {
        const passing by = find_passing(m, motion, CLOSING_AIM, thinnest_of(m), m->cycle->swept);
        const bool all = k == MOST_HELD_BACK;
        if (!(by.part < 1))
            break;
        for (uint32_t body = 0; body < m->bodies.table.rows; body++)
            if (all || body == m->blocks.body[by.a] || body == m->blocks.body[by.b])
                go_part(m, body, HELD_BACK * by.part, span->dt);
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- motion ------------------ */

/* Limit: most motion in a step over the body's diameter, 2 r. Blocks in contact move by 1e-2 of it at the most where
 * the step is stable. Ten leaves fragments in free fall a long step. It is a turn of 20 radians. */
#define TL_TRAVEL 10
/* Cost only: share of that from which a body is fast: a step that follows is kept, for it may have to be undone.
 * Blocks in contact come nowhere near it. None gets from there to the limit in one step unless something is set by
 * hand or the given step is far too long. Then the step is kept, too. */
#define TL_FAST 0.01

typedef struct limit_job {
    tl_model *m;
    step_span span;
    bool held;                              /* bodies whose motion is given, or those that forces move */
    atomic_bool fast;                       /* some body is */
    tl_speed_bounds bounds[TL_MAX_THREADS]; /* of the bodies that a thread has looked at */
} limit_job;

static void widen(tl_speed_bounds *bounds, tl_speed_bounds by)
{
    bounds->speed2 = tl_larger(bounds->speed2, by.speed2);
    bounds->turn2 = tl_larger(bounds->turn2, by.turn2);
}

/* Whether a body that can move is so far from the limit that a bound without roots tells: squares of sums are at most
 * twice the sums of squares. Where numbers leave their range it tells nothing. The bounds take these squares. */
static bool surely_slow(const tl_model *m, uint32_t body, const step_span *k, tl_speed_bounds *bounds)
{
    const tl_bodies *b = &m->bodies;
    push p = push_of(m, body);
    tl_vec3 i = b->moments[body];
    double least = i.x < i.y ? i.x : i.y, r = b->radius[body];
    least = i.z < least ? i.z : least;
    least = m->config.rotation == TL_ROTATION_PAPER ? b->round[body] : least;
    double per_mass = k->span / (p.mass * p.scale), per_moment = k->span / (least * p.turn_scale);
    double v2 = tl_v3_norm2(b->v[body]) + per_mass * per_mass * tl_v3_norm2(p.force);
    double w2 = tl_v3_norm2(b->w[body]) + per_moment * per_moment * tl_v3_norm2(p.moment);
    widen(bounds, (tl_speed_bounds){v2 + w2 * r * r, w2});
    double motion = k->dt, limit = TL_FAST * TL_TRAVEL * r; /* half of 2 r TL_TRAVEL */
    return (v2 + w2 * r * r) * (motion * motion) < limit * limit && p.alpha >= 0;
}

/* How far the farthest vertex may move in the step: no number when it cannot be told. */
static double travel_of(velocities at, double radius, double dt)
{
    return (tl_v3_norm(at.v) + tl_v3_norm(at.w) * radius) * dt;
}

static bool too_far(const tl_model *m, uint32_t body, double travel)
{
    return !(travel <= TL_TRAVEL * 2 * m->bodies.radius[body]);
}

/* How far a load alone may move the body in a step, whichever way it comes to point as the body turns. */
static double load_travel(const tl_model *m, uint32_t body, const step_span *k)
{
    const tl_bodies *b = &m->bodies;
    const tl_body_load *load = &b->load[body];
    double force = tl_v3_norm(load->force), arm = tl_v3_norm(load->arm), r = b->radius[body];
    tl_vec3 i = b->moments[body];
    double turn = (tl_v3_norm(load->moment) + arm * force) / fmin(i.x, fmin(i.y, i.z));
    return (force / b->mass[body] + turn * r) * k->span * k->dt;
}

static bool is_still(const tl_bodies *b, uint32_t body)
{
    return !b->drive[body] && tl_v3_norm2(b->v[body]) + tl_v3_norm2(b->w[body]) == 0;
}

static void check_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    limit_job *job = user;
    tl_model *m = job->m;
    tl_speed_bounds bounds = job->bounds[thread];
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        bool held = m->bodies.fixed[body] == TL_FIX_ALL;
        if (held != job->held)
            continue;
        if (!held && m->bodies.load && too_far(m, body, load_travel(m, body, &job->span) / TL_FAST))
            atomic_store(&job->fast, true);
        if (held ? is_still(&m->bodies, body) : surely_slow(m, body, &job->span, &bounds))
            continue;
        const velocities at = kicked(m, body, &job->span);
        const double r = m->bodies.radius[body], w2 = tl_v3_norm2(at.w);
        if (held) /* whole speeds, so that the bounds hold with much to spare */
            widen(&bounds, (tl_speed_bounds){tl_v3_norm2(at.v) + w2 * r * r, w2});
        double travel = travel_of(at, r, job->span.dt);
        if (too_far(m, body, travel / TL_FAST))
            atomic_store(&job->fast, true);
        if (too_far(m, body, travel)) {
            tl_failure_note(&m->cycle->failure, chunk, TL_E_NUMERIC, body, "");
            break;
        }
    }
    job->bounds[thread] = bounds;
}

/* The contact that presses on a body with the largest force, or TL_NO_ROW. One that is no number counts most. */
static uint32_t hardest_contact(const tl_model *m, uint32_t body, double *force)
{
    uint32_t found = TL_NO_ROW;
    *force = 0;
    for (tl_body_contacts at = tl_contacts_of_body(m, body); tl_next_contact(&at);) {
        double f = tl_v3_norm(m->detect->contacts.force[at.contact]);
        if (f <= *force)
            continue;
        *force = f;
        found = at.contact;
    }
    return found;
}

/* What a body moves by in a step, m: by its velocity, or at the most by what kicks it. The largest names the cause. */
typedef struct cause {
    double travel;
    char text[160];
} cause;

static void note_cause(cause *most, double travel, const char *what, double size, const char *unit)
{
    if (!(travel > most->travel) && !isnan(travel))
        return;
    most->travel = isnan(travel) ? INFINITY : travel;
    tl_text_print(most->text, sizeof most->text, "%s %.3g %s", what, size, unit);
}

/* The length of a vector whose squares may leave the range of numbers. */
static double length(tl_vec3 v)
{
    double most = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
    return most > 0 && isfinite(most) ? most * tl_v3_norm(tl_v3_scale(1 / most, v)) : most;
}

/* Of velocity, gravity, load, contacts and damping. */
static cause find_cause(const tl_model *m, uint32_t body, const step_span *k, double contact)
{
    const tl_bodies *b = &m->bodies;
    cause most = {-1, ""};
    const velocities own = kicked(m, body, &(step_span){k->dt, 0});
    const double r = b->radius[body], per_mass = k->span * k->dt / b->mass[body];
    const double v = length(own.v), w = length(own.w);
    note_cause(&most, v * k->dt, "its velocity is", v, "m/s");
    note_cause(&most, w * r * k->dt, "its angular velocity is", w, "rad/s");
    if (b->fixed[body] == TL_FIX_ALL)
        return most;
    double gravity = length(m->config.gravity);
    note_cause(&most, gravity * k->span * k->dt, "gravity is", gravity, "m/s2");
    if (tl_body_loaded(b, body)) {
        const tl_wrench load = tl_load_wrench(b, body);
        double force = length(load.force), moment = length(load.moment);
        bool turns = moment > force * r;
        note_cause(&most, load_travel(m, body, k), turns ? "the moment of its load is" : "its load is",
                   turns ? moment : force, turns ? "N m" : "N");
    }
    note_cause(&most, contact * per_mass, "a contact presses with", contact, "N");
    if (tl_is_damped(m)) {
        double drag = length(tl_columns_get(m->cycle->damping_force, body));
        note_cause(&most, drag * per_mass, "the damping gives it", drag, "N");
    }
    return most;
}

/* The sentence of a body that would move too far. */
static tl_status report(tl_model *m, uint32_t body, const step_span *k)
{
    const tl_bodies *b = &m->bodies;
    char by[400], far[120];
    double force, diameter = 2 * b->radius[body];
    double travel = travel_of(kicked(m, body, k), b->radius[body], k->dt);
    uint32_t contact = hardest_contact(m, body, &force);
    if (contact == TL_NO_ROW) {
        snprintf(by, sizeof by, "no contact presses on it");
    } else {
        char name[320];
        tl_contact_describe(m, contact, name, sizeof name);
        tl_text_print(by, sizeof by, "most of all presses the %s, with %.3g N", name, force);
    }
    if (isfinite(travel))
        tl_text_print(far, sizeof far, "%.3g m in this step, more than %d times its diameter of %.3g m", travel,
                      TL_TRAVEL, diameter);
    else
        snprintf(far, sizeof far, "in this step by what is no finite number");
    cause most = find_cause(m, body, k, force);
    bool given = !isnan(tl_given_step(m)) || tl_adds_mass(m);
    return tl_fail(&m->error, TL_E_NUMERIC,
                   "cycle %lld: block %u would move %s, for %s (dt = %.3g s%s); %s: is that out of proportion%s?",
                   (long long)m->cycles + 1, b->id[body], far, most.text, k->dt, given ? ", as given" : "", by,
                   given ? ", or the time step too large" : "");
}

/* Bounds of the bodies whose motion is given count besides those of the last step, until all are known. */
static void keep_bounds(struct tl_cycle *c, const limit_job *job, unsigned threads)
{
    tl_speed_bounds *found = job->held ? &c->given : &c->speeds;
    *found = (tl_speed_bounds){0, 0};
    for (unsigned i = 0; i < threads; i++)
        widen(found, job->bounds[i]);
    widen(&c->speeds, c->given);
}

tl_status tl_motion_check(tl_model *m, double dt, bool held)
{
    struct tl_cycle *c = m->cycle;
    unsigned threads = tl_pool_threads(m->pool);
    /* its bounds are kilobytes, of which only those of the threads there are count */
    limit_job job;
    job.m = m;
    job.span = (step_span){dt, 0.5 * (m->dt + dt)};
    job.held = held;
    for (unsigned i = 0; i < threads; i++)
        job.bounds[i] = (tl_speed_bounds){0, 0};
    atomic_init(&job.fast, false);
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, check_range, &job);
    if (!held)
        c->fast = atomic_load(&job.fast);
    keep_bounds(c, &job, threads);
    if (c->failure.error.status != TL_OK) {
        c->failure.error.status = TL_OK;
        return report(m, (uint32_t)c->failure.point, &job.span);
    }
    if (held)
        c->may_pass = !m->relaxing && travel_may_matter(m, dt);
    if (m->relaxing)
        return !held && dt > 0 && travel_may_matter(m, dt) ? hold_back(m, &job.span) : TL_OK;
    /* a step that is not kept is one in which nothing can have become fast at once */
    return !held && tl_undo_keeps(m) && travel_may_matter(m, dt) ? travel_check(m, &job.span) : TL_OK;
}
