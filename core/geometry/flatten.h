/* flatten.h - facets that lie in one plane become one face. */
#ifndef TL_GEOMETRY_FLATTEN_H
#define TL_GEOMETRY_FLATTEN_H

#include "geometry/polyhedron.h"

/* Makes one face of facets with one tag that lie in one plane as far as TL_POLY_BENT and TL_POLY_TILT tell. Fits the
 * planes of faces whose corners miss them by more than TL_POLY_FLAT. What comes out keeps tl_poly_check within
 * TL_POLY_BENT. A polyhedron that has no such faces, or would be no block with them, is left as it is. */
tl_status tl_poly_flatten(tl_poly **poly, tl_error *error);

#endif
