/* sliver.h - a remark on blocks so small or thin that they make the time step short, with a filter that suffices. */
#ifndef TL_CYCLE_SLIVER_H
#define TL_CYCLE_SLIVER_H

#include "cycle/cycle_data.h"

/* Says once of a model's blocks that one of them makes the step short. */
void tl_sliver_remark(tl_model *m);

#endif
