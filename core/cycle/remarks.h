/* remarks.h - what is legal and yet improbable. */
#ifndef TL_CYCLE_REMARKS_H
#define TL_CYCLE_REMARKS_H

#include "cycle/cycle_data.h"

/* Looks at gravity, densities, stiffnesses and solids when they have changed. */
void tl_remark_units(tl_model *m);
/* Looks for an angle of friction that is rather a coefficient, or in radians. `of` begins the sentence. */
void tl_remark_friction(tl_model *m, const char *of, const tl_kind *kind, const void *params);
/* Looks now and then at closures under load. */
void tl_remark_closure(tl_model *m);
/* After the forces of the first step, before anything moves: says so when overlaps press with more than the weight. */
void tl_remark_overlaps(tl_model *m);

#endif
