/* preload.h - initial stress of segments. */
#ifndef TL_SEGMENT_PRELOAD_H
#define TL_SEGMENT_PRELOAD_H

#include "segment/segments.h"

/* Whether two faces are together: in the mean over their common area not farther apart than blocks in contact are.
 * What lies between others, as a wedge or a block in a gap, carries their stress. */
bool tl_meet_is_together(const tl_model *m, const tl_meet *meet);

/* Gives the points of a segment, which have initial forces, the traction of a stress; their closure counts from now. */
void tl_segment_preload(tl_model *m, uint32_t row, tl_sym3 (*stress)(const void *user, tl_vec3 place),
                        const void *user);

#endif
