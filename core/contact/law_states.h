/* law_states.h - the states that a kind of law keeps of each point, and the columns that they take. */
#ifndef TL_CONTACT_LAW_STATES_H
#define TL_CONTACT_LAW_STATES_H

#include "base/kind_states.h"

/* A state of a kind: its descriptor, and its columns, three of a vector and one of a scalar. */
typedef struct tl_state_columns {
    const tl_state *state;
    uint32_t begin, count;
    uint32_t next; /* the state after it */
} tl_state_columns;

/* Goes to the next state of a kind that has columns among the first `columns`. No kind has no states:
 * for (tl_state_columns at = {0}; tl_state_next(kind, columns, &at);) */
static inline bool tl_state_next(const tl_kind *kind, uint32_t columns, tl_state_columns *at)
{
    at->begin += at->count;
    if (!kind || at->next == kind->state_count || at->begin >= columns)
        return false;
    at->state = tl_kind_state(kind, at->next++);
    at->count = tl_state_width(at->state->kind);
    return true;
}

static inline uint32_t tl_kind_state_columns(const tl_kind *kind)
{
    tl_state_columns at = {0};
    while (tl_state_next(kind, UINT32_MAX, &at))
        ;
    return at.begin;
}

#endif
