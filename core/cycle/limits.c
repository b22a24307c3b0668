/* limits.c - how far a body may move in one step: the last look before anything moves.
 *
 * A step that would take a body farther than TL_TRAVEL times its diameter, or nowhere that is a number, has no meaning:
 * the body would pass through others unseen, turn by several radians at a time, and lose the digits of its place. Such a
 * step fails before the move, so places and velocities of a model are finite numbers always. The bound is on
 * (|v| + |w| r) dt, v and w the velocities that the kick would give (motion.c), r the farthest vertex.
 *
 * All bodies are looked at in every step: a test without roots sorts out those that are far from the limit. */
#include "cycle/cycle_data.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "cycle/kick.h"

#include <stdatomic.h>
#include <stdio.h>

/* Most motion in a step over the body's diameter, 2 r. Blocks in contact move by 1e-2 of it at the most where the step
 * is stable; ten leaves room for fragments in free fall with a long step. It is a turn of 20 radians. */
#define TL_TRAVEL 10
/* Share of that from which a body is fast: a step that follows is kept, for it may have to be undone. Blocks in contact
 * come nowhere near it, and none gets from there to the limit in one step unless something is set by hand or the given
 * time step is far above what is stable: then the step is kept, too. */
#define TL_FAST 0.01

/* What a step makes of a body's motion. */
typedef struct kick {
    double dt, span; /* of the drift and of the kick, s */
} kick;

typedef struct limit_job {
    tl_model *m;
    kick kick;
    bool held;        /* bodies whose motion is given, or those that forces move */
    atomic_bool fast; /* some body is */
} limit_job;

/* Forces on a body with those of the damping, and the inertia they meet. */
typedef struct push {
    tl_vec3 force, moment;
    double mass, alpha, scale, turn_scale;
} push;

static push push_of(const tl_model *m, uint32_t body)
{
    const struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    push p = {b->force[body], b->moment[body], b->mass[body], 0, 1, 1};
    if (tl_inertia_scaled(c)) {
        p.scale = tl_inertia_scale(c, body);
        p.turn_scale = tl_turn_scale(c, body);
    }
    if (m->damping) {
        p.force = tl_v3_add(p.force, tl_columns_get(c->damping_force, body));
        p.moment = tl_v3_add(p.moment, tl_columns_get(c->damping_moment, body));
        p.alpha = c->alpha[body];
    }
    return p;
}

/* Whether a body that can move is so far from the limit that a bound without roots tells: squares of sums are at most
 * twice the sums of squares. Where numbers leave their range it tells nothing. */
static bool surely_slow(const tl_model *m, uint32_t body, const kick *k)
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
    double motion = k->dt, limit = TL_FAST * TL_TRAVEL * r; /* half of 2 r TL_TRAVEL */
    return (v2 + w2 * r * r) * (motion * motion) < limit * limit && p.alpha >= 0;
}

/* Velocities after the kick, as the move makes them. */
static void kicked(const tl_model *m, uint32_t body, const kick *k, tl_vec3 *v, tl_vec3 *w)
{
    const tl_bodies *b = &m->bodies;
    *v = b->v[body];
    *w = b->w[body];
    if (b->fixed[body] == TL_FIX_ALL) {
        if (b->drive[body]) {
            *v = m->drives[b->drive[body] - 1].velocity;
            *w = m->drives[b->drive[body] - 1].angular_velocity;
        }
        return;
    }
    push p = push_of(m, body);
    *v = tl_kick(*v, p.force, k->span / (p.mass * p.scale), p.alpha, k->span);
    if (b->fixed[body] & TL_FIX_ROTATION)
        return;
    tl_quat axes = tl_q_mul(b->q[body], b->axes[body]);
    tl_vec3 turn = tl_q_rotate(tl_q_conj(axes), p.moment), i = b->moments[body];
    if (m->config.rotation == TL_ROTATION_PAPER)
        i = tl_v3(b->round[body], b->round[body], b->round[body]);
    turn = tl_q_rotate(axes, tl_v3(turn.x / i.x, turn.y / i.y, turn.z / i.z));
    *w = tl_kick(*w, turn, k->span / p.turn_scale, p.alpha, k->span);
}

