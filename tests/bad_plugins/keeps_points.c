/* keeps_points.c - a damping with a list of points among its parameters, which lives only as long as the call that gives it. */
#include <talus/plugin.h>

typedef struct params {
    tl_points curve;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, curve, "m", "some points", .flags = TL_PARAM_OPTIONAL),
};

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static double step_factor(const void *self)
{
    (void)self;
    return 1;
}

static const tl_damping_ops ops = {.size = sizeof ops, .update = update, .step_factor = step_factor};
static const tl_kind kind = TL_KIND(TL_KIND_DAMPING, ops, .name = "keeps_points",
                                    .doc = "A damping for the loader's test.", TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "bad.keeps_points", .version = "1", .doc = "A plugin for the loader's test.",
          .licence = "BSD-3-Clause");
