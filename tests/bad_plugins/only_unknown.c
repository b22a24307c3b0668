/* only_unknown.c - one kind, of a type that no host knows. */
#include "plain_law.h"

static const tl_kind kind = TL_KIND(23, ops, .name = "only_unknown", .doc = "A law for the loader's test.",
                                    TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.only_unknown");
