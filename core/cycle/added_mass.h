/* added_mass.h - partial mass scaling: inertia added to the bodies that would make the step short. */
#ifndef TL_CYCLE_ADDED_MASS_H
#define TL_CYCLE_ADDED_MASS_H

#include "cycle/cycle_data.h"

/* The highest stable rates, of bodies and of gridpoints, 1/s2. */
typedef struct tl_rate_limits {
    double body, point;
} tl_rate_limits;

/* Gives the bodies and gridpoints whose rates are higher the inertia that they need. */
tl_status tl_added_find(tl_model *m, tl_rate_limits limit);

#endif
