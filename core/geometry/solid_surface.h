/* solid_surface.h - the mesh of a solid from the faces of its surface. */
#ifndef TL_GEOMETRY_SOLID_SURFACE_H
#define TL_GEOMETRY_SOLID_SURFACE_H

#include "base/error.h"
#include "geometry/solid_mesh.h"

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
    double finer;  /* 0, or what TL_POLY_ON is divided by */
    bool whole;    /* refuse a solid that is not convex, with the edge at which it bends inward */
    tl_vec3 place; /* added to coordinates in messages */
} tl_solid_surface;

/* Makes the mesh of a closed surface as one piece, with coplanar faces of one tag made one. */
tl_status tl_solid_read(const tl_solid_surface *surface, tl_solid_mesh *m, tl_error *error);
/* Refuses shells turned inside out that are not inside. */
tl_status tl_solid_check_cavities(const tl_solid_mesh *m, tl_error *error);

#endif
