/* element_forces.h - elements act on bodies: a contributor of a step. */
#ifndef TL_CYCLE_ELEMENT_FORCES_H
#define TL_CYCLE_ELEMENT_FORCES_H

#include "model/contributor.h"

extern const tl_contributor tl_elements_act;

#endif
