/* energy.h - the energy ledger of the bodies that are free to move. */
#ifndef TL_CYCLE_ENERGY_H
#define TL_CYCLE_ENERGY_H

#include "cycle/cycle_data.h"

/* Twice the rotational energy of a body. */
double tl_spin_energy2(const tl_model *m, uint32_t body);
/* Kinetic energy of a body in the components that are not held. */
double tl_free_energy(const tl_model *m, uint32_t body);
/* Closes the ledger of a step, of which the move has booked what its bodies have and what is done to them. */
void tl_energy_close(tl_model *m);

#endif
