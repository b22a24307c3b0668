/* remarks.h - what is legal and yet improbable. */
#ifndef TL_CYCLE_REMARKS_H
#define TL_CYCLE_REMARKS_H

#include "cycle/cycle_data.h"

/* Looks at gravity, densities and stiffnesses when they have changed. */
void tl_remark_units(tl_model *m);
/* Looks now and then at closures under load. */
void tl_remark_closure(tl_model *m);

#endif
