/* stage_commit.h - a staging set becomes blocks of the model. */
#ifndef TL_GENERATE_STAGE_COMMIT_H
#define TL_GENERATE_STAGE_COMMIT_H

#include "generate/staging.h"

/* Makes the staging set the model's blocks; on failure the model is as before. Ends the stage. */
tl_status tl_stage_commit(tl_stage *stage);

#endif
