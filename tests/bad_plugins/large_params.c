/* large_params.c - a law whose struct of parameters is larger than any memory. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("large_params", .params_size = (size_t)100000000000, .params = param_table,
                                       .param_count = 1, .param_stride = sizeof *param_table);

PLAIN_PLUGIN("bad.large_params");
