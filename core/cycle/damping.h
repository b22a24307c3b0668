/* damping.h - the damping plugin. */
#ifndef TL_CYCLE_DAMPING_H
#define TL_CYCLE_DAMPING_H

#include "cycle/cycle_data.h"

/* Replaces the model's damping, with initial states. With `from`, params of the same kind, what is not given is taken
 * from it. */
tl_status tl_damping_make(tl_model *m, const tl_kind *kind, const tl_args *args, const void *from);
tl_status tl_damping_apply(tl_model *m, double dt);

#endif
