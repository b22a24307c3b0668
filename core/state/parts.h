/* parts.h - all parts of a model, in the order in which they are made; drives (drives.h) come after them. */
#ifndef TL_STATE_PARTS_H
#define TL_STATE_PARTS_H

#include "state/histories.h"
#include "state/kinds.h"
#include "state/outputs.h"
#include "state/shapes.h"

/* NULL ends the list. */
static const tl_state_part *const tl_state_parts[] = {
    &tl_shapes_part,   &tl_laws_part,    &tl_damping_part,   &tl_solids_part,
    &tl_elements_part, &tl_outputs_part, &tl_histories_part, NULL,
};

#endif
