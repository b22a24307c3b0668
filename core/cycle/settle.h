/* settle.h - how a relaxation brings the bodies of a step nearer to rest. */
#ifndef TL_CYCLE_SETTLE_H
#define TL_CYCLE_SETTLE_H

#include "model/model.h"

/* A relaxation begins, from rest. */
void tl_settle_begin(tl_model *m, int64_t load_steps);
/* At the end of a step: brings on the next part of the loads once the one before is borne. */
void tl_settle_loads(tl_model *m);
/* Whether the last step was made with all of them. */
bool tl_settle_bears_all(const tl_model *m);
/* Nothing moves any more, and steps, masses and rates are the user's again. */
void tl_settle_end(tl_model *m);
/* Room for a step; false: out of memory. */
bool tl_settle_prepare(tl_model *m);
/* What damps the bodies in this step. */
tl_status tl_settle(tl_model *m, double dt);
/* Damps a body so that it moves with the velocity and angular velocity wanted in this step, whatever kicks it. */
void tl_settle_move(tl_model *m, uint32_t body, tl_vec3 v, tl_vec3 w, double dt);

#endif
