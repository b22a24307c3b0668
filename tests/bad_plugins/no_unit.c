/* no_unit.c - a parameter without a unit. */
#include "plain.h"

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, value, NULL, "some value", .def = {1}, .min = 0, .max = 2),
};
static const tl_law_ops ops = PLAIN_OPS;
static const tl_kind kind = PLAIN_KIND("no_unit", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.no_unit");
