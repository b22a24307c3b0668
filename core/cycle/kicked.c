/* kicked.c - the velocities that a step gives a body, before anything moves: for the bounds on a step's motion. */
#include "cycle/kicked.h"

#include "base/columns.h"
#include "cycle/kick.h"

tl_push tl_push_of(const tl_model *m, uint32_t body)
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

/* Velocities after the kick, as the move makes them. */
void tl_kicked(const tl_model *m, uint32_t body, const tl_step_span *k, tl_vec3 *v, tl_vec3 *w)
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
    if (!(k->span > 0))
        return;
    tl_push p = tl_push_of(m, body);
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
