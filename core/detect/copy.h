/* copy.h - a second detection in the same state (copy.c). */
#ifndef TL_DETECT_COPY_H
#define TL_DETECT_COPY_H

#include "detect/detection.h"

/* A second detection in the same state: copy.c. NULL when out of memory. */
tl_detect *tl_detect_copy(const tl_detect *from);

#endif
