/* law_time.h - the time that passes for laws and solids in a step. */
#ifndef TL_MODEL_LAW_TIME_H
#define TL_MODEL_LAW_TIME_H

#include "model/model.h"

/* Time of a step of dt, s, for laws and solids: none in a relaxation, whose steps follow motion without time. */
static inline double tl_law_time(const tl_model *m, double dt)
{
    return m->relaxing ? 0 : dt;
}

#endif
