/* surface.h - the surface on which two blocks press each other, as convex polygons: for pictures and files. */
#ifndef TL_NARROW_SURFACE_H
#define TL_NARROW_SURFACE_H

#include "narrow/press.h"
#include "narrow/region.h"
#include "narrow/view.h"

/* Polygons in A's frame, counter-clockwise seen against the normal from A to B. Zero at first. */
typedef struct tl_surface {
    tl_vec3 *corner;
    uint32_t *size; /* [polygons] corners of each */
    size_t corners, polygons, corner_capacity, polygon_capacity;
} tl_surface;

/* Adds the common polygon of two faces, halfway between them. false: out of memory, as below. */
bool tl_surface_add_patch(const tl_pair_view *view, uint32_t face_a, uint32_t face_b,
                          tl_surface *surface);
/* Where two faces, of A and of B in A's frame, are that are moved out or lean (press.h). */
typedef struct tl_moved_faces {
    tl_face_pair faces;
    tl_plane plane[2];
} tl_moved_faces;

/* Adds the polygons on which the depths in both blocks are equal (field.h): one for each face of A and face of B that are the
 * nearest there. `moved`: NULL where none are. */
bool tl_surface_add_field(const tl_pair_view *view, const tl_region *region,
                          const tl_moved_faces *moved, tl_surface *surface);
void tl_surface_free(tl_surface *surface);

#endif
