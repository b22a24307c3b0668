/* solid_part.h - a piece without reflex edges as a convex polyhedron. */
#ifndef TL_GEOMETRY_SOLID_PART_H
#define TL_GEOMETRY_SOLID_PART_H

#include "base/error.h"
#include "geometry/polyhedron.h"
#include "geometry/solid_mesh.h"

/* The convex part that the faces of a piece close. TL_E_GEOMETRY: they do not. */
tl_status tl_solid_part(tl_solid_mesh *m, const uint32_t *face, uint32_t count, tl_poly **part, tl_error *error);

#endif
