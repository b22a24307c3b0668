/* patch.h - the contact points of two faces on each other. */
#ifndef TL_NARROW_PATCH_H
#define TL_NARROW_PATCH_H

#include "narrow/narrow.h"
#include "narrow/view.h"

/* The points of face `fa` of A on face `fb` of B, into scratch->patch; returns their area, 0 for none. */
double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, const tl_touch_rule *rule,
                    tl_narrow_scratch *scratch);
/* The same with its facet into scratch->manifold. */
double tl_patch_add(const tl_pair_view *view, uint32_t fa, uint32_t fb, const tl_touch_rule *rule,
                    tl_narrow_scratch *scratch);

#endif
