/* detect.h - contact detection: from block shapes and body places to contacts with contact points.
 *
 * A *pair* is two blocks whose inflated bounds overlap (broad.c). A pair near enough is a *contact*. It has one *facet*
 * (manifold.c): a *patch* of two flush faces, or a *field contact* of whatever else has a common volume. A facet has
 * *contact points*, each with an area. Contacts persist: while nothing has moved more than a margin, only the gaps are
 * computed anew (follow.c). */
#ifndef TL_DETECT_DETECT_H
#define TL_DETECT_DETECT_H

#include "contact/detection.h"
#include "model/model.h"

/* Brings pairs, contacts and gaps up to the present places of the bodies: the first half of a step. */
tl_status tl_detect_update(tl_model *m);
/* Finds the contacts of a model whose blocks or laws have changed since the last step, for queries and
 * settings between steps. Contacts that stand are not touched, so asking never changes a result. */
tl_status tl_detect_refresh(tl_model *m);

#endif
