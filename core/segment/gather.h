/* gather.h - what segments do to gridpoints and bodies, and how stiff they hold them. */
#ifndef TL_SEGMENT_GATHER_H
#define TL_SEGMENT_GATHER_H

#include "model/contributor.h"
#include "segment/segments.h"

/* Adds what they do to a body. */
void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on);
/* Adds their damping to that of the gridpoints, and of a body. */
void tl_segments_damp(tl_model *m);
void tl_segments_damp_body(const tl_model *m, uint32_t body, tl_vec3 *force, tl_vec3 *moment);
/* Adds how stiff they hold the gridpoints, N/m, and a body. */
void tl_segments_stiffen(tl_model *m);
void tl_segments_hold(const tl_model *m, uint32_t body, tl_holding *sum);
/* What they store, and the heat of this step. */
tl_energies tl_segments_energies(tl_model *m);

#endif
