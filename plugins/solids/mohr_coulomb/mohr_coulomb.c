/* mohr_coulomb.c - solid "mohr_coulomb": elastic to Mohr-Coulomb's surface with a tension cut-off, and to tables of
 * what strength is left over plastic strain.
 *
 * Surface, flow and return are those of talus/solid_returns.h. The strength of a step is that of its beginning, so
 * softening takes steps of a small part of the tables' strains. */
#include <talus/solid_returns.h>
#include <talus/version.h>

static const tl_param param_table[] = {TL_PARAMS_MOHR_COULOMB};
static const tl_state state_table[] = {TL_STATES_MOHR_COULOMB};

static tl_status create(const void *given, void **self, tl_report *report)
{
    tl_rock rock;
    tl_status status = tl_rock_of(given, &rock, report);
    return status == TL_OK ? tl_keep(&rock, sizeof rock, self, report) : status;
}

TL_VECTORIZED static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const tl_rock *rock = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LANES) {
        tl_strength_lanes strength;
        tl_lanes6 trial, after;
        tl_lanes may, shear, tension, mark = {0};
        tl_solid_trial(batch, begin, &rock->elastic, trial);
        tl_strength_at(rock, batch, begin, &strength);
        if (tl_may_yield((const tl_lanes *)trial, &strength, may)) {
            tl_group_return(&rock->elastic, &strength, may, (const tl_lanes *)trial, after, shear, tension, mark);
            tl_rock_wear(rock, batch, begin, shear, tension);
            tl_isotropic_put(batch, begin, &rock->elastic, (const tl_lanes *)trial, (const tl_lanes *)after, mark);
        } else {
            tl_isotropic_put(batch, begin, &rock->elastic, (const tl_lanes *)trial, (const tl_lanes *)trial, mark);
        }
    }
    return TL_OK;
}

TL_VECTORIZED static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                                 double *stored)
{
    (void)state;
    tl_isotropic_energies(&((const tl_rock *)self)->elastic, count, stress, stored);
}

TL_SOLID_MODULI(tl_rock);

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind = TL_KIND(TL_KIND_SOLID, ops, .name = "mohr_coulomb",
                                    .doc = "Mohr-Coulomb with a tension cut-off, and strength over plastic strain.",
                                    TL_KIND_PARAMS(tl_mohr_coulomb_params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.solid_mohr_coulomb", .version = TALUS_VERSION,
                .doc = "Solid that yields by Mohr-Coulomb.", .licence = "BSD-3-Clause");
