/* energy.h - the energy ledger of the bodies that are free to move. */
#ifndef TL_CYCLE_ENERGY_H
#define TL_CYCLE_ENERGY_H

#include "cycle/cycle_data.h"

/* Kinetic energy of a body, J, in the components that are not `held` (TL_FIX_*). */
double tl_body_energy(const tl_model *m, uint32_t body, unsigned held);
/* Closes the ledger of a step, of which the move has booked what its bodies have and what is done to them. */
void tl_energy_close(tl_model *m);
/* Notes how much of its error the rule balance of the time step has left. */
void tl_balance_note(tl_model *m);

#endif
