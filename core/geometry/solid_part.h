/* solid_part.h - a piece without reflex edges as a convex polyhedron. */
#ifndef TL_GEOMETRY_SOLID_PART_H
#define TL_GEOMETRY_SOLID_PART_H

#include "base/error.h"
#include "geometry/polyhedron.h"
#include "geometry/solid_mesh.h"

/* The convex part that a piece is. TL_E_GEOMETRY: it is none. */
tl_status tl_solid_part(tl_solid_mesh *m, uint32_t piece, tl_poly **part, tl_error *error);

#endif
