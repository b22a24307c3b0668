/* stand.h - points of a point share where a block stands on a face of the other one (stand.c). */
#ifndef TL_NARROW_STAND_H
#define TL_NARROW_STAND_H

#include "narrow/share_points.h"
#include "narrow/view.h"

/* Angle of the normals of two edges and of a face up to which an edge that lies in the face stands on it where it crosses
 * the border, and from which not at all: degrees. The normal of an edge that crosses aslant leans more than the edge
 * does; only that of one along the border leans far, and it may belong to the face beyond as well. The same of two faces
 * of a block, for an edge that goes on from one to the other. */
#define TL_LIKE_FULL 5.0
#define TL_LIKE_NONE 20.0

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
