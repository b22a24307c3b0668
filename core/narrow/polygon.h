/* polygon.h - the common polygon of two faces in the plane of their patch. */
#ifndef TL_NARROW_POLYGON_H
#define TL_NARROW_POLYGON_H

#include "narrow/corner.h"
#include "narrow/narrow.h"

struct tl_patch_batch;

/* Room for one clipping. */
struct tl_polygon {
    tl_corner *now, *next;
    tl_point2 *face, *clip; /* outlines of A's and B's face, counter-clockwise */
    size_t capacity, face_capacity;
    struct tl_patch_batch *batch; /* patch_batch.c */
};

/* Room for faces of `na` and `nb` corners; NULL when out of memory. */
struct tl_polygon *tl_polygon_reserve(tl_narrow_scratch *capacity, size_t na, size_t nb);
/* Clips `face` by `clip`: into `now`, beginning with the corner whose edge has the lowest number; corners nearer
 * than `near` are one. Returns their number. */
size_t tl_polygon_clip(struct tl_polygon *p, uint32_t na, uint32_t nb, double near);
void tl_polygon_free(struct tl_polygon *polygon, tl_patch_points *points);

#endif
