/* solid_split.c - a solid with a state that goes with the area. */
#include "plain_solid.h"

static const tl_state states[] = {
    TL_STATE(TL_STATE_SCALAR, "heat", "J", "some energy", .transfer = TL_TRANSFER_SPLIT),
};

PLAIN_SOLID("solid_split", moduli, TL_KIND_STATES(states));
