/* travel.h - how far a step may carry and turn blocks (travel.c). */
#ifndef TL_CYCLE_TRAVEL_H
#define TL_CYCLE_TRAVEL_H

#include "cycle/kicked.h"

/* Whether a step so long may carry some body too far: false is sure. Takes a constant time but after an edit. */
bool tl_travel_may_matter(const tl_model *m, double dt);
/* The longest step up to `dt` that carries and turns blocks as little as a step that the program chooses should, s, and the row
 * of a body that sets it, or TL_NO_ROW. */
tl_status tl_travel_shorten(tl_model *m, double *dt, uint32_t *body);
/* Fails with a sentence when the step would carry or turn a block too far. `span`: of the step, after its forces. */
tl_status tl_travel_check(tl_model *m, const tl_step_span *span);

#endif
