/* element_strength.h - see element_strength.c. */
#ifndef TL_CYCLE_ELEMENT_STRENGTH_H
#define TL_CYCLE_ELEMENT_STRENGTH_H

#include "model/model.h"

/* Gives the elements of a copy of the model `from` the strengths that they have there, divided by `factor`. Forces stay
 * as they are; the next step brings them down to the strengths. */
tl_status tl_elements_weaken(tl_model *m, const tl_model *from, double factor);
/* How far elements let bodies go that they bear, m: the force of elements on a body over the stiffness of these and of
 * its joints, the mean over the bodies by that force. What holds no energy, as water, does not give.
 * False for want of memory. */
bool tl_elements_settlement(const tl_model *m, double *settles);
/* Whether some element has a strength. */
bool tl_elements_have_strength(const tl_model *m);

#endif
