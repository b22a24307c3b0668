/* law.h - the conformance check of contact laws. */
#ifndef TL_CHECK_LAW_H
#define TL_CHECK_LAW_H

#include "check/checker.h"

extern const tl_check_type tl_check_laws;

#endif
