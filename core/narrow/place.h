/* place.h - block B of a pair brought into A's frame. */
#ifndef TL_NARROW_PLACE_H
#define TL_NARROW_PLACE_H

#include "narrow/narrow.h"
#include "narrow/view.h"

/* Fills vertex_b and normal_b of views, until any are filled anew; false when out of memory. */
bool tl_pairs_place(tl_pair_view view[], uint32_t count, tl_narrow_scratch *scratch);
bool tl_pair_place(tl_pair_view *view, tl_narrow_scratch *scratch);

#endif
