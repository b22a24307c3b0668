/* solid_axis.c - a solid whose axis does not begin at 0. */
#include "plain_solid.h"

static const tl_state states[] = {TL_STATE(TL_STATE_AXIS, "axis", "", "some vector", .initial = 1)};

PLAIN_SOLID("solid_axis", moduli, TL_KIND_STATES(states));
