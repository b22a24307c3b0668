/* idle.h - bodies that are left alone in a step: what acts on them stands. */
#ifndef TL_CYCLE_IDLE_H
#define TL_CYCLE_IDLE_H

#include "cycle/cycle_data.h"
#include "cycle/element_forces.h"
#include "element/elements.h"

/* Bodies on which what contacts do stands, a flag each, or NULL: they and their contacts rest. Only contacts and
 * elements are known to leave others alone. */
static inline const uint8_t *tl_idle_bodies(const tl_model *m)
{
    const tl_contributor *const *of = m->cycle->contributor;
    const bool known = !of[1] || (of[1] == &tl_elements_act && !of[2]);
    return m->detect->any_idle && known ? m->detect->idle : NULL;
}

/* Whether what acts on a body stands: no node of an element is on it. `idle`: those of the model. */
static inline bool tl_body_idles(const tl_model *m, const uint8_t *idle, uint32_t body)
{
    if (!idle || !idle[body])
        return false;
    const struct tl_elements *e = m->cycle->contributor[1] ? m->elements : NULL;
    return !e || e->use_start[body] == e->use_start[body + 1];
}

#endif
