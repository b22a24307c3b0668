/* grazing.h - grazing pairs, which touch without area. */
#ifndef TL_DETECT_GRAZING_H
#define TL_DETECT_GRAZING_H

#include "contact/pair.h"
#include "narrow/region.h"
#include "narrow/view.h"

/* Whether blocks have few enough faces to be looked at for grazing. */
bool tl_grazing_may_be(const tl_pair_view *view);
/* Chooses the two faces that show that a pair is grazing. With `lows`, which may be NULL, of those only under which the
 * other block reaches no deeper than where it grazes: there may be none, and the pair does not graze. */
void tl_grazing_choose_faces(const tl_pair_view *view, tl_pair *p, const tl_region_lows *lows);
/* Whether neither of the two faces is overlapped, so that the pair has nothing in common under any rule. */
bool tl_grazing_only_touches(const tl_pair_view *view, const tl_pair *p);
/* How far the pair may move before it may carry more than goes unseen, or is as near as a contact. Negative: it may do
 * so now. `gap` gets the larger one of the two faces. */
double tl_grazing_margin(const tl_pair_view *view, const tl_pair *p, double *gap);

#endif
