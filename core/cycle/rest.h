/* rest.h - whether the model is at rest. */
#ifndef TL_CYCLE_REST_H
#define TL_CYCLE_REST_H

#include "cycle/cycle_data.h"

/* An unbalanced force ratio of the last gather. */
double tl_unbalanced_ratio(const tl_model *m, tl_ratio_measure measure);
/* Whether the model is at rest by a measure, to within a ratio. */
bool tl_at_rest(tl_model *m, tl_ratio_measure measure, double ratio);
/* Force that a body bears at the least: what its contacts carry at an overlap that is rounding. */
double tl_least_borne(const tl_model *m, uint32_t body);

#endif
