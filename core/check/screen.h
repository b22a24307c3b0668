/* screen.h - the conformance check of screens. */
#ifndef TL_CHECK_SCREEN_H
#define TL_CHECK_SCREEN_H

#include "check/checker.h"

extern const tl_check_type tl_check_screens;

#endif
