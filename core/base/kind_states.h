/* kind_states.h - the states that a kind declares, and the columns that they take. */
#ifndef TL_BASE_KIND_STATES_H
#define TL_BASE_KIND_STATES_H

#include <talus/plugin.h>

/* State descriptor k of a kind. */
static inline const tl_state *tl_kind_state(const tl_kind *kind, uint32_t k)
{
    return (const tl_state *)(const void *)((const char *)kind->states + (size_t)k * kind->state_stride);
}

/* Columns of a state of that kind. */
static inline uint32_t tl_state_width(uint32_t kind)
{
    return kind == TL_STATE_SCALAR || kind == TL_STATE_WHOLE ? 1 : kind == TL_STATE_TENSOR ? 6 : 3;
}

#endif
