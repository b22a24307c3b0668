/* element_forces.h - elements act on bodies: a contributor of a step. */
#ifndef TL_CYCLE_ELEMENT_FORCES_H
#define TL_CYCLE_ELEMENT_FORCES_H

#include "model/contributor.h"

extern const tl_contributor tl_elements_act;

/* The force of all nodes on each body in the last step, force[rows of bodies], N; 0 where nodes have no body yet. */
void tl_elements_pull(const tl_model *m, tl_vec3 *force);

#endif
