/* added_mass.h - inertia added for a longer step. */
#ifndef TL_CYCLE_ADDED_MASS_H
#define TL_CYCLE_ADDED_MASS_H

#include "cycle/cycle_data.h"

/* Finds the inertia that bodies need so that no kept rate is above `limit`. A failure changes nothing. */
tl_status tl_added_find(tl_model *m, double limit);

#endif
