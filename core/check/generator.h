/* generator.h - the conformance check of generators. */
#ifndef TL_CHECK_GENERATOR_H
#define TL_CHECK_GENERATOR_H

#include "check/checker.h"

extern const tl_check_type tl_check_generators;

#endif
