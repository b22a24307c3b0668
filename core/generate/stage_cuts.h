/* stage_cuts.h - blocks that cannot be cut. */
#ifndef TL_GENERATE_STAGE_CUTS_H
#define TL_GENERATE_STAGE_CUTS_H

#include "generate/stage.h"

/* TL_E_STATE where a block has been cut that turns by a drive, or that has zones. */
tl_status tl_stage_check_cuts(const tl_stage *stage);

#endif
