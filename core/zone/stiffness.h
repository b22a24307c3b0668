/* stiffness.h - how stiff the zones hold each gridpoint: what that asks of the time step. */
#ifndef TL_ZONE_STIFFNESS_H
#define TL_ZONE_STIFFNESS_H

#include "zone/zones.h"

/* Finds `stiffness` of all gridpoints, as their zones hold them. It stands (false) where meshes and solids have not
 * changed, and few steps have been made since. */
bool tl_zones_stiffen(tl_model *m);
/* Finds the gridpoints with the highest and the lowest rate of those that may move or, where nothing may, of all. */
void tl_zones_rate(tl_model *m);

#endif
