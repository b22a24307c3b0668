/* beside.h - pairs that touch without area (beside.c). */
#ifndef TL_DETECT_BESIDE_H
#define TL_DETECT_BESIDE_H

#include "contact/pair.h"
#include "narrow/view.h"

/* Chooses the faces that show it. */
void tl_beside_note(const tl_pair_view *view, tl_pair *p);
/* Whether neither of the two faces is overlapped, so that the pair has nothing in common under any rule. */
bool tl_beside_only_touches(const tl_pair_view *view, const tl_pair *p);
/* How far the pair may move before it may carry more than goes unseen, or is as near as a contact; negative when it
 * may do so now. `gap` gets the larger one of the two faces. */
double tl_beside_margin(const tl_pair_view *view, const tl_pair *p, double *gap);

#endif
