/* added_mass.h - inertia added for a longer step. */
#ifndef TL_CYCLE_ADDED_MASS_H
#define TL_CYCLE_ADDED_MASS_H

#include "cycle/cycle_data.h"

/* Finds the inertia that the bodies need to be stable at a step that allows rates up to `limit`, from the rates that
 * are kept. A failure changes nothing. */
tl_status tl_added_find(tl_model *m, double limit);

#endif
