/* many_states.c - a law whose states take nine columns: three tangents of three. */
#include "plain_law.h"

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_TANGENT, "one", "m", "some vector"),
    TL_STATE(TL_STATE_TANGENT, "two", "m", "some vector"),
    TL_STATE(TL_STATE_TANGENT, "three", "m", "some vector"),
};
static const tl_kind kind = PLAIN_KIND("many_states", TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

PLAIN_PLUGIN("bad.many_states");
