/* gridpoints.h - what a user does to gridpoints. */
#ifndef TL_ZONE_GRIDPOINTS_H
#define TL_ZONE_GRIDPOINTS_H

#include "zone/name.h"
#include "zone/zones.h"

/* Holds components of gridpoints (TL_FIX_X, _Y, _Z, added up) where they are, or lets them go. */
tl_status tl_gridpoints_fix(tl_model *model, const tl_zone_name *names, size_t count, uint32_t what);
tl_status tl_gridpoints_free(tl_model *model, const tl_zone_name *names, size_t count, uint32_t what);
/* Puts a force on each, N, in the place of what it had. */
tl_status tl_gridpoints_load(tl_model *model, const tl_zone_name *names, size_t count, tl_vec3 force);
/* Gives them velocities, m/s: names[i] gets velocity[i]. Held components go on with theirs. */
tl_status tl_gridpoints_velocity(tl_model *model, const tl_zone_name *names, size_t count, const tl_vec3 *velocity);
/* The force with which what holds them acts on them, N: the sum over their held components. */
tl_status tl_gridpoints_reaction(tl_model *model, const tl_zone_name *names, size_t count, tl_vec3 *force);

#endif
