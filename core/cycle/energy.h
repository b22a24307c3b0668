/* energy.h - the energy ledger of the bodies that are free to move. */
#ifndef TL_CYCLE_ENERGY_H
#define TL_CYCLE_ENERGY_H

#include "cycle/cycle_data.h"

/* Twice the rotational energy of a body. */
double tl_spin_energy2(const tl_model *m, uint32_t body);
/* What blocks that were made overlapping have pushed with: those that did the most, the energy that is no longer
 * stored, and what gravity and all else have done, J. Whether the first is more. */
typedef struct tl_overlap_push {
    tl_id a, b;
    double gave, others;
} tl_overlap_push;
bool tl_energy_pushed(const tl_model *m, tl_overlap_push *by);
/* The energy ledger: the move books what its bodies have and what is done to them, ... */
void tl_energy_begin(tl_model *m);
/* ... from number `first` of a chunk on, ... */
void tl_energy_book(const tl_model *m, const tl_body_group *g, size_t first, tl_work *work);
void tl_energy_book_held(const tl_model *m, uint32_t body, tl_vec3 moved, tl_vec3 turned, tl_work *work);
/* ... adds up the first `count` numbers of the chunk, ... */
void tl_energy_chunk(tl_model *m, unsigned thread, const tl_work *work, size_t count);
/* ... and the step closes it. */
void tl_energy_close(tl_model *m);

#endif
