/* overlap.h - blocks that overlap so deeply that no contact can tell how to part them. */
#ifndef TL_DETECT_OVERLAP_H
#define TL_DETECT_OVERLAP_H

#include "contact/tables.h"
#include "model/model.h"
#include "narrow/region.h"

/* Tolerance: overlap over the smaller block's size up to which nothing is measured, as for most contacts. The user is
 * told of a new contact beyond it: blocks that were placed into each other, or that a step has thrown into each other.
 * Test: lua/test_limits. */
#define TL_SHALLOW 0.01

/* Whether two blocks overlap so deeply that their contact cannot tell how to part them; less if it is just born. */
bool tl_overlap_is_deep(const tl_model *m, const tl_pair_view *view, const tl_region *region, uint32_t a, uint32_t b,
                        bool born);
/* Whether one block lies wholly inside the other: no face of it is crossed, so nothing presses. */
bool tl_overlap_is_whole(const tl_pair_view *view, const tl_region *region);
/* Marks a contact whose blocks do, so that its faces are listed whenever it is looked at. */
void tl_overlap_mark(tl_contacts *contacts, uint32_t contact, bool born);
/* How far a contact's blocks overlap along the face along which they do so the least, m. The thickness, m, is the
 * extent of the thinner body along its normal; `thinner`: a row of its blocks. */
typedef struct tl_overlap_share {
    double overlap, thickness;
    uint32_t thinner;
} tl_overlap_share;

/* false: out of memory. */
bool tl_overlap_measure(tl_model *m, uint32_t contact, tl_overlap_share *out);
/* After a step's contacts have been settled: the sentence of the first that is marked and can move. */
tl_status tl_overlaps_check(tl_model *m);

#endif
