/* travel.c - a step heeds what moves: v dt and w dt.
 *
 * Stiffness bounds the step of blocks in contact. Between contacts a block travels by v dt whatever that is. Two things go wrong
 * when it is far: the block passes another, or goes in so deep that no contact can tell which way it came (passing.c); and a
 * turn by an angle t in a step makes central differences of what turns with the block wrong by a share of t^2 / 6.
 *
 * A step that the program chooses is made as short as both ask, and no block is slowed down in empty space: only what a block
 * may meet in the step counts. A step that is given stays as it is. Either is looked at once more when the forces are known, with
 * limits that are some twice as wide, and fails when it exceeds them, before anything moves.
 *
 * The bodies are gone through only when the fastest of them may be too fast for the thinnest block of the model, or after something
 * was set by hand. Blocks at rest pay one comparison a step. */
#include "cycle/travel.h"

#include <stdio.h>
#include <talus/number.h>

/* By how much the overlap of two blocks may grow in a step, over the thickness of the thinner one: aimed at, and at the most. A
 * contact that is born with half of the thickness still knows which way it came (TL_DEEPEST_BORN of overlap.c is 0.9). */
#define CLOSING_AIM 0.25
#define CLOSING_MOST 0.5
/* Turn of a body in a step, rad: t^2 / 6 is 0.2 % of 0.1 and 1 % of 0.25. Passing is looked for with turns taken as small. */
#define TURN_AIM 0.1
#define TURN_MOST 0.25
/* Least step that is chosen, over the stable one. A model that needs a shorter one moves out of all proportion, and would hardly
 * get on. */
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

bool tl_travel_may_matter(const tl_model *m, double dt)
{
    const tl_speed_bounds *b = &m->cycle->speeds;
    /* two bodies meet with the sum of their speeds */
    double closing2 = 4 * 4 * b->speed2 * dt * dt, may = CLOSING_AIM * thinnest_of(m);
    bool slow = closing2 < may * may && 2 * b->turn2 * dt * dt < TURN_AIM * TURN_AIM;
    return !slow || tl_set_by_hand(m);
}

/* What the step does to each body, with a place for the bounds of each block; NULL: out of memory. The memory is kept for the steps
 * that follow: blocks that are fast in one step are so in the next. */
static tl_step_motion *motions_of(tl_model *m, const tl_step_span *span)
{
    struct tl_cycle *c = m->cycle;
    size_t bodies = m->bodies.table.rows, blocks = m->blocks.table.rows;
    if (!tl_fit(&c->motion, &c->motion_capacity, bodies + 1, sizeof *c->motion) ||
        !tl_fit(&c->swept, &c->swept_capacity, blocks + 1, sizeof *c->swept))
        return NULL;
    for (uint32_t body = 0; body < bodies; body++) {
        tl_vec3 v, w;
        tl_kicked(m, body, span, &v, &w);
        c->motion[body] = (tl_step_motion){tl_v3_scale(span->dt, v), tl_v3_scale(span->dt, w)};
    }
    return c->motion;
}

/* What a part of the step does. */
static void scale_motions(const tl_model *m, tl_step_motion *motion, double part)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        motion[body].shift = tl_v3_scale(part, motion[body].shift);
        motion[body].turn = tl_v3_scale(part, motion[body].turn);
    }
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
    double far_a = tl_v3_norm(motion[body_a].shift) +
                   tl_v3_norm(motion[body_a].turn) * m->bodies.radius[body_a];
    double far_b = tl_v3_norm(motion[body_b].shift) +
                   tl_v3_norm(motion[body_b].turn) * m->bodies.radius[body_b];
    return far_b > far_a ? body_b : body_a;
}

tl_status tl_travel_shorten(tl_model *m, double *dt, uint32_t *body)
{
    *body = TL_NO_ROW;
    if (!tl_travel_may_matter(m, *dt))
        return TL_OK;
    const double least = SHORTEST * *dt;
    tl_step_motion *motion = motions_of(m, &(tl_step_span){*dt, 0});
    if (!motion)
        return tl_fail_memory(&m->error);
    double turn;
    uint32_t turns = widest_turn(m, motion, &turn);
    if (turn > TURN_AIM) {
        scale_motions(m, motion, TURN_AIM / turn);
        *dt *= TURN_AIM / turn;
        *body = turns;
    }
    const tl_passing passing =
        tl_passing_find(m, motion, CLOSING_AIM, thinnest_of(m), m->cycle->swept);
    if (passing.part < 1) {
        *dt *= passing.part;
        *body = faster_of(m, motion, passing.a, passing.b);
    }
    *dt = fmax(*dt, least);
    return TL_OK;
}

/* What to do about a step that should be `longest` s at the most. */
static const char *way_out(const tl_model *m, double longest, char *text, size_t size)
{
    if (!isnan(m->timestep.dt) || tl_adds_mass(m))
        tl_text_print(text, size, "give a dt of %.2g s or less, or leave dt out", longest);
    else if (m->timestep.fraction > 1)
        tl_text_print(text, size, "fraction = %g of timestep is not stable; give 1 or less",
                      m->timestep.fraction);
    else
        snprintf(text, size, "is a velocity, a load or gravity out of proportion?");
    return text;
}

static tl_status report_turn(tl_model *m, uint32_t body, double turn, double dt)
{
    char text[120];
    return tl_fail(&m->error, TL_E_NUMERIC,
                   "cycle %lld: block %u, at %.3g rad/s, would turn by %.3g rad in this step of dt "
                   "= %.3g s, more than the %g rad up to which its motion is right to 1 %%: %s",
                   (long long)m->cycles + 1, m->bodies.id[body], turn / dt, turn, dt, TURN_MOST,
                   way_out(m, dt * TURN_AIM / turn, text, sizeof text));
}

static tl_status report_passing(tl_model *m, const tl_step_motion *motion, const tl_passing *p,
                                double dt)
{
    uint32_t fast = faster_of(m, motion, p->a, p->b);
    uint32_t mover = m->blocks.body[p->a] == fast ? p->a : p->b;
    uint32_t other = mover == p->a ? p->b : p->a;
    char text[120];
    return tl_fail(
        &m->error, TL_E_NUMERIC,
        "cycle %lld: block %u, at %.3g m/s, would be carried %.3g m into or past block %u in this "
        "step of dt = %.3g s, more than the %.3g m, half of the thinner one's thickness, up to "
        "which their contact can tell which way they came: %s",
        (long long)m->cycles + 1, m->blocks.id[mover], tl_v3_norm(motion[fast].shift) / dt,
        p->deeper, m->blocks.id[other], dt, p->allowed,
        way_out(m, dt * p->part * CLOSING_AIM / CLOSING_MOST, text, sizeof text));
}

tl_status tl_travel_check(tl_model *m, const tl_step_span *span)
{
    tl_step_motion *motion = motions_of(m, span);
    if (!motion)
        return tl_fail_memory(&m->error);
    double turn;
    uint32_t turns = widest_turn(m, motion, &turn);
    if (turn > TURN_MOST)
        return report_turn(m, turns, turn, span->dt);
    const tl_passing passing =
        tl_passing_find(m, motion, CLOSING_MOST, thinnest_of(m), m->cycle->swept);
    return passing.part < 1 ? report_passing(m, motion, &passing, span->dt) : TL_OK;
}
