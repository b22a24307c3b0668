/* adaptive.c - damping "adaptive": viscous damping whose coefficient follows the kinetic energy.
 *
 *     R = sum alpha (m v.v + I w.w) / |d(sum Ek)/dt|
 *
 * is kept at a target: once a step alpha is multiplied by what would bring R to it, but by no more than `factor` and no
 * less than 1 / `factor`. So the damping vanishes as the kinetic energy settles, and does not hold back a steady
 * collapse. One degree of freedom loses sqrt((1 - target)/(1 + target)) of its amplitude each half cycle.
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125, who give the ratio;
 * the servo is ours. The bounds on alpha that are not given follow the time step, which makes them fit
 * models of any size: see the table. State `alpha` is 0 before the first step. */
#include <talus/kit.h>
#include <talus/version.h>

/* Bounds and start of alpha dt where the user gives none. Above 1 (23) would reverse velocities;
 * 1e-8 lies below any alpha that matters within a hundred million steps, and the servo climbs back from
 * it in 194 steps of 1.1; 0.01 is that of a mode of a few hundred steps a period. */
#define MAXIMUM_STEP 1.0
#define MINIMUM_STEP 1e-8
#define START_STEP 0.01

typedef struct params {
    double target, start, minimum, maximum, factor;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, target, "", "share of the rate of kinetic energy that damping absorbs",
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN, .def = {0.5}, .min = 0, .max = 1),
    TL_PARAM_POSITIVE_OR_NONE(params, start, "1/s", "first coefficient; not given: 0.01 / time step"),
    TL_PARAM_POSITIVE_OR_NONE(params, minimum, "1/s", "smallest coefficient; not given: 1e-8 / time step"),
    TL_PARAM_POSITIVE_OR_NONE(params, maximum, "1/s", "largest coefficient; not given: 1 / time step"),
    TL_PARAM(TL_PARAM_REAL, params, factor, "", "largest change of the coefficient in one step",
             .flags = TL_PARAM_MIN_OPEN, .def = {1.1}, .min = 1, .max = 10),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "alpha", "1/s", "damping coefficient; 0 before the first step"),
};

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (p->minimum > p->maximum)
        return tl_refuse(report, "minimum = %g 1/s must be <= maximum = %g 1/s", p->minimum, p->maximum);
    return tl_keep(p, sizeof *p, self, report);
}

static double clamp(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Once a step: the servo. */
static tl_status begin(const void *self, const tl_damping_totals *totals, double *const *state, tl_report *report)
{
    (void)report;
    const params *p = self;
    double per_step = 1 / totals->dt;
    double minimum = isnan(p->minimum) ? MINIMUM_STEP * per_step : p->minimum;
    double maximum = isnan(p->maximum) ? MAXIMUM_STEP * per_step : p->maximum;
    double alpha = *state[0];
    if (!(alpha > 0)) {
        alpha = isnan(p->start) ? START_STEP * per_step : p->start;
    } else {
        double power = alpha * totals->power_unit;
        double wanted = p->target * fabs(totals->kinetic_rate);
        /* Nothing moves: nothing to absorb, unless motion has just begun or ended. */
        double ratio = power > 0 ? wanted / power : wanted > 0 ? p->factor : 1 / p->factor;
        alpha *= clamp(ratio, 1 / p->factor, p->factor);
    }
    *state[0] = clamp(alpha, minimum < maximum ? minimum : maximum, maximum);
    return TL_OK;
}

static const tl_damping_ops ops = {.size = sizeof ops,
                                   .create = create,
                                   .begin = begin,
                                   .update = tl_update_alpha_state,
                                   .step_factor = tl_step_factor_one,
                                   .destroy = free,
                                   .never_fails = true};

static const tl_kind kind =
    TL_KIND(TL_KIND_DAMPING, ops, .name = "adaptive",
            .doc = "Viscous damping that follows the rate of kinetic energy; vanishes at rest and in steady motion.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.adaptive", .version = TALUS_VERSION, .doc = "Adaptive global damping.",
          .licence = "BSD-3-Clause");
