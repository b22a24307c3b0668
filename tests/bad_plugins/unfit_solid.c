/* unfit_solid.c - a solid that breaks one rule of the conformance check, which a parameter names. Else it is elastic up to
 * a largest shear stress (von Mises), and counts how far it has flowed, by which it softens a little. */
#include <talus/solid_kit.h>

enum {
    NONE,
    RUNS,
    REPEATS,
    ALONE,
    SPLIT,
    ENERGIES,
    WRITES_INPUT,
    WRITES_BEHIND,
    WRITES_STATE,
    ADDS_STATE,
    READS,
    FINITE,
    STILL,
    TURNED,
    SOFT_MODULI,
    SHEAR_MODULI,
    CYCLE,
    STORED,
    ENERGY,
    HEAT,
    COLD,
    FLAGS,
    STATES,
    COUNTS,
    SIGN
};

typedef struct params {
    int32_t solid_fault;
    double young, strength, fall;
} params;

static const char *const faults[] = {
    "none",          "runs",         "repeats",    "alone",  "split",  "energies", "writes_input",
    "writes_behind", "writes_state", "adds_state", "reads",  "finite", "still",    "turned",
    "soft_moduli",   "shear_moduli", "cycle",      "stored", "energy", "heat",     "cold",
    "flags",         "states",       "counts",     "sign",   NULL};

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, solid_fault, "", "what is wrong with the solid", .choices = faults),
    TL_PARAM(TL_PARAM_REAL, params, young, "Pa", "stiffness", .def = {1e7}, .min = 1e6, .max = 1e8),
    TL_PARAM(TL_PARAM_REAL, params, strength, "Pa", "largest root of J2", .def = {1e6}, .min = 1e5, .max = 1e7),
    TL_PARAM(TL_PARAM_REAL, params, fall, "", "how fast it softens", .def = {0.1}, .min = 0.01, .max = 1),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "flowed", "", "plastic strain so far"),
};

static int calls; /* which no plugin may count */

static tl_isotropic elastic_of(const params *p)
{
    tl_isotropic elastic = {p->young / 1.5, p->young / 2.5, 0, 0};
    elastic.lame = elastic.bulk - 2 * elastic.shear / 3;
    elastic.constrained = elastic.bulk + 4 * elastic.shear / 3;
    return elastic;
}

/* What a zone gets besides. */
static void spoil(const params *p, const tl_solid_batch *batch, uint32_t i)
{
    double s = 1e-3 * p->young, *xx = &batch->stress[0][i];
    switch (p->solid_fault) {
    case REPEATS: *xx += s * 1e-12 * (calls++ % 11); break;
    case ALONE: *xx *= batch->count > TL_LANES ? 1 + 1e-15 : 1; break;
    case SPLIT: *xx *= i % 3 == 2 ? 1 + 1e-15 : 1; break;
    case ENERGIES: *xx *= batch->stored ? 1 + 1e-15 : 1; break;
    case WRITES_INPUT: ((double *)(uintptr_t)batch->strain[0])[i] = 0; break;
    case WRITES_BEHIND: batch->stress[5][batch->count] = 0; break;
    case WRITES_STATE: batch->state[1][i] = 1; break;
    case ADDS_STATE: batch->state[1][i] += batch->state[0][i]; break;
    case READS: *xx += 1e-12 * batch->state[3][i]; break;
    case FINITE: *xx = *xx > 20 * s ? NAN : *xx; break;
    case STILL: *xx *= 1 - 1e-9; break;
    case TURNED: batch->stress[1][i] += 1e-3 * p->young * batch->strain[0][i]; break;
    case CYCLE: *xx += 1e-3 * p->young * fabs(batch->strain[1][i]); break;
    default: break;
    }
}

/* How large a fault's energies are beside the right ones. */
static void spoil_energies(const params *p, const tl_solid_batch *batch, uint32_t i)
{
    if (p->solid_fault == STORED && batch->stored)
        batch->stored[i] *= 0.5;
    if (p->solid_fault == HEAT && batch->dissipated)
        batch->dissipated[i] *= 3;
    if (p->solid_fault == COLD && batch->dissipated)
        batch->dissipated[i] *= -1;
}

