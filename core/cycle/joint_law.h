/* joint_law.h - contacts that come under other laws with the groups of their blocks. */
#ifndef TL_CYCLE_JOINT_LAW_H
#define TL_CYCLE_JOINT_LAW_H

#include "model/model.h"

/* Lets contacts keep their forces when groups change, where laws name groups. */
void tl_laws_follow_groups(tl_model *m);

#endif
