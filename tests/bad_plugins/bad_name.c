/* bad_name.c - a law whose name is not one. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("Bad Name", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.bad_name");
