/* pairs.h - pairs without a contact. */
#ifndef TL_DETECT_PAIRS_H
#define TL_DETECT_PAIRS_H

#include "contact/detection.h"
#include "model/model.h"
#include "narrow/manifold.h"

/* Reserves what is kept of the blocks and bodies of the model; their path lengths begin at 0. */
tl_status tl_pairs_restart(tl_model *m);
/* Notes how far each block can have moved since the broad phase was made. */
void tl_pairs_measure_paths(tl_model *m);
/* Tests the pairs without a contact that may have come near: chunks and pairs tell which were found. */
void tl_pairs_test(tl_model *m);
/* What is known of a placed pair before its contact is made: that it holds across a gap, if it takes over from one. */
tl_manifold_before tl_pair_before(const tl_model *m, const tl_pair *pair, const tl_pair_view *view,
                                  tl_narrow_scratch *scratch);
/* Lets a pair sleep until its blocks, together, have moved `way` more. */
void tl_pair_sleep(tl_detect *d, tl_pair *pair, double way);
/* The wake of a pair, without a contact, whose blocks' path lengths are to begin anew. */
void tl_pair_rebase(const tl_detect *d, tl_pair *pair);
/* Forgets what shows that a pair touches without area; without a contact it is tested again. */
void tl_pair_wake(tl_detect *d, uint32_t pair);
/* Notes that a pair has lost its contact. */
void tl_pair_parted(tl_detect *d, uint32_t pair);

#endif
