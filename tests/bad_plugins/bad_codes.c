/* bad_codes.c - a plugin whose id would clear a terminal. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("bad_codes", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.\x1b[2J\ncodes");
