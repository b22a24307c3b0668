/* stage_bodies.h - bodies of staged blocks. */
#ifndef TL_GENERATE_STAGE_BODIES_H
#define TL_GENERATE_STAGE_BODIES_H

#include "generate/staging.h"

/* Gives every body that needs it the numbers of the parts it falls into. */
tl_status tl_stage_settle(tl_stage *stage);

#endif
