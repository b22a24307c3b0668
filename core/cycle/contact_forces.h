/* contact_forces.h - contacts act on bodies. */
#ifndef TL_CYCLE_CONTACT_FORCES_H
#define TL_CYCLE_CONTACT_FORCES_H

#include "model/contributor.h"

/* By the laws of their joints. */
extern const tl_contributor tl_contacts_act;

/* Adds the damping of contacts to the damping forces of bodies and gridpoints. */
void tl_contacts_damp(tl_model *m);

#endif
