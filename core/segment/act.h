/* act.h - segments follow their sides, and push them apart by the laws of their joints. */
#ifndef TL_SEGMENT_ACT_H
#define TL_SEGMENT_ACT_H

#include "base/lanes.h"
#include "base/parallel.h"
#include "model/contributor.h"
#include "segment/segments.h"

/* Makes room for a step. */
tl_status tl_segments_prepare(tl_model *m);
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
/* Adds what they do to a body. */
void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on);
/* Adds how stiff they hold the gridpoints, N/m, and a body. */
void tl_segments_stiffen(tl_model *m);
void tl_segments_hold(const tl_model *m, uint32_t body, tl_holding *sum);
/* What they store, and the heat of this step. */
tl_energies tl_segments_energies(tl_model *m);

#endif
