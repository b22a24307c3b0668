/* screen.h - the conformance check of screens. */
#ifndef TL_CHECK_SCREEN_H
#define TL_CHECK_SCREEN_H

#include "check/checker.h"

extern const tl_check_rule tl_check_screen_rules[];
tl_status tl_check_screen_kind(tl_checker *c);

#endif
