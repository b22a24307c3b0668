/* convex_parts.h - a solid that need not be convex, divided into convex polyhedra that fill it. */
#ifndef TL_GEOMETRY_CONVEX_PARTS_H
#define TL_GEOMETRY_CONVEX_PARTS_H

#include "geometry/polyhedron.h"

/* The surface of one solid: polygons that close it, counter-clockwise from outside, with any number of corners. Face f
 * has the corners loops[start[f]] .. loops[start[f + 1] - 1]. Beside the outer shell there may be those of cavities. */
typedef struct tl_solid_surface {
    const tl_vec3 *vertices;
    size_t vertex_count;
    const uint32_t *start, *loops;
    size_t face_count;
    const tl_tag *tags; /* [face_count] or NULL */
    /* m, >= 0: what bends by less, or stands off a plane by less, is plane. At least TL_POLY_ON times the diagonal of
     * the bounds, and the rounding of the coordinates. */
    double flat;
    bool whole;    /* refuse a solid that is not convex, with the edge at which it bends inward */
    tl_vec3 place; /* added to coordinates in messages */
} tl_solid_surface;

typedef struct tl_convex_parts {
    tl_poly **part;
    size_t count;
    size_t reflex_edges; /* edges at which the surface bends inward */
} tl_convex_parts;

/* Divides a solid. Faces of parts have the tags of the faces that they lie on, or 0 between parts. TL_E_GEOMETRY, with
 * the place, for a surface that is open, crosses itself, has an edge of more than two faces, is turned inside out or
 * holds no volume. Indices must be valid, and coordinates finite. */
tl_status tl_convex_parts_make(const tl_solid_surface *surface, tl_convex_parts *parts, tl_error *error);
void tl_convex_parts_free(tl_convex_parts *parts);

#endif
