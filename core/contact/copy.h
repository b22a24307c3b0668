/* copy.h - a second detection in the same state (copy.c). */
#ifndef TL_CONTACT_COPY_H
#define TL_CONTACT_COPY_H

#include "contact/detection.h"

/* A second detection in the same state: copy.c. NULL when out of memory. */
tl_detect *tl_detect_copy(const tl_detect *from);

#endif
