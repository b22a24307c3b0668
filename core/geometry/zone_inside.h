/* zone_inside.h - the points of zones inside a block. */
#ifndef TL_GEOMETRY_ZONE_INSIDE_H
#define TL_GEOMETRY_ZONE_INSIDE_H

#include "geometry/zone_near.h"
#include "geometry/zone_points.h"

/* Lays the points inside: after those of corners, edges and faces. */
tl_status tl_zone_inside_lay(tl_zone_points *points, tl_zone_near *near, tl_error *error);

#endif
