/* closed.h - segments of which a part is closed and a part apart: their pressure integrated exactly. */
#ifndef TL_SEGMENT_CLOSED_H
#define TL_SEGMENT_CLOSED_H

#include "segment/segments.h"

/* What presses on a segment: closures that its points get, and how much more the exact ones are. `second`: the mean of
 * the square of what presses, less that of the points, m2. */
typedef struct tl_closed {
    double even[TL_SEGMENT_POINTS], rest[TL_SEGMENT_POINTS], second;
} tl_closed;

/* Of an outline (tl_overlay) over which the closure is linear, with those of the three points. false: it is closed as a
 * whole, or apart. */
bool tl_closed_part(const tl_point2 *outline, size_t corners, const double closure[TL_SEGMENT_POINTS], tl_closed *out);

#endif
