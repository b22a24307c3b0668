/* later_major.c - built with the headers of a later major version, whose TL_PLUGIN refuses this one. */
#include "plain_law.h"

#undef TL_ABI_MAJOR
#define TL_ABI_MAJOR 3u

static const tl_kind kind = PLAIN_KIND("later_major", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.later_major");
