/* uses.h - what segments act on. */
#ifndef TL_SEGMENT_USES_H
#define TL_SEGMENT_USES_H

#include "segment/segments.h"

/* Lists what segments touch, and what their meets tell them. There is room. */
void tl_segments_list_uses(const tl_model *m);
/* Makes room for the lists of so many segments, of the tables s. false: out of memory. */
bool tl_segments_uses_room(const tl_model *m, struct tl_segments *s, size_t segments);

#endif