/* How far the farthest vertex may move in the step: no number when it cannot be told. */
static double travel_of(const tl_model *m, uint32_t body, const kick *k)
{
    tl_vec3 v, w;
    kicked(m, body, k, &v, &w);
    return (tl_v3_norm(v) + tl_v3_norm(w) * m->bodies.radius[body]) * k->dt;
}

static bool too_far(const tl_model *m, uint32_t body, double travel)
{
    return !(travel <= TL_TRAVEL * 2 * m->bodies.radius[body]);
}

/* How far a load alone may move the body in a step, whichever way it comes to point as the body turns. */
static double load_travel(const tl_model *m, uint32_t body, const kick *k)
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
    (void)thread;
    limit_job *job = user;
    tl_model *m = job->m;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        bool held = m->bodies.fixed[body] == TL_FIX_ALL;
        if (!held && !job->held && m->bodies.load &&
            too_far(m, body, load_travel(m, body, &job->kick) / TL_FAST))
            atomic_store(&job->fast, true);
        if (held != job->held ||
            (held ? is_still(&m->bodies, body) : surely_slow(m, body, &job->kick)))
            continue;
        double travel = travel_of(m, body, &job->kick);
        if (too_far(m, body, travel / TL_FAST))
            atomic_store(&job->fast, true);
        if (too_far(m, body, travel)) {
            tl_failure_note(&m->cycle->failure, chunk, TL_E_NUMERIC, body, "");
            return;
        }
    }
}

/* The contact that presses on a body with the largest force, or TL_NO_ROW. One that is no number counts most. */
static uint32_t hardest_contact(const tl_model *m, uint32_t body, double *force)
{
    const tl_detect *d = m->detect;
    uint32_t found = TL_NO_ROW;
    *force = 0;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
            double f = tl_v3_norm(d->contacts.force[d->by_block[e]]);
            if (f <= *force)
                continue;
            *force = f;
            found = d->by_block[e];
        }
    }
    return found;
}

/* The sentence of a body that would move too far. */
static tl_status report(tl_model *m, uint32_t body, const kick *k)
{
    const tl_bodies *b = &m->bodies;
    char by[400], far[120];
    double force, travel = travel_of(m, body, k), diameter = 2 * b->radius[body];
    uint32_t contact = hardest_contact(m, body, &force);
    if (contact == TL_NO_ROW) {
        snprintf(by, sizeof by, "no contact presses on it");
    } else {
        char name[320];
        tl_contact_name(m, contact, name, sizeof name);
        snprintf(by, sizeof by, "most of all presses the %s, with %.3g N", name, force);
    }
    if (isfinite(travel))
        snprintf(far, sizeof far, "%.3g m in this step, more than %d times its diameter of %.3g m",
                 travel, TL_TRAVEL, diameter);
    else
        snprintf(far, sizeof far, "in this step by what is no finite number");
    return tl_fail(&m->error, TL_E_NUMERIC,
                   "cycle %lld: block %u would move %s (dt = %.3g s); %s: is the time step too "
                   "large, or a velocity, force or property out of proportion?",
                   (long long)m->cycles + 1, b->id[body], far, k->dt, by);
}

static tl_status check(tl_model *m, double dt, bool held)
{
    struct tl_cycle *c = m->cycle;
    limit_job job = {.m = m, .kick = {dt, 0.5 * (m->dt + dt)}, .held = held};
    atomic_init(&job.fast, false);
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_BODY_CHUNK, check_range, &job);
    if (!held)
        c->fast = atomic_load(&job.fast);
    if (c->failure.error.status == TL_OK)
        return TL_OK;
    c->failure.error.status = TL_OK;
    return report(m, (uint32_t)c->failure.point, &job.kick);
}

tl_status tl_motion_check_held(tl_model *m, double dt)
{
    return check(m, dt, true);
}

tl_status tl_motion_check(tl_model *m, double dt)
{
    return check(m, dt, false);
}
