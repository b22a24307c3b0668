/* law_steps.h - shear of one direction, at a constant closure, leads to the same force whether it is made in a few steps or in many. */
#ifndef TL_CHECK_LAW_STEPS_H
#define TL_CHECK_LAW_STEPS_H

#include "check/law_trial.h"

/* The same path in steps of other lengths. */
void tl_law_check_steps(tl_law_trial *t);

#endif
