/* uses.h - which segments act on a gridpoint, and which on a body. */
#ifndef TL_SEGMENT_USES_H
#define TL_SEGMENT_USES_H

#include "segment/segments.h"

/* Makes room for the lists of so many segments. false: out of memory. */
bool tl_segment_uses_room(const tl_model *m, struct tl_segments *s, size_t segments);
/* Lists what segments touch, and what their meets tell them. There is room. */
void tl_segment_uses_list(const tl_model *m, struct tl_segments *s);
/* Both, of the segments that there are. false: out of memory. */
bool tl_segments_index(tl_model *m);

#endif
