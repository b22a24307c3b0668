/* cycle.h - one step, top to bottom. */
#ifndef TL_CYCLE_CYCLE_H
#define TL_CYCLE_CYCLE_H

#include "cycle/cycle_data.h"

/* One step of the model; a failure leaves the model as it was. */
tl_status tl_step(tl_model *m);

#endif
