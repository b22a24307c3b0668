/* held.h - contacts between bodies that are held still, which are left alone once they rest: held.c. */
#ifndef TL_CONTACT_HELD_H
#define TL_CONTACT_HELD_H

#include "contact/layout.h"
#include "model/model.h"

/* Whether the bodies of two blocks are held still. */
bool tl_blocks_held_still(const tl_model *m, uint32_t a, uint32_t b);
/* Notes which contacts are between bodies that are held still, and wakes their spans. */
void tl_held_sort(tl_model *m);
/* All such contacts are followed again, until they are found to rest. */
void tl_held_wake(tl_model *m);
/* After a step whose laws have not failed: which spans rest from now on. */
void tl_held_followed(tl_model *m);
/* Whether a span is passed over. */
static inline bool tl_span_rests(const tl_model *m, const tl_span *span)
{
    return span->rest == TL_SPAN_RESTS && m->config.reuse_geometry;
}

#endif
