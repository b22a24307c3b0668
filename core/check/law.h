/* law.h - the conformance check of contact laws. */
#ifndef TL_CHECK_LAW_H
#define TL_CHECK_LAW_H

#include "check/checker.h"

extern const tl_check_rule tl_check_law_rules[];
tl_status tl_check_law_kind(tl_checker *c);

#endif
