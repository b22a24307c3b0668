/* columns.h - columns of gridpoints that are made when they are needed: few meshes have them. */
#ifndef TL_ZONE_COLUMNS_H
#define TL_ZONE_COLUMNS_H

#include "zone/zones.h"

/* Each tells whether there was memory enough. What a damping gives, with the forces of the step before; loads. */
bool tl_gridpoints_hold_damping(tl_gridpoints *p, bool before);
bool tl_gridpoints_hold_loads(tl_gridpoints *p);
/* What acts on surfaces, resists there, and holds along directions; drives. */
bool tl_gridpoints_hold_pushed(tl_gridpoints *p);
bool tl_gridpoints_hold_quiet(tl_gridpoints *p);
bool tl_gridpoints_hold_directions(tl_gridpoints *p);
bool tl_gridpoints_hold_drives(tl_gridpoints *p);

#endif
