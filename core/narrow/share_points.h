/* share_points.h - what a point share is made of: weighted points, and edges that cross. */
#ifndef TL_NARROW_SHARE_POINTS_H
#define TL_NARROW_SHARE_POINTS_H

#include "narrow/narrow.h"

/* A weight that depends on a tilt, and the couple on B that goes with it: its derivative against B's turn, over its
 * value, 1/rad. */
typedef struct tl_weight {
    double value;
    tl_vec3 swing;
} tl_weight;

static inline tl_weight tl_weight_product(tl_weight a, tl_weight b)
{
    return (tl_weight){a.value * b.value, tl_v3_add(a.swing, b.swing)};
}

/* A contact point to be: its facet without the points, its place, and its weight among the others. */
typedef struct tl_share_point {
    tl_facet facet;
    tl_vec3 p;
    tl_weight weight;
    /* of edges that cross: what a block that stands on a face beside them gets from them */
    tl_weight beside[4];
    uint64_t key;
} tl_share_point;

/* The points found so far. */
typedef struct tl_share_points {
    size_t count;    /* of room->share */
    tl_narrow *room; /* whose dots are a stand's */
    bool *seen[2];   /* which faces of A and of B the other block has been looked at standing on */
} tl_share_points;

/* A face on which a block stands, one of whose edges has been followed to the border: how nearly that lies in the face, and
 * how nearly the face's normal is that of both edges there. */
typedef struct tl_from {
    bool b_stands;
    uint32_t face;
    tl_weight lies, like;
} tl_from;

/* An edge in A's frame and its direction. */
typedef struct tl_line {
    tl_vec3 from, along, unit;
} tl_line;

/* An edge of A and one of B that touch along n, from A to B. */
typedef struct tl_crossing {
    uint32_t ia, ib;
    tl_line a, b;
    tl_vec3 n;
} tl_crossing;

#endif
