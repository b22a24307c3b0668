/* loose.h - bodies that next to nothing bears: what a relaxation does with them (settle.c). */
#ifndef TL_CYCLE_LOOSE_H
#define TL_CYCLE_LOOSE_H

#include "cycle/cycle_data.h"
#include "model/body_shape.h"

/* Tolerance: unbalanced force over what a body bears, from which on next to nothing bears it. */
#define TL_LOOSE 0.5

/* Whether a body of that weight is loose: how others move says nothing of it. */
static inline bool tl_body_is_loose(const tl_model *m, uint32_t body, double weight)
{
    return tl_v3_norm(m->bodies.force[body]) > TL_LOOSE * tl_borne(m, body, weight);
}

/* Whether next to nothing bears a body of that weight: it falls. */
static inline bool tl_body_falls(const tl_model *m, uint32_t body, double weight)
{
    return m->cycle->contact_force[body] < TL_LOOSE * weight;
}

/* Tolerance: of the thickness of a block, how far it falls in a step by its own mass in a relaxation. */
#define TL_FALL_STEP 0.1

/* What scaling makes of a body's mass in this step. In a relaxation what next to nothing bears has its own mass: it
 * falls as fast as it would, and is gone before what is heavy has settled. But it has more, up to the scaled mass,
 * where a step would be too long: what is thin, or has landed before, lands in steps that contacts can follow. */
static inline double tl_step_scale(const tl_model *m, uint32_t body)
{
    const double scale = tl_inertia_scale(m->cycle, body);
    if (!m->relaxing || m->cycle->settling.leapt ||
        !tl_body_falls(m, body, tl_weight_of(&m->bodies, body, tl_v3_norm(m->config.gravity))))
        return scale;
    const double dt = m->cycle->dt, thin = TL_FALL_STEP * tl_body_least_thickness(m, body);
    const double most = thin < m->bodies.fall[body] ? thin : m->bodies.fall[body];
    const double left = most - tl_v3_norm(m->bodies.v[body]) * dt;
    const double needed = tl_v3_norm(m->bodies.force[body]) * (dt * dt) / m->bodies.mass[body];
    return needed < left ? 1 : needed < scale * left ? needed / left : scale;
}

#endif
