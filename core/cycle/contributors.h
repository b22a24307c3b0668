/* contributors.h - each phase's question to all that acts on bodies. */
#ifndef TL_CYCLE_CONTRIBUTORS_H
#define TL_CYCLE_CONTRIBUTORS_H

#include "cycle/cycle_data.h"

/* Gives a new cycle the contributors that every model has. */
void tl_contributors_begin(struct tl_cycle *cycle);
/* The questions of model/contributor.h, to all of a model. */
tl_status tl_contributors_prepare(tl_model *m);
tl_status tl_contributors_apply(tl_model *m);
void tl_contributors_gather(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on);
double tl_body_stiffness(const tl_model *m, uint32_t body);
tl_holding tl_body_held(const tl_model *m, uint32_t body, bool points);
tl_holding tl_body_held_most(const tl_model *m, uint32_t body);
double tl_body_approach(const tl_model *m, uint32_t body);
tl_energies tl_contributors_energies(tl_model *m);

#endif
