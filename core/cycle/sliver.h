/* sliver.h - blocks so small or thin that they make the time step short, by the rates that the step goes by. */
#ifndef TL_CYCLE_SLIVER_H
#define TL_CYCLE_SLIVER_H

#include "cycle/cycle_data.h"
#include "model/slivers.h"

/* The highest of the rates by which bodies make the step short, and whose it is. */
tl_row_value tl_sliver_fastest(const tl_model *m, const double *counted);
/* Limits for a filter that makes the step longer. `counted`, [bodies], are the rates of the bodies' contacts.
 * TL_E_MEMORY. */
tl_status tl_sliver_limits_choose(tl_model *m, const double *counted, tl_sliver_limits *out);
/* Says once of a model's blocks that one of them makes the step short. */
void tl_sliver_remark(tl_model *m);

#endif
