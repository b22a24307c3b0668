/* stand.h - what a point share is made of: weighted points, where edges cross (crossing.c) and where a block stands on a
 * face of the other one (stand.c). Internal to the point share; memory.c counts its room. */
#ifndef TL_DETECT_STAND_H
#define TL_DETECT_STAND_H

#include "detect/share.h"

/* Angle of the normals of two edges and of a face up to which an edge that lies in the face stands on it where it crosses
 * the border, and from which not at all: degrees. The normal of an edge that crosses aslant leans more than the edge
 * does; only that of one along the border leans far, and it may belong to the face beyond as well. The same of two faces
 * of a block, for an edge that goes on from one to the other. */
#define TL_LIKE_FULL 5.0
#define TL_LIKE_NONE 20.0

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

/* Adds a point, or of the same point the one of more weight; not, when memory is out. */
void tl_share_points_add(tl_share_points *found, tl_share_point point);

/* A face on which a block stands, one of whose edges has been followed to the border: how nearly that lies in the face, and
 * how nearly the face's normal is that of both edges there. */
typedef struct tl_from {
    bool b_stands;
    uint32_t face;
    tl_weight lies, like;
} tl_from;

/* ---------------------------------------------------------------- crossing.c ------------- */

/* An edge in A's frame and its direction. */
typedef struct tl_line {
    tl_vec3 from, along, unit;
} tl_line;

tl_line tl_line_of(const tl_edge *e, const tl_vec3 *vertex);

/* An edge of A and one of B that touch along n, from A to B. */
typedef struct tl_crossing {
    uint32_t ia, ib;
    tl_line a, b;
    tl_vec3 n;
} tl_crossing;

/* Adds the points at which an edge of A and one of B touch along n, with that weight among them: where they cross or, as
 * far as they are nearly parallel and do not lie in a face beside, the ends of their common stretch. As far as one goes on
 * from one face to the next, there are none: it stands on both farther off. */
void tl_crossing_add(const tl_pair_view *view, const tl_crossing *edges, tl_weight weight,
                     const tl_from *from, tl_share_points *found);

/* How nearly the normal n of two edges is that of a face beside one of them, which is A's or B's; `out` is the face's
 * normal, turned from A to B. */
tl_weight tl_crossing_likeness(bool of_a, tl_vec3 out, tl_vec3 n, const tl_line *a,
                               const tl_line *b);

/* ---------------------------------------------------------------- stand.c ---------------- */

/* Numbers among room->dots that a stand needs. */
size_t tl_stand_room(const tl_pair_view *view);

/* Adds the points at which a block stands on a face of the other, from its lowest vertex on. */
void tl_stand_on_face(const tl_pair_view *view, bool b_stands, uint32_t face,
                      tl_share_points *found);

/* The four faces beside two edges that cross. Each edge is the border of two, on which the other one's block may stand. */
typedef struct tl_sides {
    /* how nearly the face's normal is theirs, or that of the face they are come from: 0 unless the other edge may lie in it */
    tl_weight alike[4];
    tl_weight aside; /* how far neither lies in any of them: 1 not at all, 0 when one fully does */
    /* how far neither lies in both faces of a border, and goes over it as if they were one; in `from` it does */
    tl_weight stops;
} tl_sides;

tl_sides tl_stand_sides(const tl_pair_view *view, const tl_crossing *edges, const tl_from *from);

/* Whether the other block has been looked at standing on that face. */
bool tl_stand_seen(const tl_pair_view *view, const tl_share_point *crossing, int side,
                   const tl_share_points *found);

/* Adds the points at which it stands there, with that weight, on all but the crossing. */
void tl_stand_beside(const tl_pair_view *view, const tl_share_point *crossing, int side,
                     tl_share_points *found);

#endif
