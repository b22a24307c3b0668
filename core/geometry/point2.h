/* point2.h - points of a plane by two coordinates, and convex polygons of them. */
#ifndef TL_GEOMETRY_POINT2_H
#define TL_GEOMETRY_POINT2_H

#include "base/inline.h"

#include <stddef.h>

typedef struct tl_point2 {
    double x, y;
} tl_point2;

static inline double tl_cross2(tl_point2 o, tl_point2 a, tl_point2 b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/* Square of the distance. */
static inline double tl_distance2(tl_point2 a, tl_point2 b)
{
    double x = a.x - b.x, y = a.y - b.y;
    return x * x + y * y;
}

static inline tl_point2 tl_from_to(tl_point2 a, tl_point2 b)
{
    return (tl_point2){b.x - a.x, b.y - a.y};
}

/* Where the line from p, at height h over another, to q, at height g, meets that. */
TL_INLINE tl_point2 tl_part_way(tl_point2 p, tl_point2 q, double h, double g)
{
    double t = h / (h - g);
    return (tl_point2){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

/* Keeps of a convex polygon what lies left of the line from o to q, in *out, which has room for twice as many corners.
 * Returns the number of corners. */
size_t tl_polygon_left(const tl_point2 *in, size_t count, tl_point2 o, tl_point2 q, tl_point2 *out);
/* Keeps of a convex polygon, counter-clockwise, what lies left of each side of another. That is given clockwise, as a
 * face is seen that looks at it. Returns the number of corners. `now` and `next` have room for as many as both have;
 * what is kept is in *now. */
size_t tl_polygon_common(tl_point2 **now, tl_point2 **next, size_t count, const tl_point2 *by, size_t sides);

#endif
