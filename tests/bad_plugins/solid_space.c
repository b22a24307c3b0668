/* solid_space.c - a solid with a list of points in space. */
#include "plain_solid.h"

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, table, "m", "some points", .flags = TL_PARAM_OPTIONAL),
};

PLAIN_SOLID("solid_space", moduli, TL_KIND_PARAMS(params, param_table));
