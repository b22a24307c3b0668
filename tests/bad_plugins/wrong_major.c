/* wrong_major.c - built for another major version of the interface. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("wrong_major", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN_CLAIMS(sizeof(tl_plugin), TL_ABI_MAJOR + 1, TL_ABI_MINOR, "bad.wrong_major");
