/* manifold.h - what touches: from a pair's axis to facets with contact points (manifold.c). */
#ifndef TL_NARROW_MANIFOLD_H
#define TL_NARROW_MANIFOLD_H

#include "narrow/axis.h"

/* Square of the sine of the tilt of two faces up to which they are flush: of FLUSH_NONE in manifold.c. */
#define TL_FLUSH_TILT2 7.6152421804e-5

/* Facets and points of a pair whose axis is known, into room->manifold. */
void tl_manifold_build(const tl_pair_view *view, const tl_axis *axis, const tl_share_rule *rule,
                       tl_narrow *room);
/* Lays the patch of two faces that lie flush on each other, where nothing else touches; false, when they do
 * not. */
bool tl_manifold_renew(const tl_pair_view *view, uint32_t fa, uint32_t fb,
                       const tl_share_rule *rule, tl_narrow *room);
/* The joint of the touching faces. */
tl_tag tl_touching_tag(const tl_pair_view *view, tl_vec3 n);

#endif
