/* stiffness.h - how stiff the zones hold each gridpoint: what that asks of the time step. */
#ifndef TL_ZONE_STIFFNESS_H
#define TL_ZONE_STIFFNESS_H

#include "zone/zones.h"

/* Finds `stiffness` of all gridpoints, and the one with the highest rate of those that may move, where meshes or solids
 * have changed, or some steps have been made since. */
void tl_zones_rate(tl_model *m);

#endif
