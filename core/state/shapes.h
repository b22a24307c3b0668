/* shapes.h - the polyhedra of the blocks in an archive. */
#ifndef TL_STATE_SHAPES_H
#define TL_STATE_SHAPES_H

#include "model/model.h"
#include "state/archive.h"

/* Adds the polyhedra of all blocks; false when out of memory. */
bool tl_shapes_save(const tl_model *m, tl_archive_writer *w);
/* Gives the blocks their polyhedra, after looking at each: it is closed and convex. */
tl_status tl_shapes_restore(tl_model *m, const tl_archive *archive);

#endif
