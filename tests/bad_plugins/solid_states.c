/* solid_states.c - a solid with more columns of states than there may be. */
#include "plain_solid.h"

static const tl_state states[] = {
    TL_STATE(TL_STATE_TENSOR, "one", "", "some tensor"),
    TL_STATE(TL_STATE_TENSOR, "two", "", "some tensor"),
    TL_STATE(TL_STATE_TENSOR, "three", "", "some tensor"),
};

PLAIN_SOLID("solid_states", moduli, TL_KIND_STATES(states));
