/* name_clash.c - offers a law of a name that is taken. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("coulomb", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.name_clash");
