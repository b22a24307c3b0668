/* two_energies.c - a law with two energies of shear. */
#include "plain_law.h"

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "one", "J", "some energy", .transfer = TL_TRANSFER_ENERGY),
    TL_STATE(TL_STATE_SCALAR, "two", "J", "some energy", .transfer = TL_TRANSFER_ENERGY),
};
static const tl_kind kind =
    PLAIN_KIND("two_energies", TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

PLAIN_PLUGIN("bad.two_energies");
