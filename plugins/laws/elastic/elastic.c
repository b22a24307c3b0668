/* elastic.c - law "elastic": linear normal and shear springs without any limit, also in tension.
 *
 *     f_n = kn A closure + f_n0                     total, compression positive; after eq. (6)
 *     f_s <- f_s - ks A du_s                        eq. (7), on block B
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125. The normal force
 * follows the total closure, not increments, so that an opened contact does not reload before its gap
 * is closed again. No flag is ever set, nothing is dissipated. */
#include <talus/plugin.h>
#include <talus/version.h>

#include <math.h>

typedef struct params {
    double kn, ks;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, kn, "Pa/m", "normal stiffness of the joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, ks, "Pa/m", "shear stiffness of the joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
};

/* Elastic energy of both springs; 0 for a lane of no area. */
static void store_energy(const params *p, const tl_law_batch *batch)
{
    const double *restrict area = batch->area, *restrict f_n = batch->f_n;
    const double *restrict f_x = batch->f_s[0], *restrict f_y = batch->f_s[1];
    const double *restrict f_z = batch->f_s[2];
    double *restrict stored = batch->stored;
    const double half_n = 0.5 / p->kn, half_s = 0.5 / p->ks;
#pragma omp simd
    for (uint32_t i = 0; i < batch->count; i++) {
        double inverse = area[i] > 0 ? 1 / (area[i] > 0 ? area[i] : 1) : 0;
        double shear2 = f_x[i] * f_x[i] + f_y[i] * f_y[i] + f_z[i] * f_z[i];
        stored[i] = (half_n * f_n[i] * f_n[i] + half_s * shear2) * inverse;
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch,
                                      tl_report *report)
{
    (void)report;
    const params *p = self;
    const double *restrict area = batch->area, *restrict closure = batch->closure;
    const double *restrict f_n0 = batch->f_n0;
    const double *restrict du_x = batch->du_s[0], *restrict du_y = batch->du_s[1];
    const double *restrict du_z = batch->du_s[2];
    double *restrict f_n = batch->f_n, *restrict f_x = batch->f_s[0];
    double *restrict f_y = batch->f_s[1], *restrict f_z = batch->f_s[2];
    uint32_t *restrict flags = batch->flags;
    const double kn = p->kn, ks = p->ks;
    /* Walls that come near each other from afar do not pull before they have met. */
    for (uint32_t i = 0; i < batch->count; i++)
        if (flags[i])
            flags[i] = flags[i] & TL_POINT_APART && kn * area[i] * closure[i] + f_n0[i] <= 0
                           ? TL_POINT_APART | TL_POINT_OPEN
                           : 0;
#pragma omp simd
    for (uint32_t i = 0; i < batch->count; i++) {
        double stiffness = ks * area[i], total = kn * area[i] * closure[i] + f_n0[i];
        double meet = flags[i] ? 0 : 1;
        f_n[i] = meet * total;
        f_x[i] = meet * (f_x[i] - stiffness * du_x[i]);
        f_y[i] = meet * (f_y[i] - stiffness * du_y[i]);
        f_z[i] = meet * (f_z[i] - stiffness * du_z[i]);
    }
    if (batch->stored)
        store_energy(p, batch);
    for (uint32_t i = 0; batch->dissipated && i < batch->count; i++)
        batch->dissipated[i] = 0;
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    const params *p = self;
    *kn = p->kn;
    *ks = p->ks;
}

static const tl_law_ops ops = {
    .size = sizeof ops, .update = update, .stiffness = stiffness, .never_fails = true};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_LAW,
    .name = "elastic",
    .doc = "Linear springs across the joint, without strength limits; carries tension.",
    TL_KIND_PARAMS(params, param_table),
    .ops = &ops,
};

TL_PLUGIN(kind, .id = "talus.elastic", .version = TALUS_VERSION, .doc = "Elastic joint law.",
          .licence = "BSD-3-Clause");
