/* generator.h - the conformance check of generators. */
#ifndef TL_CHECK_GENERATOR_H
#define TL_CHECK_GENERATOR_H

#include "check/checker.h"

extern const tl_check_rule tl_check_generator_rules[];
tl_status tl_check_generator_kind(tl_checker *c);

#endif
