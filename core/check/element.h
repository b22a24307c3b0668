/* element.h - the conformance check of elements. */
#ifndef TL_CHECK_ELEMENT_H
#define TL_CHECK_ELEMENT_H

#include "check/checker.h"

extern const tl_check_type tl_check_elements;

#endif
