/* blend.h - from segments to field contacts, while faces tilt. */
#ifndef TL_SEGMENT_BLEND_H
#define TL_SEGMENT_BLEND_H

#include "segment/segments.h"

/* Finds how pairs of faces are tilted, and which blocks meet by a field contact, too. There is room for as many as
 * meets. Whether other blocks than before meet by segments alone. */
bool tl_blends_find(tl_model *m);
/* Gives field contacts their shares of forces and energies. */
void tl_blends_share(tl_model *m);
/* Leaves segments, whose forces are known, the rest, and adds the couples by which the shares change. */
void tl_blends_apply(tl_model *m);

#endif
