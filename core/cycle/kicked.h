/* kicked.h - the velocities that a step gives a body, before anything moves. */
#ifndef TL_CYCLE_KICKED_H
#define TL_CYCLE_KICKED_H

#include "base/columns.h"
#include "cycle/cycle_data.h"

/* The times of a step, s: of the drift, and of the kick before it. */
typedef struct tl_step_span {
    double dt, span;
} tl_step_span;

/* Forces on a body with those of the damping, and the inertia they meet. */
typedef struct tl_push {
    tl_vec3 force, moment;
    double mass, alpha, scale, turn_scale;
} tl_push;

static inline tl_push tl_push_of(const tl_model *m, uint32_t body)
{
    const struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    tl_push p = {b->force[body], b->moment[body], b->mass[body], 0, 1, 1};
    if (tl_inertia_scaled(c)) {
        p.scale = tl_inertia_scale(c, body);
        p.turn_scale = tl_turn_scale(c, body);
    }
    if (tl_loads_lag(m)) {
        tl_wrench lag = tl_load_lag(m, body);
        p.force = tl_v3_sub(p.force, lag.force);
        p.moment = tl_v3_sub(p.moment, lag.moment);
    }
    if (m->damping) {
        p.force = tl_v3_add(p.force, tl_columns_get(c->damping_force, body));
        p.moment = tl_v3_add(p.moment, tl_columns_get(c->damping_moment, body));
        p.alpha = c->alpha[body];
    }
    return p;
}

/* Velocities after the kick, as the move makes them; with a span of 0 those that the body has, or that its drive gives. */
void tl_kicked(const tl_model *m, uint32_t body, const tl_step_span *k, tl_vec3 *v, tl_vec3 *w);

#endif
