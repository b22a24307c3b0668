/* solid_tangent.c - a solid with a state of a joint. */
#include "plain_solid.h"

static const tl_state states[] = {TL_STATE(TL_STATE_TANGENT, "slip", "m", "some vector")};

PLAIN_SOLID("solid_tangent", moduli, TL_KIND_STATES(states));
