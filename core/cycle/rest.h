/* rest.h - whether the model is at rest. */
#ifndef TL_CYCLE_REST_H
#define TL_CYCLE_REST_H

#include "cycle/cycle_data.h"

/* An unbalanced force ratio of the last gather. */
double tl_unbalanced_ratio(const tl_model *m, tl_ratio_measure measure);
/* Whether the model is at rest by a measure, to within a ratio. */
bool tl_at_rest(tl_model *m, tl_ratio_measure measure, double ratio);
/* Id of the body that is farthest from equilibrium by the local measure, or TL_NO_ID. */
tl_id tl_worst_body(const tl_model *m);
/* Force that a body bears at the least: what its contacts carry at an overlap that is rounding. */
double tl_least_borne(const tl_model *m, uint32_t body);

#endif
