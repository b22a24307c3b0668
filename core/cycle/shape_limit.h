/* shape_limit.h - no block bends so far that contact by its edges and corners no longer knows where they are. */
#ifndef TL_CYCLE_SHAPE_LIMIT_H
#define TL_CYCLE_SHAPE_LIMIT_H

#include "model/model.h"

/* Fails when a deformable block that may touch others by edges or corners has bent too far. Measured is how far it
 * departs from its shape as made, turned and strained as a whole. Nothing has moved yet. */
tl_status tl_shapes_check(tl_model *m);

#endif
