/* staged.h - a staging set as tests use it: begun with the model's blocks in it, and cut by whole planes. */
#ifndef TALUS_TESTS_STAGED_H
#define TALUS_TESTS_STAGED_H

#include "generate/stage.h"

#include <math.h>

static inline tl_status stage_begin(tl_model *m, tl_stage *stage)
{
    tl_status status = tl_stage_begin_empty(m, stage);
    if (status == TL_OK && (status = tl_stage_open(stage)) != TL_OK)
        tl_stage_end(stage);
    return status;
}

static inline tl_status stage_cut(tl_stage *stage, tl_vec3 normal, tl_vec3 point, tl_tag tag, double persistence)
{
    size_t met = 0;
    const tl_fracture plane = tl_fracture_disc(normal, point, (double)INFINITY);
    return tl_stage_cut_fracture(stage, &plane, tag, persistence, &met);
}

#endif
