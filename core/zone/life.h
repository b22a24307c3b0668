/* life.h - the tables of zones come and go. */
#ifndef TL_ZONE_LIFE_H
#define TL_ZONE_LIFE_H

#include "zone/zones.h"

/* Makes the model's zones, without any; nothing when they are there. */
tl_status tl_zones_begin(tl_model *m);
void tl_zones_free(struct tl_zones *z);
/* Columns that are made when they are needed: what a damping gives, with the forces of the step before, and loads.
 * false: out of memory. */
bool tl_gridpoints_hold_damping(tl_gridpoints *p, bool before);
bool tl_gridpoints_hold_loads(tl_gridpoints *p);

#endif
