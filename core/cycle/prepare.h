/* prepare.h - room for what a step keeps of bodies and contacts. */
#ifndef TL_CYCLE_PREPARE_H
#define TL_CYCLE_PREPARE_H

#include "cycle/cycle_data.h"
#include "force/laws.h"

/* Makes room for the model's bodies. */
tl_status tl_cycle_prepare(tl_model *m);
/* Makes room for the energies of the contacts. */
tl_status tl_laws_prepare(tl_model *m);
/* What the laws give this step, and what is kept before they overwrite it. */
tl_law_phase tl_law_phase_of(struct tl_cycle *c);

/* Whether a body can move, or is held but moves. */
bool tl_model_moves(const tl_model *m);

#endif
