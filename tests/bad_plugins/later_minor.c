/* later_minor.c - a plugin that cannot do without a minor version that is not there yet. */
#include "plain_law.h"

#undef TL_ABI_MINOR
#define TL_ABI_MINOR 77u

static const tl_kind kind = PLAIN_KIND("later_minor", TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(77, kind, .id = "bad.later_minor", .version = "1", .doc = "A plugin for the loader's test.",
                .licence = "BSD-3-Clause");
