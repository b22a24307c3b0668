/* element_fields.h - what can be asked of elements. */
#ifndef TL_QUERY_ELEMENT_FIELDS_H
#define TL_QUERY_ELEMENT_FIELDS_H

#include "model/model.h"

/* The row of an element, with what is known of it brought up to date; TL_NO_ROW after an error. */
uint32_t tl_element_find(tl_model *m, tl_id id);
/* Where a state is: of node `index` or, with SIZE_MAX, of the whole. NULL after an error. */
double *tl_element_state_at(tl_model *m, tl_id element, size_t index, const char *name);

#endif
