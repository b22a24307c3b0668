/* overlay.h - the polygon that two faces have in common, and three points that integrate over it. */
#ifndef TL_NARROW_OVERLAY_H
#define TL_NARROW_OVERLAY_H

#include "geometry/point2.h"

#include <stdbool.h>
#include <stddef.h>
#include <talus/vmath.h>

/* Corners of a face, counter-clockwise as seen from outside its block. */
typedef struct tl_outer_face {
    const tl_vec3 *corner;
    size_t count;
} tl_outer_face;

/* What the common polygon stands for: its area, and the normal from A to B along which it was found. The places of its
 * three points are on the planes of A's face and of B's. Its outline is in y, x = c + L y; the room has it until it is
 * used again. */
typedef struct tl_overlay {
    double area;
    tl_vec3 n, on_a[3], on_b[3];
    const tl_point2 *outline;
    size_t corners;
} tl_overlay;

/* Room for two polygons of as many corners as both faces have, and for one of those of the second. */
typedef struct tl_overlay_room {
    tl_point2 *now, *next, *by;
    size_t capacity; /* of each */
} tl_overlay_room;

/* Lays two faces over each other. `share`: 1 where the outline of what they have in common is B's, 0 where it is A's.
 * false: they face the same way, or have no area in common. */
bool tl_overlay_find(const tl_outer_face *a, const tl_outer_face *b, double share, tl_overlay_room *room,
                     tl_overlay *out);

#endif
