/* kicked.c - the velocities that a step gives a body, before anything moves: for the bounds on a step's motion. */
#include "cycle/kicked.h"

#include "cycle/kick.h"

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
