/* contributors.h - what acts on the bodies of a model. */
#ifndef TL_CYCLE_CONTRIBUTORS_H
#define TL_CYCLE_CONTRIBUTORS_H

#include "cycle/cycle_data.h"

/* Gives a new cycle the contributors that every model has. */
void tl_contributors_begin(struct tl_cycle *cycle);
/* Adds zones and elements where there are any, and takes them off where there are none. */
void tl_contributors_list(tl_model *m);
/* The stiffness with which all of them hold a body where it is, N/m. */
double tl_body_stiffness(const tl_model *m, uint32_t body);
/* Force, N, and moment about its centroid, N m, of all of them but the contacts on a body in the last step; 0 where
 * blocks have changed since. */
tl_wrench tl_body_pushed(const tl_model *m, uint32_t body);

#endif
