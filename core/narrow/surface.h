/* surface.h - the surface on which two blocks press each other, as convex polygons: for pictures and files. */
#ifndef TL_NARROW_SURFACE_H
#define TL_NARROW_SURFACE_H

#include "narrow/press.h"

/* Polygons in A's frame, counter-clockwise seen against the normal from A to B. Zero at first; the
 * owner frees both lists. */
typedef struct tl_surface {
    tl_vec3 *corner;
    uint32_t *size; /* [polygons] corners of each */
    size_t corners, polygons, corner_capacity, polygon_capacity;
} tl_surface;

/* Adds the common polygon of two faces, halfway between them. false: out of memory, as below. */
bool tl_surface_add_patch(const tl_pair_view *view, uint32_t face_a, uint32_t face_b, tl_surface *surface);
/* Adds the polygons on which the depths in both blocks are equal (field.h), where their faces press. There is one for
 * each face of A and face of B that are the nearest there. */
bool tl_surface_add_field(const tl_press_query *query, tl_surface *surface);

#endif
