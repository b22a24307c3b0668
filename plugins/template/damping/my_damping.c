/* my_damping.c - damping "my_damping": drag that grows with the square of the velocity.
 *
 *     F_d = -c m |v| v        M_d = -c_w I |w| w
 *
 * c is in 1/m, c_w without a unit. A body that falls reaches the velocity sqrt(g / c): drag goes with its own mass, as
 * its weight does. The step moves it by the moving mass, which mass scaling makes another one. Drag that would turn it
 * back within the step stops it instead. The force is a pure function of the body, so the host may give bodies in
 * batches of any size, to several threads. */
#include <talus/kit.h>

/* What a script gives; the host fills it in from the table below, checked and with defaults. */
typedef struct params {
    double drag, spin_drag;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, drag, "1/m", "drag per mass and square of the velocity", .flags = TL_PARAM_REQUIRED,
             .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, spin_drag, "", "drag per moment of inertia and square of the angular velocity",
             .def = {0}, .min = 0, .max = INFINITY),
};

/* -c times the size of the vector, times the vector, for all bodies of the batch; no more than stops `moving`. */
static void drag(double c, const tl_damping_batch *batch, const double *inertia, const double *moving,
                 const double *const motion[3], double *const out[3])
{
    for (uint32_t i = 0; i < batch->count; i++) {
        double x = motion[0][i], y = motion[1][i], z = motion[2][i];
        double most = moving[i] / batch->dt;
        double factor = -fmin(c * inertia[i] * sqrt(x * x + y * y + z * z), most);
        out[0][i] = factor * x;
        out[1][i] = factor * y;
        out[2][i] = factor * z;
    }
}

/* Called by several threads at once. */
static tl_status update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    drag(p->drag, batch, batch->mass, batch->moving_mass, batch->velocity, batch->damping_force);
    drag(p->spin_drag, batch, batch->inertia, batch->moving_inertia, batch->angular_velocity, batch->damping_moment);
    return TL_OK;
}

/* The stable time step becomes no shorter. */
static const tl_damping_ops ops = {.size = sizeof ops, .update = update, .step_factor = tl_step_factor_one};

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "my_damping", .doc = "Drag that grows with the square of the velocity.",
            TL_KIND_PARAMS(params, param_table));

/* Hosts give the moving mass since minor version 9. */
TL_PLUGIN_SINCE(9, kind, .id = "example.my_damping", .version = "1.0", .doc = "Quadratic drag.",
                .licence = "BSD-3-Clause");
