/* outside.c - a parameter that lies outside its struct. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("outside", .params_size = sizeof(params) - 1, .params = param_table,
                                       .param_count = 1, .param_stride = sizeof *param_table);

PLAIN_PLUGIN("bad.outside");
