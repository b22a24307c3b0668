/* line.h - nodes on a line through blocks. */
#ifndef TL_ELEMENT_LINE_H
#define TL_ELEMENT_LINE_H

#include "element/placing.h"

/* Lists them: p->line. */
tl_status tl_line_find(tl_placing *p, tl_vec3 from, tl_vec3 to, double spacing, size_t *count);

#endif
