/* solid_moduli.c - a solid without moduli. */
#include "plain_solid.h"

static const tl_param param_table[] = {TL_PARAM(TL_PARAM_REAL, params, value, "Pa", "some value", .def = {1})};

PLAIN_SOLID("solid_moduli", NULL, TL_KIND_PARAMS(params, param_table));
