/* prepare.h - memory for what a step keeps of bodies and contacts. */
#ifndef TL_CYCLE_PREPARE_H
#define TL_CYCLE_PREPARE_H

#include "base/walk.h"
#include "cycle/cycle_data.h"

/* Sizes it for the bodies of the model. */
tl_status tl_cycle_prepare(tl_model *m);
/* Whether a body can move, or is held but moves. */
bool tl_model_moves(const tl_model *m);
/* Visits what it keeps. What a step may undo is no entry: no call ends within it. */
void tl_cycle_walk(struct tl_cycle *c, const tl_walk *walk);

#endif
