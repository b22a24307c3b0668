/* point2.c - what two convex polygons of a plane have in common (Sutherland and Hodgman 1974). */
#include "geometry/point2.h"

size_t tl_polygon_left(const tl_point2 *in, size_t count, tl_point2 o, tl_point2 q, tl_point2 *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        tl_point2 here = in[i], after = in[(i + 1) % count];
        double h = tl_cross2(o, q, here), a = tl_cross2(o, q, after);
        if (h >= 0)
            out[kept++] = here;
        if ((h > 0 && a < 0) || (h < 0 && a > 0))
            out[kept++] = tl_part_way(here, after, h, a);
    }
    return kept;
}

size_t tl_polygon_common(tl_point2 **now, tl_point2 **next, size_t count, const tl_point2 *by, size_t sides)
{
    for (size_t i = 0; i < sides && count; i++) {
        count = tl_polygon_left(*now, count, by[(i + 1) % sides], by[i], *next);
        tl_point2 *swap = *now;
        *now = *next;
        *next = swap;
    }
    return count;
}
