/* place.h - a kind places its elements: what it asks of the host, and what comes of it. */
#ifndef TL_ELEMENT_PLACE_H
#define TL_ELEMENT_PLACE_H

#include "element/placing.h"

/* Begins, without elements; free it with tl_placing_free. */
void tl_placing_begin(tl_placing *p, tl_model *m, tl_faces_fn find_faces);
/* Asks the kind of a set to place its elements, which get the number `set`. */
tl_status tl_placing_ask(tl_placing *p, const tl_element_set *of, uint32_t set);
/* Appends rows for all that has been placed; set k of the call is set `first_set` + k of the model. Nothing has changed
 * when it fails: TL_E_MEMORY. */
tl_status tl_placing_commit(tl_placing *p, uint32_t first_set);
void tl_placing_free(tl_placing *p);

#endif
