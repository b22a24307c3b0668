/* place.h - block B of a pair brought into A's frame. */
#ifndef TL_NARROW_PLACE_H
#define TL_NARROW_PLACE_H

#include "narrow/narrow.h"
#include "narrow/view.h"

/* Fills vertex_b and normal_b of views, until any are filled anew; false when out of memory. */
bool tl_pairs_place(tl_pair_view view[], uint32_t count, tl_narrow_scratch *scratch);
bool tl_pair_place(tl_pair_view *view, tl_narrow_scratch *scratch);
/* The farthest that a vertex of either block has moved against the other block, since B was at a place. */
double tl_pair_moved(const tl_pair_view *view, const tl_pair_pose *since);
/* Fills them for one face of B only. */
bool tl_pair_place_face(tl_pair_view *view, uint32_t face, tl_narrow_scratch *scratch);

#endif
