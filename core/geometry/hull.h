/* hull.h - the convex hull of points as a polyhedron. */
#ifndef TL_GEOMETRY_HULL_H
#define TL_GEOMETRY_HULL_H

#include "geometry/polyhedron.h"

/* What the points of a hull are. */
typedef enum tl_hull_of {
    TL_HULL_OF_CORNERS, /* its corners, or on its faces: one inside by more than TL_POLY_BENT is refused */
    TL_HULL_OF_ANY      /* any points: those inside are left out */
} tl_hull_of;

/* The convex hull of points. Triangles that lie in one plane become one face (tl_poly_flatten), and points on the
 * faces that are no corners are left out. Fails (TL_E_GEOMETRY) for fewer than four points, NaN, a flat or thinner
 * than TL_POLY_THIN set. It also fails for a point that is refused: the sentence names the point, counted from 1. */
tl_status tl_poly_hull(const tl_vec3 *points, size_t count, tl_hull_of of, tl_poly **poly, tl_error *error);

#endif
