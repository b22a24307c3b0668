/* elastic.c - solid "elastic": isotropic, Hooke's law of the increments.
 *
 *     d sigma = (K - 2 G / 3) tr(d eps) I + 2 G d eps,  U = s:s / (4 G) + p^2 / (2 K) */
#include <talus/solid_kit.h>
#include <talus/version.h>

typedef struct params {
    double young, poisson, bulk, shear;
} params;

static const tl_param param_table[] = {TL_PARAMS_ELASTIC(params)};

typedef struct elastic_solid {
    tl_isotropic elastic;
} elastic_solid;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    elastic_solid solid;
    tl_status status = tl_isotropic_of(p->young, p->poisson, p->bulk, p->shear, &solid.elastic, report);
    return status == TL_OK ? tl_keep(&solid, sizeof solid, self, report) : status;
}

TL_VECTORIZED static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const tl_isotropic *elastic = &((const elastic_solid *)self)->elastic;
    const double lame = elastic->lame, twice = 2 * elastic->shear;
    const double *const *d = batch->strain;
    const double *dxx = d[0], *dyy = d[1], *dzz = d[2], *dxy = d[3], *dyz = d[4], *dzx = d[5];
    double *const *s = batch->stress;
    double *xx = s[0], *yy = s[1], *zz = s[2], *xy = s[3], *yz = s[4], *zx = s[5];
    const uint32_t count = batch->count;
    uint32_t *flags = batch->flags;
    TL_EACH_ALONE
    for (uint32_t i = 0; i < count; i++) {
        const double volumetric = lame * (dxx[i] + dyy[i] + dzz[i]);
        xx[i] += volumetric + twice * dxx[i];
        yy[i] += volumetric + twice * dyy[i];
        zz[i] += volumetric + twice * dzz[i];
        xy[i] += twice * dxy[i];
        yz[i] += twice * dyz[i];
        zx[i] += twice * dzx[i];
    }
    if (batch->stored)
        tl_isotropic_energies(elastic, count, (const double *const *)batch->stress, batch->stored);
    if (batch->dissipated)
        memset(batch->dissipated, 0, count * sizeof *batch->dissipated);
    for (uint32_t i = 0; i < count; i++)
        flags[i] = tl_zone_flags(flags[i], 0);
    return TL_OK;
}

TL_VECTORIZED static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                                 double *stored)
{
    (void)state;
    tl_isotropic_energies(&((const elastic_solid *)self)->elastic, count, stress, stored);
}

TL_SOLID_MODULI(elastic_solid);

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind = TL_KIND(TL_KIND_SOLID, ops, .name = "elastic", .doc = "Isotropic and elastic.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.solid_elastic", .version = TALUS_VERSION, .doc = "Isotropic elastic solid.",
                .licence = "BSD-3-Clause");
