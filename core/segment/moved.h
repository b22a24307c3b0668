/* moved.h - how the walls of a segment have moved along each other. */
#ifndef TL_SEGMENT_MOVED_H
#define TL_SEGMENT_MOVED_H

#include "segment/segments.h"

/* How far B has moved along A in the last motion, at a point of a segment: without the spin of both, as laws get it, m.
 * `at_a`, `at_b`: what keeps to the material. `n`: the normal now. `share`: that of the outline that is B's. */
tl_vec3 tl_segment_moved(const tl_model *m, const tl_segment *of, double share, tl_vec3 n, tl_vec3 at_a, tl_vec3 at_b);

#endif
