/* prepare.h - memory for what a step keeps of bodies and contacts. */
#ifndef TL_CYCLE_PREPARE_H
#define TL_CYCLE_PREPARE_H

#include "cycle/cycle_data.h"

/* Sizes it for the bodies of the model. */
tl_status tl_cycle_prepare(tl_model *m);
/* Whether a body can move, or is held but moves. */
bool tl_model_moves(const tl_model *m);

#endif
