/* copy.h - a second detection in the same state as the first (copy.c). */
#ifndef TL_STATE_COPY_H
#define TL_STATE_COPY_H

#include "contact/detection.h"

/* NULL when out of memory. */
tl_detect *tl_detect_copy(const tl_detect *from);

#endif
