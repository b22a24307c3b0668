/* damping.h - the conformance check of dampings. */
#ifndef TL_CHECK_DAMPING_H
#define TL_CHECK_DAMPING_H

#include "check/checker.h"

extern const tl_check_type tl_check_dampings;

#endif
