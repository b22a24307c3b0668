/* corner.h - corners and points in the plane of a patch, and the keys of what made them. */
#ifndef TL_NARROW_CORNER_H
#define TL_NARROW_CORNER_H

#include "geometry/point2.h"

#include <stdbool.h>
#include <stdint.h>

/* Tolerance: corners nearer to each other than this times the size are one. Corners nearer to a line that clips lie on
 * it, and a polygon as thin as that has no area worth a point. It is far below any length that matters, far above
 * rounding. Edges along each other would otherwise cross here and there, and points come and go. */
#define TL_MERGE 1e-7

/* Edges of A's face are 0, 1, ..., those of B's face TL_EDGE_B, TL_EDGE_B + 1, ... */
enum { TL_EDGE_B = 1 << 16 };
/* What a point is; with the features that made it, this gives its key. */
enum { TL_POINT_A, TL_POINT_B, TL_POINT_CROSSING, TL_POINT_MIDDLE, TL_POINT_CENTROID };

/* Different features of one contact have different keys: corners of A's face their numbers, then those of B's ... */
static inline uint32_t tl_corner_key(uint32_t kind, uint32_t corner)
{
    return kind == TL_POINT_A ? corner : corner | 1u << 16;
}

/* ... and what two features make a mixture of theirs: a multiplication or two must do. */
static inline uint32_t tl_key_of(uint32_t kind, uint32_t one, uint32_t other)
{
    uint64_t x = (kind + UINT64_C(0x9e3779b97f4a7c15) * one) ^ UINT64_C(0xd6e8feb86659fd93) * other;
    return (uint32_t)((x ^ x >> 32) * UINT64_C(0xd6e8feb86659fd93) >> 32);
}

/* Key of the centroid of a patch of two faces, its last point. */
static inline uint32_t tl_centroid_key(uint32_t face_a, uint32_t face_b)
{
    return tl_key_of(0, face_a, face_b) ^ tl_key_of(TL_POINT_CENTROID, 0, 0);
}

/* Whether a point lies on the line from o to q, or within `near` of it. */
TL_INLINE bool tl_on_line(tl_point2 o, tl_point2 q, tl_point2 at, double near)
{
    double height = tl_cross2(o, q, at);
    return height * height <= near * near * tl_distance2(o, q);
}

/* Whether two edges lie along each other: both ends of one on the line of the other. */
TL_INLINE bool tl_edges_coincide(tl_point2 from, tl_point2 to, tl_point2 o, tl_point2 q, double near)
{
    return (tl_on_line(o, q, from, near) && tl_on_line(o, q, to, near)) ||
           (tl_on_line(from, to, o, near) && tl_on_line(from, to, q, near));
}

/* Share of an edge of the common polygon by which it is B's. An edge of A that has one of B along it is half B's. */
static inline double tl_edge_ride(bool of_b, bool coincides)
{
    return coincides ? 0.5 : of_b;
}

typedef struct tl_corner {
    tl_point2 at;
    uint32_t key;  /* of the features that made it */
    uint32_t edge; /* source of the edge that leaves it */
    double height; /* over the line that cuts */
    double share;  /* of the corner in the mixture: 0 .. 1 */
    double fan;    /* area of the fan triangle of the edge that leaves it */
} tl_corner;

#endif
