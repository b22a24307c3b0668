/* scratch.h - the memory that the geometry of a pair works in. */
#ifndef TL_NARROW_SCRATCH_H
#define TL_NARROW_SCRATCH_H

#include "narrow/narrow.h"

/* Frees what the scratch memory holds, not the struct. */
void tl_narrow_scratch_free(tl_narrow_scratch *scratch);

/* Makes room for `count` points more; false when out of memory. */
bool tl_manifold_reserve(tl_manifold *m, size_t count);
#endif
