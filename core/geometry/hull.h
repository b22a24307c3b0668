/* hull.h - the convex hull of points as a polyhedron. */
#ifndef TL_GEOMETRY_HULL_H
#define TL_GEOMETRY_HULL_H

#include "geometry/polyhedron.h"

/* The convex hull of points. Triangles that lie in one plane become one face (tl_poly_flatten), and points on the
 * faces that are no corners are left out. Fails (TL_E_GEOMETRY) for fewer than four points, NaN, a flat or thinner
 * than TL_POLY_THIN set. It also fails for a point inside the hull of the others by more than TL_POLY_BENT: the
 * sentence names the point, counted from 1. */
tl_status tl_poly_hull(const tl_vec3 *points, size_t count, tl_poly **poly, tl_error *error);
/* The same of any points: those inside are left out. */
tl_status tl_poly_hull_around(const tl_vec3 *points, size_t count, tl_poly **poly, tl_error *error);

#endif
