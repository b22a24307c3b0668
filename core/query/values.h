/* values.h - what a name stands for that many values are asked by: a field, or a state of a law (values.c). */
#ifndef TL_QUERY_VALUES_H
#define TL_QUERY_VALUES_H

#include "query/law_states.h"

typedef struct tl_value_of {
    size_t field;              /* index; the number of fields for a state */
    const tl_law_state *state; /* or NULL */
    size_t width;              /* numbers a value has */
} tl_value_of;

/* Looks a name up among fields and, unless NULL, states. `item` is "block". The text `state` is taken for a number; other
 * texts are refused. */
tl_status tl_value_find(tl_model *m, const char *item, const tl_field *fields, size_t count,
                        const tl_law_states *states, const char *name, tl_value_of *of);
/* The same of contacts or their points, which it brings up to date: lists the states of their laws, to be freed in any case. */
tl_status tl_contact_value_find(tl_model *m, const char *item, const tl_field *fields, size_t count,
                                tl_law_states *states, const char *name, tl_value_of *of);
/* Row of the contact of an id, or TL_E_STALE with a sentence; contacts are up to date. */
tl_status tl_contact_find(tl_model *m, tl_id contact, uint32_t *row);

#endif