static void flow(const params *p, const tl_isotropic *elastic, const tl_lanes6 s, const double *flowed, tl_lanes6 after,
                 tl_lanes more, tl_lanes mark)
{
    TL_EACH_LANE(i)
    {
        double m = (s[0][i] + s[1][i] + s[2][i]) / 3, x = s[0][i] - m, y = s[1][i] - m, z = s[2][i] - m;
        double size = sqrt(0.5 * (x * x + y * y + z * z) + s[3][i] * s[3][i] + s[4][i] * s[4][i] + s[5][i] * s[5][i]);
        double seen = p->solid_fault == STATES ? 0 : flowed[i];
        double most = p->strength / (1 + p->fall * seen);
        double kept = size > most * (1 + 1e-13) ? most / size : 1;
        for (uint32_t k = 0; k < 6; k++) {
            double mean = k < 3 ? m : 0;
            after[k][i] = kept < 1 ? mean + kept * (s[k][i] - mean) : s[k][i];
        }
        more[i] = (1 - kept) * size / (2 * elastic->shear);
        mark[i] = kept < 1 ? TL_ZONE_SHEAR : 0;
    }
}

static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    const params *p = self;
    const tl_isotropic elastic = elastic_of(p);
    if (p->solid_fault == RUNS) {
        snprintf(report->text, sizeof report->text, "it does not feel like it");
        return TL_E_STATE;
    }
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LANES) {
        tl_lanes6 trial, after;
        tl_lanes more, mark;
        tl_solid_trial(batch, begin, &elastic, trial);
        for (uint32_t k = 0; p->solid_fault == SIGN && k < 6; k++)
            TL_EACH_LANE(i)
        trial[k][i] = 2 * batch->stress[k][begin + i] - trial[k][i];
        flow(p, &elastic, (const tl_lanes *)trial, batch->state[0] + begin, after, more, mark);
        uint32_t flags[TL_LANES];
        memcpy(flags, batch->flags + begin, sizeof flags);
        tl_isotropic_put(batch, begin, &elastic, (const tl_lanes *)trial, (const tl_lanes *)after, mark);
        for (uint32_t i = begin; i < begin + TL_LANES; i++) {
            batch->state[0][i] += more[i - begin] + (p->solid_fault == COUNTS ? 1e-9 : 0);
            batch->flags[i] = p->solid_fault == FLAGS ? (uint32_t)mark[i - begin] : batch->flags[i];
            spoil(p, batch, i);
            spoil_energies(p, batch, i);
        }
    }
    return TL_OK;
}

static void moduli(const void *self, double *constrained, double *shear)
{
    const params *p = self;
    const tl_isotropic elastic = elastic_of(p);
    *constrained = elastic.constrained * (p->solid_fault == SOFT_MODULI ? 0.9 : 1);
    *shear = elastic.shear * (p->solid_fault == SHEAR_MODULI ? 0.9 : 1);
}

static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                   double *stored)
{
    const params *p = self;
    const tl_isotropic elastic = elastic_of(p);
    (void)state;
    tl_isotropic_energies(&elastic, count, stress, stored);
    for (uint32_t i = 0; i < count; i++)
        stored[i] *= p->solid_fault == ENERGY ? 1.01 : p->solid_fault == STORED ? 0.5 : 1;
}

static const tl_solid_ops ops = {
    .size = sizeof ops, .update = update, .moduli = moduli, .energy = energy, .never_fails = 1};

static const tl_kind kind =
    TL_KIND(TL_KIND_SOLID, ops, .name = "unfit_solid", .doc = "A solid for the tests of the conformance check.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "bad.unfit_solid", .version = "1", .doc = "A solid for the tests of the conformance check.",
          .licence = "BSD-3-Clause");
