/* standing.h - how the model stands, and how far it settles (standing.c). */
#ifndef TL_CYCLE_STANDING_H
#define TL_CYCLE_STANDING_H

#include "model/model.h"

/* Number of blocks of the mean size across the free bodies. */
double tl_blocks_on_end(const tl_model *m);
/* How far the model may settle, m: the mean closure of its loaded contacts, weighted by their forces, times the blocks on end. */
double tl_settlement(const tl_model *m, double on_end);
/* Displacement that sudden weight may bring by no more than closing joints, m. */
double tl_closed_by_weight(const tl_model *m);
/* As of the last step; nothing changes. */
tl_standing tl_model_stands(tl_model *m);
/* The first block of the body that failed in the last solve, or TL_NO_ID. */
tl_id tl_model_failing(const tl_model *m);

#endif
