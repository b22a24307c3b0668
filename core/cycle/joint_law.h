/* joint_law.h - contacts that come under other laws: with the groups of their blocks, and with strengths divided. */
#ifndef TL_CYCLE_JOINT_LAW_H
#define TL_CYCLE_JOINT_LAW_H

#include "model/model.h"

/* Lets contacts keep their forces when groups change, where laws name groups. */
void tl_laws_follow_groups(tl_model *m);
/* Gives a copy of the model `from` the laws that `from` has, with their strengths divided by `factor`: those that
 * `which` marks, by their rows. Forces stay as they are; the next step brings them down to the strengths. */
tl_status tl_joints_weaken(tl_model *m, const tl_model *from, const uint8_t *which, double factor);

#endif
