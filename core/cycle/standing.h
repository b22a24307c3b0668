/* standing.h - how the model stands. */
#ifndef TL_CYCLE_STANDING_H
#define TL_CYCLE_STANDING_H

#include "model/model.h"

/* As of the last step; nothing changes. */
tl_standing tl_model_stands(tl_model *m);
/* The first block of the body that failed in the last solve, or TL_NO_ID. */
tl_id tl_model_failing(const tl_model *m);

#endif
