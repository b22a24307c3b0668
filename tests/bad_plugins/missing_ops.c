/* missing_ops.c - a law without `stiffness`. */
#include "plain.h"

static const tl_param param_table[] = {PLAIN_VALUE};
static const tl_law_ops ops = {.size = sizeof ops, .update = update};
static const tl_kind kind = PLAIN_KIND("missing_ops", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.missing_ops");
