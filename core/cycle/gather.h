/* gather.h - forces on bodies. */
#ifndef TL_CYCLE_GATHER_H
#define TL_CYCLE_GATHER_H

#include "cycle/cycle_data.h"

/* Makes room for the reactions on bodies that are held; before the gather. false: out of memory. */
bool tl_gather_prepare(tl_model *m);
/* Each body gathers its contacts in fixed order, and its weight; sums for the convergence measures. */
void tl_gather(tl_model *m);

#endif
