/* endless_params.c - a law whose struct of parameters would take all memory there is, and one byte more is none. */
#include "plain_law.h"

static const tl_kind kind = PLAIN_KIND("endless_params", .params_size = (size_t)-1, .params = param_table,
                                       .param_count = 1, .param_stride = sizeof *param_table);

PLAIN_PLUGIN("bad.endless_params");
