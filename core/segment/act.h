/* act.h - segments follow their sides, and push them apart by the laws of their joints. */
#ifndef TL_SEGMENT_ACT_H
#define TL_SEGMENT_ACT_H

#include "base/parallel.h"
#include "model/contributor.h"
#include "segment/segments.h"

/* Finds the forces of all segments at the present places. */
tl_status tl_segments_apply(tl_model *m, tl_failure *failure);
/* Gives the points of a segment, which have initial forces, the traction of a stress; their closure counts from now. */
void tl_segment_preload(tl_model *m, uint32_t row, tl_sym3 (*stress)(const void *user, tl_vec3 place),
                        const void *user);
/* Adds what they do to a gridpoint, with the sum of the sizes, and to a body. */
void tl_segments_gather(const tl_model *m, uint32_t gridpoint, tl_vec3 *force, double *bears);
void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on);
/* Adds how stiff they hold the gridpoints, N/m, and a body. */
void tl_segments_stiffen(tl_model *m);
void tl_segments_hold(const tl_model *m, uint32_t body, tl_holding *sum);
/* What they store, and the heat of this step. */
tl_energies tl_segments_energies(tl_model *m);

#endif
