/* stage_commit.h - a staging set becomes blocks of the model. */
#ifndef TL_GENERATE_STAGE_COMMIT_H
#define TL_GENERATE_STAGE_COMMIT_H

#include "generate/staging.h"

/* Makes the staging set the model's blocks; on failure the model is as before. Ends the stage. */
tl_status tl_stage_commit(tl_stage *stage);

typedef struct tl_cut_load tl_cut_load;
typedef struct tl_cut_face tl_cut_face;

typedef struct tl_cut_loads {
    tl_cut_load *list;
    size_t count;
    tl_cut_face *faces; /* what is on faces of the bodies, by ascending row of their blocks */
    size_t face_count;
    uint32_t *of; /* [staged blocks] the load of the body that it comes from, or TL_NO_ROW */
} tl_cut_loads;

/* Takes the loads of the bodies that a stage has cut; false when out of memory (they are to be freed all the same). */

#endif
