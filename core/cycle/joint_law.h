/* joint_law.h - setting the law of a joint. */
#ifndef TL_CYCLE_JOINT_LAW_H
#define TL_CYCLE_JOINT_LAW_H

#include "model/model.h"

#endif
