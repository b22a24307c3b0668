/* halving.c - a damping that takes away what the unbalanced force would do in a step, and half of the motion: whatever
 * the masses are that the step uses. */
#include <talus/kit.h>

typedef struct params {
    int32_t own;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_BOOL, params, own, "", "whether it takes the masses for the bodies' own", .def = {0.0}),
};

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    const params *p = self;
    (void)report;
    const double *mass = p->own ? batch->mass : batch->moving_mass;
    const double *inertia = p->own ? batch->inertia : batch->moving_inertia;
    for (uint32_t i = 0; i < batch->count; i++)
        for (int k = 0; k < 3; k++) {
            batch->damping_force[k][i] = -batch->force[k][i] - 0.5 * mass[i] * batch->velocity[k][i] / batch->dt;
            batch->damping_moment[k][i] =
                -batch->moment[k][i] - 0.5 * inertia[i] * batch->angular_velocity[k][i] / batch->dt;
        }
    return TL_OK;
}

static const tl_damping_ops ops = TL_DAMPING_OPS(.step_factor = tl_step_factor_one);

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "halving", .doc = "A damping for the tests of the masses.",
            TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(9, kind, .id = "bad.halving", .version = "1", .doc = "A plugin for the tests of the masses.",
                .licence = "BSD-3-Clause");
