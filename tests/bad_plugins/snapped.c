/* snapped.c - the size of its descriptor was never set. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("snapped", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN_CLAIMS(0, TL_ABI_MAJOR, TL_ABI_MINOR, "bad.snapped");
