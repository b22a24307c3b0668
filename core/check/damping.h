/* damping.h - the conformance check of dampings. */
#ifndef TL_CHECK_DAMPING_H
#define TL_CHECK_DAMPING_H

#include "check/checker.h"

extern const tl_check_rule tl_check_damping_rules[];
tl_status tl_check_damping_kind(tl_checker *c);

#endif
