/* local.c - damping "local": a force on every body that opposes its motion and is proportional to the unbalanced force.
 *
 *     F_d = -alpha |F| sign(v)      for each component of force and moment on its own
 *
 * F is the whole unbalanced force, weight and loads included; sign(0) is 0. A body in steady motion is
 * not braked, one that accelerates does so with (1 - alpha) F. One degree of freedom loses
 * sqrt((1 - alpha)/(1 + alpha)) of its amplitude each half cycle, at any frequency.
 *
 * Source: P. A. Cundall, "Distinct element models of rock and soil structure", in Analytical and
 * Computational Methods in Engineering Rock Mechanics (1987). It raises the effective stiffness by
 * (1 + alpha), so the stable time step shrinks by 1 / sqrt(1 + alpha). */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    double alpha;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, alpha, "", "share of the unbalanced force that opposes motion",
             .flags = TL_PARAM_MAX_OPEN, .def = {0.8}, .min = 0, .max = 1),
};

/* One component of all bodies. Selects, not branches, so that the loop vectorises. */
TL_VECTORIZED static void oppose(double alpha, uint32_t count, const double *restrict velocity,
                                 const double *restrict force, double *restrict out)
{
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        double size = alpha * fabs(force[i]);
        double forward = velocity[i] > 0 ? -size : 0;
        out[i] = velocity[i] < 0 ? size : forward;
    }
}

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    for (int k = 0; k < 3; k++) {
        oppose(p->alpha, batch->count, batch->velocity[k], batch->force[k], batch->damping_force[k]);
        oppose(p->alpha, batch->count, batch->angular_velocity[k], batch->moment[k], batch->damping_moment[k]);
    }
    return TL_OK;
}

static double step_factor(const void *self)
{
    const params *p = self;
    return 1 / sqrt(1 + p->alpha);
}

static const tl_damping_ops ops = TL_DAMPING_OPS(.step_factor = step_factor);

static const tl_kind kind = TL_KIND(TL_KIND_DAMPING, ops, .name = "local",
                                    .doc = "Opposes motion by a share of the unbalanced force; for statics.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.local", .version = TALUS_VERSION, .doc = "Local (non-viscous) damping.",
          .licence = "BSD-3-Clause");
