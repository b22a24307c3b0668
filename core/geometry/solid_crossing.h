/* solid_crossing.h - whether the surface of a solid crosses itself. */
#ifndef TL_GEOMETRY_SOLID_CROSSING_H
#define TL_GEOMETRY_SOLID_CROSSING_H

#include "base/error.h"
#include "geometry/solid_mesh.h"

/* Refuses a surface that crosses itself, with the place. */
tl_status tl_solid_check_crossing(const tl_solid_mesh *m, tl_error *error);

#endif
