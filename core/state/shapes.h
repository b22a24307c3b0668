/* shapes.h - the polyhedra of the blocks. */
#ifndef TL_STATE_SHAPES_H
#define TL_STATE_SHAPES_H

#include "state/part.h"

/* Each is looked at when it is read: it is closed and convex. */
extern const tl_state_part tl_shapes_part;

#endif
