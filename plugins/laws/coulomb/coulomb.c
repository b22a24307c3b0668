/* coulomb.c - law "coulomb": elastic springs with a Coulomb limit on shear and no tensile strength.
 *
 *     f_n = kn A closure + f_n0                     total, compression positive; after eq. (6)
 *     f_n < 0:  f_n = 0, f_s = 0, open
 *     f_t = f_s - ks A du_s                         eq. (7), on block B
 *     limit = c A + f_n tan(friction)               eq. (10)
 *     |f_t| > limit:  f_s = f_t limit / |f_t|       eq. (12), slipping
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125. The cohesion stays
 * after slip, and comes back when an opened point closes; see coulomb_tensile for a bond that is lost.
 *
 * Energy turned to heat by slip: the plastic slip (|f_t| - |f_s|) / (ks A) along f_t times the mean of
 * the shear forces before and after in that direction. With the work of the mean force over du_s this
 * balances the change of stored energy exactly; for a reversal within one step it is taken as 0. */
#include <talus/plugin.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define DEGREE (3.14159265358979323846 / 180)
/* Lanes worked on at a time: their flags stay in the nearest cache. */
#define STRIDE 64u
/* Scaling a force down to its limit leaves it within 2 roundings of it; without this margin a point at
 * rest would be scaled down by a rounding in every step. */
#define ROUNDING 1e-15

typedef struct params {
    double kn, ks, friction, cohesion;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, kn, "Pa/m", "normal stiffness of the joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, ks, "Pa/m", "shear stiffness of the joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, friction, "deg", "angle of friction",
             .flags = TL_PARAM_MAX_OPEN, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, cohesion, "Pa", "shear strength at zero normal stress",
             .min = 0, .max = INFINITY),
};

typedef struct coulomb {
    double kn, ks, tangent, cohesion;
} coulomb;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    coulomb *law = malloc(sizeof *law);
    if (!law) {
        snprintf(report->text, sizeof report->text, "out of memory");
        return TL_E_MEMORY;
    }
    *law = (coulomb){p->kn, p->ks, tan(p->friction * DEGREE), p->cohesion};
    *self = law;
    return TL_OK;
}

/* Elastic energy of both springs; 0 for a lane of no area. */
static void store_energy(const coulomb *law, const tl_law_batch *batch)
{
    const double *restrict area = batch->area, *restrict f_n = batch->f_n;
    const double *restrict f_x = batch->f_s[0], *restrict f_y = batch->f_s[1];
    const double *restrict f_z = batch->f_s[2];
    double *restrict stored = batch->stored;
    const double half_n = 0.5 / law->kn, half_s = 0.5 / law->ks;
#pragma omp simd
    for (uint32_t i = 0; i < batch->count; i++) {
        double inverse = area[i] > 0 ? 1 / (area[i] > 0 ? area[i] : 1) : 0;
        double shear2 = f_x[i] * f_x[i] + f_y[i] * f_y[i] + f_z[i] * f_z[i];
        stored[i] = (half_n * f_n[i] * f_n[i] + half_s * shear2) * inverse;
    }
}

/* The law itself, for up to STRIDE lanes from `begin`. `heat` is a constant at each call, so that the
 * loop exists once with and once without the energy and neither has a branch in it. A NaN goes through
 * all comparisons to the forces, where the host finds it. `mark` takes the flags as doubles: a loop
 * over lanes of two widths is not vectorised for every machine. */
static inline __attribute__((always_inline)) void move(const coulomb *law,
                                                       const tl_law_batch *batch, uint32_t begin,
                                                       uint32_t lanes, double *restrict mark,
                                                       const int heat)
{
    const double *restrict area = batch->area + begin, *restrict closure = batch->closure + begin;
    const double *restrict f_n0 = batch->f_n0 + begin;
    const double *restrict du_x = batch->du_s[0] + begin, *restrict du_y = batch->du_s[1] + begin;
    const double *restrict du_z = batch->du_s[2] + begin;
    double *restrict f_n = batch->f_n + begin, *restrict f_x = batch->f_s[0] + begin;
    double *restrict f_y = batch->f_s[1] + begin, *restrict f_z = batch->f_s[2] + begin;
    double *restrict dissipated = heat ? batch->dissipated + begin : NULL;
    const double kn = law->kn, ks = law->ks, tangent = law->tangent, cohesion = law->cohesion;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double stiffness = ks * area[i];
        double total = kn * area[i] * closure[i] + f_n0[i];
        double normal = total < 0 ? 0 : total;
        double tx = f_x[i] - stiffness * du_x[i];
        double ty = f_y[i] - stiffness * du_y[i];
        double tz = f_z[i] - stiffness * du_z[i];
        double trial = sqrt(tx * tx + ty * ty + tz * tz);
        double limit = total < 0 ? 0 : cohesion * area[i] + normal * tangent;
        double most = limit * (1 + ROUNDING);
        double whole = trial > most ? trial : 1;
        double scale = trial > most ? limit / whole : 1;
        if (heat) {
            double mean = 0.5 * ((f_x[i] * tx + f_y[i] * ty + f_z[i] * tz) / whole + limit);
            double slip = (trial - limit) / (stiffness > 0 ? stiffness : 1);
            double work = trial > most ? mean * slip : 0;
            dissipated[i] = work > 0 && stiffness > 0 ? work : 0;
        }
        double flag = trial > most ? TL_POINT_SLIPPING : 0;
        mark[i] = total < 0 ? TL_POINT_OPEN : flag;
        f_n[i] = normal;
        f_x[i] = scale * tx;
        f_y[i] = scale * ty;
        f_z[i] = scale * tz;
    }
}

static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    double mark[STRIDE];
    for (uint32_t begin = 0; begin < batch->count; begin += STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < STRIDE ? left : STRIDE;
        if (batch->dissipated)
            move(self, batch, begin, lanes, mark, 1);
        else
            move(self, batch, begin, lanes, mark, 0);
        for (uint32_t i = 0; i < lanes; i++)
            batch->flags[begin + i] = (uint32_t)mark[i];
    }
    if (batch->stored)
        store_energy(self, batch);
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    const coulomb *law = self;
    *kn = law->kn;
    *ks = law->ks;
}

static const tl_law_ops ops = {.size = sizeof ops,
                               .create = create,
                               .update = update,
                               .stiffness = stiffness,
                               .destroy = free};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_LAW,
    .name = "coulomb",
    .doc = "Coulomb friction with cohesion and no tensile strength.",
    .params_size = sizeof(params),
    .params = param_table,
    .param_count = sizeof param_table / sizeof *param_table,
    .param_stride = sizeof *param_table,
    .ops = &ops,
};

static const tl_plugin plugin = {
    .size = sizeof plugin,
    .abi_major = TL_ABI_MAJOR,
    .abi_minor = TL_ABI_MINOR,
    .id = "talus.coulomb",
    .version = "0.1.0",
    .doc = "Coulomb joint law.",
    .licence = "BSD-3-Clause",
    .kinds = &kind,
    .kind_count = 1,
    .kind_stride = sizeof kind,
};

TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)
{
    (void)host_minor;
    return host_major == TL_ABI_MAJOR ? &plugin : NULL;
}
