/* walk.h - the entries of a detection, and whether they fit together (sound.c). */
#ifndef TL_CONTACT_WALK_H
#define TL_CONTACT_WALK_H

#include "base/walk.h"
#include "contact/detection.h"

/* Visits what a detection keeps. The scratch of its threads is not among it. */
void tl_detect_walk(tl_detect *d, const tl_walk *walk);

#endif
