/* viscous.c - damping "viscous": a constant coefficient alpha on velocities and angular velocities.
 *
 *     v' + alpha v = F / m,    w' + alpha w = M / I                              eqs (18), (20)
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125. The host integrates
 * it by the central difference (23), whose bound on the time step does not depend on alpha. Critical for
 * a mode of circular frequency omega: alpha = 2 omega. Terminal velocity under gravity: g / alpha. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    double alpha;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, alpha, "1/s", "damping coefficient", .flags = TL_PARAM_REQUIRED, .min = 0,
             .max = INFINITY),
};

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    for (uint32_t i = 0; i < batch->count; i++)
        batch->alpha[i] = p->alpha;
    return TL_OK;
}

static const tl_damping_ops ops = TL_DAMPING_OPS(.step_factor = tl_step_factor_one);

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "viscous", .doc = "Constant viscous damping of all velocities.",
            TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.viscous", .version = TALUS_VERSION, .doc = "Viscous damping.", .licence = "BSD-3-Clause");
