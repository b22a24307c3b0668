/* walk.h - the entries of elements. */
#ifndef TL_ELEMENT_WALK_H
#define TL_ELEMENT_WALK_H

#include "base/walk.h"
#include "element/elements.h"

/* Visits what the elements of a model keep, but for their sets. */
void tl_elements_walk(struct tl_elements *e, const tl_walk *walk);

#endif
