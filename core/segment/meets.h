/* meets.h - which faces may touch by segments, and the segments that they have. */
#ifndef TL_SEGMENT_MEETS_H
#define TL_SEGMENT_MEETS_H

#include "segment/segments.h"

/* Brings meets and their segments up to the present places. */
tl_status tl_segments_find(tl_model *m);

#endif
