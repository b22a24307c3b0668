/* wrench.h - what loads do, as a force and a moment. */
#ifndef TL_MODEL_WRENCH_H
#define TL_MODEL_WRENCH_H

#include "model/model.h"

/* What the load of a body does. */
static inline tl_wrench tl_load_wrench(const tl_bodies *b, uint32_t body)
{
    tl_body_load load = tl_load_of(b, body);
    tl_vec3 arm = tl_m3_mul(&b->pose[body].r, load.arm);
    return (tl_wrench){load.force, tl_v3_add(load.moment, tl_v3_cross(arm, load.force))};
}

/* Whether it was another in the last step, in which the body was what it is. */
static inline bool tl_load_changed(const tl_model *m, uint32_t body)
{
    if (!m->loads_changed || isnan(m->bodies.load_before[body].force.x))
        return false;
    tl_wrench now = tl_load_wrench(&m->bodies, body), before = m->bodies.load_before[body];
    return !tl_v3_is_zero(tl_v3_sub(now.force, before.force)) ||
           !tl_v3_is_zero(tl_v3_sub(now.moment, before.moment));
}

#endif
