/* twice.c - two parameters that answer to one name. */
#include "plain.h"

static const tl_param param_table[] = {
    PLAIN_VALUE,
    TL_PARAM(TL_PARAM_REAL, params, value, "Pa", "some value", .alias = "other", .def = {1}, .min = 0, .max = 2),
};
static const tl_law_ops ops = PLAIN_OPS;
static const tl_kind kind = PLAIN_KIND("twice", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.twice");
