/* zone_weight.h - the weights by which points on one circle or sphere make one choice of triangles or zones. */
#ifndef TL_GEOMETRY_ZONE_WEIGHT_H
#define TL_GEOMETRY_ZONE_WEIGHT_H

#include <math.h>
#include <stdbool.h>

/* Tolerance: the greatest weight of points inside faces and inside the block, as a part of the square of the wanted
 * edge. Roundings of the grid are smaller by far, so points on one sphere make no flat zone. */
#define TL_ZONE_LIGHT 1e-4
/* Tolerance: that of corners and points on edges. These may lie close together, so it is also limited as a part of the
 * square of the shortest part of an edge. It decides only among such points. */
#define TL_ZONE_LIGHTER 1e-6
#define TL_ZONE_HIDES_NONE 0.05

/* The weight of a point with a chance from 0 to 1, in the unit of the lengths. */
static inline double tl_zone_weight(bool on_edge, double size, double shortest, double chance)
{
    const double wanted = (on_edge ? TL_ZONE_LIGHTER : TL_ZONE_LIGHT) * size * size;
    const double most = on_edge ? TL_ZONE_HIDES_NONE * shortest * shortest : wanted;
    return floor((wanted < most ? wanted : most) * chance);
}

#endif
