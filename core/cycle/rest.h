/* rest.h - whether the model is at rest. */
#ifndef TL_CYCLE_REST_H
#define TL_CYCLE_REST_H

#include "cycle/cycle_data.h"

/* Whether the model is at rest by a measure, to within a ratio. */
bool tl_at_rest(tl_model *m, tl_ratio_measure measure, double ratio);

#endif
