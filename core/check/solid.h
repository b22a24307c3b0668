#ifndef TL_CHECK_SOLID_H
#define TL_CHECK_SOLID_H

#include "check/checker.h"

/* The conformance check of solids. */
extern const tl_check_type tl_check_solids;

#endif
