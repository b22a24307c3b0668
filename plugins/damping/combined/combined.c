/* combined.c - damping "combined": local damping for bodies in steady motion.
 *
 *     F_d = alpha/2 |F| (sign(dF/dt) - sign(v))     for each component of force and moment on its own
 *
 * F is the whole unbalanced force, dF its change since the step before; sign(0) is 0. In a free vibration dF/dt and v
 * have opposite signs, and it is the damping "local". About a steady motion the velocity keeps its sign: local damping
 * then brakes the motion and leaves the vibration alone. Here dF/dt still tells the vibration's direction, so that is
 * damped, and the drag is half. It suits slow flow, sliding and moving boundaries. A body without velocity is left
 * alone: there is nothing to damp.
 *
 * Source: the combined damping of the distinct element codes of Itasca, after P. A. Cundall. The
 * effective stiffness rises by (1 + alpha) at the most, so the stable time step shrinks by
 * 1 / sqrt(1 + alpha). The forces of the step before are the host's. */
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
TL_VECTORIZED static void combine(double alpha, uint32_t count, const double *restrict velocity,
                                  const double *restrict force, const double *restrict before, double *restrict out)
{
#pragma omp simd
    for (uint32_t i = 0; i < count; i++) {
        double size = 0.5 * alpha * fabs(force[i]), change = force[i] - before[i];
        double along = change > 0 ? size : 0;
        along = change < 0 ? -size : along;
        double against = velocity[i] > 0 ? -size : size;
        out[i] = velocity[i] != 0 ? along + against : 0;
    }
}

static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    for (int k = 0; k < 3; k++) {
        combine(p->alpha, batch->count, batch->velocity[k], batch->force[k], batch->force_before[k],
                batch->damping_force[k]);
        combine(p->alpha, batch->count, batch->angular_velocity[k], batch->moment[k], batch->moment_before[k],
                batch->damping_moment[k]);
    }
    return TL_OK;
}

static double step_factor(const void *self)
{
    const params *p = self;
    return 1 / sqrt(1 + p->alpha);
}

static const tl_damping_ops ops = TL_DAMPING_OPS(.step_factor = step_factor, .before = true);

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "combined",
            .doc = "Local damping that also damps vibration about a steady motion; for slow sliding and flow.",
            TL_KIND_PARAMS(params, param_table));

/* Hosts give the forces of the step before since minor version 1, but since 2 to those that ask. */
TL_PLUGIN_SINCE(1, kind, .id = "talus.combined", .version = TALUS_VERSION, .doc = "Combined damping.",
                .licence = "BSD-3-Clause");
