/* bad_default.c - a parameter whose default lies outside its own range. */
#include "plain.h"

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, value, "Pa", "some value", .def = {2}, .flags = TL_PARAM_MAX_OPEN, .min = 0,
             .max = 2),
};
static const tl_law_ops ops = PLAIN_OPS;
static const tl_kind kind = PLAIN_KIND("bad_default", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN("bad.bad_default");
