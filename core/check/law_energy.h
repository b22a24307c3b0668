/* law_energy.h - paths of closure and shear. */
#ifndef TL_CHECK_LAW_ENERGY_H
#define TL_CHECK_LAW_ENERGY_H

#include "check/law_trial.h"

/* The work on paths of motion is stored or turned to heat, and closed ones give no energy. */
void tl_law_check_energy(tl_law_trial *t);

#endif
