/* zone_edges.h - the points of zones on the edges of a block. */
#ifndef TL_GEOMETRY_ZONE_EDGES_H
#define TL_GEOMETRY_ZONE_EDGES_H

#include "geometry/zone_points.h"

/* Lays the points on all edges, one edge after the other. */
tl_status tl_zone_edges_lay(tl_zone_points *points, tl_error *error);

#endif
