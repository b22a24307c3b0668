/* point_fields.h - what can be asked of contact points. */
#ifndef TL_QUERY_POINT_FIELDS_H
#define TL_QUERY_POINT_FIELDS_H

#include "model/model.h"

#include <talus/fields.h>

typedef struct tl_law_states {
    tl_law_state *at;
    size_t count;
    uint32_t *column; /* [joint law * count + state]: first column, or TL_NO_ROW where the law has no such state */
} tl_law_states;

/* Lists the states of all laws that the model's joints have, in the order of the laws. Freed by tl_law_states_free,
 * also after a failure. */
tl_status tl_law_states_list(tl_model *m, tl_law_states *states);
void tl_law_states_free(tl_law_states *states);

/* The same of the whole contact: the mean of its points, weighted by their areas, or the sum where a state goes with
 * the area. */
void tl_law_state_of_contact(const tl_model *m, const tl_law_states *states, const tl_law_state *of, uint32_t contact,
                             double value[3]);
/* Slip of a contact, m, as pages and files tell it: its law's state "slip". Where the law keeps none it is the length
 * of `shear_displacement`, by which its blocks have moved along it against each other. */
double tl_law_states_slip(const tl_model *m, const tl_law_states *states, uint32_t contact, tl_vec3 shear_displacement);

#endif
