/* act.h - segments follow their sides, and push them apart by the laws of their joints. */
#ifndef TL_SEGMENT_ACT_H
#define TL_SEGMENT_ACT_H

#include "base/lanes.h"
#include "base/parallel.h"
#include "model/contributor.h"
#include "segment/segments.h"

/* Makes room for a step in which segments are damped by beta over the last step; 0: not at all. */
tl_status tl_segments_prepare(tl_model *m, double damping_rate);
/* Finds the forces of all segments at the present places. */
tl_status tl_segments_apply(tl_model *m, tl_failure *failure);
/* What they do to a gridpoint: the components, and the sum of the sizes. */
TL_INLINE void tl_segments_gather(const struct tl_segments *s, size_t gridpoint, double *restrict sum)
{
    tl_four all = {0, 0, 0, 0};
    for (uint32_t k = s->use_start[gridpoint]; k < s->use_start[gridpoint + 1]; k++) {
        const tl_segment_use *use = &s->use[k];
        all += *(const tl_four *)s->table.push[use->segment].of[use->side][use->corner];
    }
    *(tl_four *)sum = all;
}
#endif
