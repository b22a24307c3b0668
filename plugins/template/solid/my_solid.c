/* my_solid.c - solid "my_solid": elastic up to a largest shear stress, which falls while the zone flows.
 *
 *     sqrt(J2) <= k,  k = residual + (peak - residual) max(0, 1 - flowed / distance)
 *
 * Tension is positive. The strength of a step is that of its beginning. The flow has no volume, so the deviator is
 * scaled down (radial return); `flowed` grows by what that takes off it, over 2 G. */
#include <talus/solid_kit.h>

/* What a script gives; the host fills it in from the table below, checked and with defaults. */
typedef struct params {
    double young, poisson, bulk, shear;
    double peak, residual, distance;
} params;

static const tl_param param_table[] = {
    TL_PARAMS_ELASTIC(params),
    TL_PARAM(TL_PARAM_REAL, params, peak, "Pa", "largest root of J2 before flow",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, residual, "Pa", "largest root of J2 after the whole distance",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, distance, "", "plastic strain over which the strength falls",
             .flags = TL_PARAM_MIN_OPEN, .def = {0.01}, .min = 0, .max = INFINITY),
};

/* What a zone remembers; the host owns it, turns it with the zone where it is an axis or a tensor, and writes it into
 * files. */
static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "flowed", "", "plastic strain so far"),
};

/* What `create` makes of the parameters. */
typedef struct solid {
    tl_isotropic elastic;
    double peak, residual, distance;
} solid;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    solid s = {.peak = p->peak, .residual = p->residual, .distance = p->distance};
    if (p->residual > p->peak)
        return tl_refuse(report, "residual = %g Pa is above peak = %g Pa", p->residual, p->peak);
    tl_status status = tl_isotropic_of(p->young, p->poisson, p->bulk, p->shear, &s.elastic, report);
    return status == TL_OK ? tl_keep(&s, sizeof s, self, report) : status;
}

/* Called by several threads at once: a pure function of what it is given. */
static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const solid *own = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LANES) {
        tl_lanes6 trial, after;
        tl_lanes mark;
        double *flowed = batch->state[0] + begin;
        tl_solid_trial(batch, begin, &own->elastic, trial);
        TL_EACH_LANE(i)
        {
            double xx = trial[0][i], yy = trial[1][i], zz = trial[2][i];
            double xy = trial[3][i], yz = trial[4][i], zx = trial[5][i];
            double p = (xx + yy + zz) / 3, x = xx - p, y = yy - p, z = zz - p;
            double size = sqrt(0.5 * (x * x + y * y + z * z) + xy * xy + yz * yz + zx * zx);
            double left = fmax(0, 1 - flowed[i] / own->distance);
            double strength = own->residual + (own->peak - own->residual) * left;
            /* 1e-12 keeps rounding from counting as flow; a padding lane has no stress and does not flow */
            double kept = size > strength * (1 + 1e-12) ? strength / size : 1;
            for (uint32_t k = 0; k < 6; k++)
                after[k][i] = kept < 1 ? kept * trial[k][i] + (k < 3 ? (1 - kept) * p : 0) : trial[k][i];
            flowed[i] += (1 - kept) * size / (2 * own->elastic.shear);
            mark[i] = kept < 1 ? TL_ZONE_SHEAR : 0;
        }
        tl_isotropic_put(batch, begin, &own->elastic, (const tl_lanes *)trial, (const tl_lanes *)after, mark);
    }
    return TL_OK;
}

static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                   double *stored)
{
    (void)state;
    tl_isotropic_energies(&((const solid *)self)->elastic, count, stress, stored);
}

/* Upper bounds, Pa: the time step follows from them. */
TL_SOLID_MODULI(solid);

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind =
    TL_KIND(TL_KIND_SOLID, ops, .name = "my_solid", .doc = "Shear strength that falls with flow.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(10, kind, .id = "example.my_solid", .version = "1.0", .doc = "A solid that softens.",
                .licence = "BSD-3-Clause");
