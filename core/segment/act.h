/* act.h - segments follow their sides, and push them apart by the laws of their joints. */
#ifndef TL_SEGMENT_ACT_H
#define TL_SEGMENT_ACT_H

#include "base/inline.h"
#include "base/parallel.h"
#include "model/contributor.h"
#include "segment/segments.h"

/* Makes room for a step. */
tl_status tl_segments_prepare(tl_model *m);
/* Finds the forces of all segments at the present places. */
tl_status tl_segments_apply(tl_model *m, tl_failure *failure);
/* Adds what they do to a gridpoint: the components, and the sum of the sizes. */
TL_INLINE void tl_segments_gather(const struct tl_segments *s, size_t gridpoint, double *restrict sum)
{
    for (uint32_t k = s->use_start[gridpoint]; k < s->use_start[gridpoint + 1]; k++) {
        const tl_segment_use *use = &s->use[k];
        const double *restrict push = s->table.push[use->segment].of[use->side][use->corner];
#pragma omp simd
        for (size_t c = 0; c < 4; c++)
            sum[c] += push[c];
    }
}
/* Adds what they do to a body. */
void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on);
/* Adds how stiff they hold the gridpoints, N/m, and a body. */
void tl_segments_stiffen(tl_model *m);
void tl_segments_hold(const tl_model *m, uint32_t body, tl_holding *sum);
/* What they store, and the heat of this step. */
tl_energies tl_segments_energies(tl_model *m);

#endif
