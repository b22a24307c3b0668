/* follow.h - segments follow the rows of gridpoints and bodies. */
#ifndef TL_SEGMENT_FOLLOW_H
#define TL_SEGMENT_FOLLOW_H

#include "segment/segments.h"

/* Finds the rows of the sides of all segments anew where rows have moved, and forgets segments of blocks that have
 * gone. There are segments, rows are tidy, and zones have followed. */
void tl_segments_follow(tl_model *m);

#endif
