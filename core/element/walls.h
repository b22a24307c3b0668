/* walls.h - the polygons in which a face of one block faces one of another. */
#ifndef TL_ELEMENT_WALLS_H
#define TL_ELEMENT_WALLS_H

#include "element/placing.h"

/* Lists them: p->wall. */
tl_status tl_walls_find(tl_placing *p, const tl_wall_filter *filter);

#endif
