/* batch.h - a share of the elements as their kind sees it. */
#ifndef TL_ELEMENT_BATCH_H
#define TL_ELEMENT_BATCH_H

#include "element/elements.h"
#include "model/law_time.h"

/* Cost only: so many nodes have room. Columns of 4096 bytes would all fall into the same lines of the cache. */
#define TL_LANES_ROOM (TL_ELEMENT_NODES + 24)

/* Columns of a chunk that are found anew in each step. */
typedef struct tl_element_lanes {
    double *du[3], *v[3], *normal[3];
    double own[9][TL_LANES_ROOM];                                  /* for these, but of an element with more nodes */
    uint32_t start[TL_ELEMENT_NODES + 1], flags[TL_ELEMENT_NODES]; /* flags: as they were */
    double *state[TL_ELEMENT_COLUMNS], *element_state[TL_ELEMENT_COLUMNS];
} tl_element_lanes;

/* A batch whose du, v and normal are still to be found; u is what it was in the last step. */
tl_element_batch tl_element_batch_of(const tl_model *m, const tl_element_chunk *of, tl_element_lanes *lanes);
/* Makes du, v and normal of a batch 0: nothing moves. */
void tl_element_lanes_stop(tl_element_lanes *lanes, size_t nodes);

#endif
