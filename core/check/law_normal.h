/* law_normal.h - the normal force, and what a law tells of it. */
#ifndef TL_CHECK_LAW_NORMAL_H
#define TL_CHECK_LAW_NORMAL_H

#include "check/law_points.h"

/* After a step from t->in to t->out: the normal force and the flags. */
void tl_law_check_normal(tl_law_trial *t, int step);

#endif
