/* limits.h - how far a body may move in one step. */
#ifndef TL_CYCLE_LIMITS_H
#define TL_CYCLE_LIMITS_H

#include "cycle/cycle_data.h"

/* Every body would move by a finite number that is not out of all proportion, or a sentence that names one that would
 * not: those that forces move or, with `held`, after the drives have been evaluated, those whose motion is given. */
tl_status tl_motion_check(tl_model *m, double dt, bool held);

/* Shortens `dt`, s, so that no block is carried or turned far. *body: the row of a body that sets it, or TL_NO_ROW. */
tl_status tl_travel_shorten(tl_model *m, double *dt, uint32_t *body);

#endif
