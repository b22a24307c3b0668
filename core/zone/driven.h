/* driven.h - how driven gridpoints move. */
#ifndef TL_ZONE_DRIVEN_H
#define TL_ZONE_DRIVEN_H

#include "zone/zones.h"

/* The velocity of a driven gridpoint in a step of dt, m/s: that of its drive and, with a gradient, what that gives in
 * the middle of its way. */
tl_vec3 tl_gridpoint_driven(const tl_model *m, uint32_t row, double dt);

#endif
