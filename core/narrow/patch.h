/* patch.h - the contact points of two faces on each other (patch.c). */
#ifndef TL_NARROW_PATCH_H
#define TL_NARROW_PATCH_H

#include "narrow/narrow.h"
#include "narrow/view.h"

/* The points of face `fa` of A on face `fb` of B, into room->patch, with areas scaled by `weight`; returns the
 * scaled area (0 when they do not overlap). */
double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    const tl_share_rule *rule, tl_narrow *room);
/* Adds the patch of face `fa` of A on face `fb` of B, with areas scaled by `weight` and the facet's
 * `swing`; returns its scaled area (0 when they do not overlap). */
double tl_patch_add(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    tl_vec3 swing, const tl_share_rule *rule, tl_narrow *room);

#endif
