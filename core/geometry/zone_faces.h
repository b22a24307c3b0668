/* zone_faces.h - the points of zones on the faces of a block, and where all surface points are in their faces. */
#ifndef TL_GEOMETRY_ZONE_FACES_H
#define TL_GEOMETRY_ZONE_FACES_H

#include "geometry/zone_near.h"
#include "geometry/zone_points.h"

/* Lays the points inside all faces, one face after the other, and gives all surface points their coordinates there. */
tl_status tl_zone_faces_lay(tl_zone_points *points, tl_zone_near *near, tl_error *error);

#endif
