/* walk.h - the entries of segments. */
#ifndef TL_SEGMENT_WALK_H
#define TL_SEGMENT_WALK_H

#include "base/walk.h"
#include "segment/segments.h"

/* Visits what the segments of a model keep. */
void tl_segments_walk(struct tl_segments *s, const tl_walk *walk);

#endif
