/* remarks.h - what is legal and yet improbable. */
#ifndef TL_CYCLE_REMARKS_H
#define TL_CYCLE_REMARKS_H

#include "cycle/cycle_data.h"

/* Remarks on numbers that are legal and improbable. Looks at gravity, densities and stiffnesses when they have changed.
 * Looks now and then at closures under load, and at the friction of a law that is set. */
void tl_remark_units(tl_model *m);
void tl_remark_closure(tl_model *m);
void tl_remark_friction(tl_model *m, const char *joint, const tl_law *law);

#endif
