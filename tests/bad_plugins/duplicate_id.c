/* duplicate_id.c - has the id of a plugin that is loaded. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("duplicate_id", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("talus.coulomb");
