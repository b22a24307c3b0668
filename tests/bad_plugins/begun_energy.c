/* begun_energy.c - a law whose energy of shear does not begin at 0. */
#include "plain_law.h"

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "some", "J", "some energy", .transfer = TL_TRANSFER_ENERGY, .initial = 1),
};
static const tl_kind kind =
    PLAIN_KIND("begun_energy", TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

PLAIN_PLUGIN("bad.begun_energy");
