/* convex_parts.h - a solid that need not be convex, divided into convex polyhedra that fill it. */
#ifndef TL_GEOMETRY_CONVEX_PARTS_H
#define TL_GEOMETRY_CONVEX_PARTS_H

#include "geometry/polyhedron.h"
#include "geometry/solid_surface.h"

typedef struct tl_convex_parts {
    tl_poly **part;
    size_t count;
    size_t reflex_edges; /* edges at which the surface bends inward */
} tl_convex_parts;

/* Divides a solid. A face of a part has the tag of the face that it lies on, or 0 between parts; where it lies on
 * several, that with most of its area. TL_E_GEOMETRY, with the place: the surface is open, crosses itself, or has an
 * edge of more than two faces. So it is for one turned inside out or without volume. Indices must be valid, and
 * coordinates finite. */
tl_status tl_convex_parts_make(const tl_solid_surface *surface, tl_convex_parts *parts, tl_error *error);
void tl_convex_parts_free(tl_convex_parts *parts);

#endif
