/* kicked.h - the velocities that a step gives a body, before anything moves (kicked.c). */
#ifndef TL_CYCLE_KICKED_H
#define TL_CYCLE_KICKED_H

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

tl_push tl_push_of(const tl_model *m, uint32_t body);
/* Velocities after the kick, as the move makes them; with a span of 0 those that the body has, or that its drive gives. */
void tl_kicked(const tl_model *m, uint32_t body, const tl_step_span *k, tl_vec3 *v, tl_vec3 *w);

#endif
