/* elastic.c - law "elastic": linear normal and shear springs without any limit, also in tension.
 *
 *     f_n = kn A (closure - apart) + f_n0           total, compression positive; after eq. (6)
 *     f_s <- f_s - ks A du_s                        eq. (7), on block B
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125. The normal force follows the total
 * closure, not increments, so that an opened contact does not reload before its gap is closed again. Nothing is
 * dissipated. Where a part of the area is closed and another apart, by `apart` in the mean, the latter pulls. Walls
 * that come near each other from afar do not pull before they have met over the whole area; until then they keep the
 * flag. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    double kn, ks;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
};

/* The flags of walls that were made apart. */
static inline uint32_t now_of(uint32_t flags, double pressed, double apart)
{
    uint32_t open = pressed <= 0 ? TL_POINT_APART | TL_POINT_OPEN : 0;
    uint32_t partly = apart > 0 ? TL_POINT_APART : 0;
    return flags & TL_POINT_APART ? open | partly : 0;
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    const tl_law_columns c = tl_law_columns_from(batch, 0);
    uint32_t *restrict flags = batch->flags;
    const double kn = p->kn, ks = p->ks;
    const double *restrict apart = batch->closure_apart;
    for (uint32_t i = 0; i < batch->count; i++)
        if (flags[i])
            flags[i] = now_of(flags[i], kn * c.area[i] * c.closure[i] + c.f_n0[i], apart[i]);
#pragma omp simd
    for (uint32_t i = 0; i < batch->count; i++) {
        double pressed = kn * c.area[i] * c.closure[i] + c.f_n0[i];
        double pull = flags[i] & TL_POINT_APART ? 0 : kn * c.area[i] * apart[i];
        double meet = flags[i] & TL_POINT_OPEN ? 0 : 1;
        c.f_n[i] = meet * (pressed - pull);
        tl_vec3 f = TL_TRIAL_AT(c, i, ks * c.area[i]);
        TL_PUT_SHEAR(c, i, meet, f);
    }
    tl_law_store_energy(batch, 0, batch->count, kn, ks);
    for (uint32_t i = 0; batch->stored && i < batch->count; i++)
        if (apart[i] > 0 && !(flags[i] & TL_POINT_APART))
            batch->stored[i] += (kn * c.area[i] * c.closure[i] + c.f_n0[i]) * apart[i];
    for (uint32_t i = 0; batch->dissipated && i < batch->count; i++)
        batch->dissipated[i] = 0;
    return TL_OK;
}

TL_LAW_STIFFNESS(params, kn, ks);

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    const params *p = self;
    tl_law_lift(batch, p->kn, NULL, lift);
    for (uint32_t i = 0; i < batch->count; i++)
        hold[i] = batch->flags[i] & TL_POINT_APART ? 0 : 1;
}

static const tl_law_ops ops = {.size = sizeof ops,
                               .update = update,
                               .stiffness = stiffness,
                               .never_fails = true,
                               .across_gap = across_gap,
                               .linear = true};

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "elastic",
                                    .doc = "Linear springs across the joint, without strength limits; carries tension.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(8, kind, .id = "talus.elastic", .version = TALUS_VERSION, .doc = "Elastic joint law.",
                .licence = "BSD-3-Clause");
