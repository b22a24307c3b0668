/* undo.h - a step that a law or the damping fails is undone. */
#ifndef TL_CYCLE_UNDO_H
#define TL_CYCLE_UNDO_H

#include "cycle/cycle_data.h"

/* Tolerance: stiffnesses, forces, gravity and squares of speeds below this make finite forces, in any units: products
 * of five of them are still doubles. */
#define TL_UNDO_TAME 1e60

/* What a step may have to undo. It begins with each step, ... */
tl_status tl_undo_begin(tl_model *m);
/* ... gets room, before laws change anything, where something may fail, as where a block may pass another, ... */
tl_status tl_undo_reserve(tl_model *m);
/* ... keeps what contributors and gather overwrite (rows of a contributor's table, on any thread, or with `back` back;
 * the bodies), ... */
void tl_undo_rows(tl_model *m, const tl_table *table, size_t first, size_t count, bool back);
void tl_undo_keep_bodies(tl_model *m);
/* ... and puts it back after a failure, or ends with the step. What is not kept is lost: no step is made after that. */
void tl_undo_step(tl_model *m);
void tl_undo_end(tl_model *m);
/* Whether this step is kept, so that it may be undone. */
bool tl_undo_keeps(const tl_model *m);
/* Whether something was set since the last step that was made, after which numbers may be any. */
bool tl_set_by_hand(const tl_model *m);
/* Forces were set by hand: they may be anything. */
void tl_undo_by_hand(tl_model *m);
/* Whether a step failed and could not be taken back. */
bool tl_undo_lost(const struct tl_cycle *c);
size_t tl_undo_bytes(const struct tl_cycle *c);
void tl_undo_free(struct tl_undo *undo);

#endif
