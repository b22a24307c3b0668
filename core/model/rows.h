/* rows.h - rows of blocks and bodies: making room, keeping them in order, measuring what is in them. */
#ifndef TL_MODEL_ROWS_H
#define TL_MODEL_ROWS_H

#include "geometry/measure.h"
#include "model/model.h"

/* Makes room for `count` blocks and as many bodies. */
bool tl_rows_reserve(tl_model *m, size_t count);
/* Derives the members of all bodies after rows have changed; the memory must have been reserved. Counts a change of
 * structure. */
void tl_rows_refresh(tl_model *m);
/* Takes out the rows of blocks that have been deleted, and bodies left without blocks; the shapes are the caller's. Who
 * goes through rows, and not from ids, calls this before. */
void tl_rows_tidy(tl_model *m);
/* Derives a body's mass, inertia and radius from its blocks. */
void tl_body_measure(tl_model *m, uint32_t body);
/* Measures a new block, which is a body of its own, and that body; the block becomes its member and counts among the
 * smallest. `mass`: its mass properties at density 1. */
void tl_block_came(tl_model *m, uint32_t row, tl_mass mass);

/* A block goes; all that is known of the smallest blocks. */
void tl_extremes_drop(tl_model *m, uint32_t row);
tl_extremes tl_extremes_of(tl_model *m);
/* The median of the sizes of the bodies that are not held, m; 0 of none. false: out of memory. */
bool tl_median_size(const tl_model *m, double *median);

/* TL_E_NUMERIC with a sentence when volume, mass or inertia of a block of this density cannot be computed with. */
tl_status tl_check_measures(tl_error *error, const tl_poly *shape, double density);

#endif
