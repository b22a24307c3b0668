/* liar.c - laws that load well and then break the interface, each in one way, which the parameter `lie` names. */
#include <talus/plugin.h>

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { NONE, NEGATIVE, NOT_A_NUMBER, INFINITE, STATE, TILTED, ROUNDING, WEAK, WEAK_SHEAR, PLACE, NORMAL, SHEAR };

typedef struct params {
    int32_t lie;
    double kn, factor;
} params;

static const char *const lies[] = {"none", "negative",   "not_a_number", "infinite", "state", "tilted", "rounding",
                                   "weak", "weak_shear", "place",        "normal",   "shear", NULL};

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, lie, "", "what is wrong with the law", .choices = lies),
    TL_PARAM(TL_PARAM_REAL, params, kn, "Pa/m", "stiffness", .def = {1e8}, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, factor, "", "by which it lies", .def = {100}, .min = 0, .max = INFINITY),
};

static const tl_state state_table[] = {
    {.size = sizeof(tl_state), .name = "steps", .unit = "", .doc = "steps so far"},
    {.size = sizeof(tl_state), .name = "wear", .unit = "m", .doc = "length of shear so far"},
};

static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    const params *p = self;
    if (p->lie == PLACE) {
        report->first_bad = p->factor < 1e9 ? (size_t)p->factor : SIZE_MAX;
        strcpy(report->text, "it fails somewhere");
        return TL_E_NUMERIC;
    }
    for (uint32_t i = 0; i < batch->count; i++) {
        double k = p->kn * batch->area[i];
        double f_n = fmax(0, k * batch->closure[i] + batch->f_n0[i]);
        double du2 = 0, k_s = p->lie == WEAK_SHEAR ? p->factor * k : k;
        for (int j = 0; j < 3; j++) {
            du2 += batch->du_s[j][i] * batch->du_s[j][i];
            batch->f_s[j][i] = f_n > 0 ? batch->f_s[j][i] - k_s * batch->du_s[j][i] : 0;
            if (p->lie == TILTED)
                batch->f_s[j][i] += 1e-3 * f_n * batch->normal[j][i];
            if (p->lie == ROUNDING) /* no force but what rounding leaves, of any direction */
                batch->f_s[j][i] = 1e-13 * p->factor * k * batch->normal[j][i];
        }
        batch->f_n[i] = p->lie == ROUNDING ? 0 : f_n;
        batch->flags[i] = f_n > 0 ? 0 : TL_POINT_OPEN;
        batch->state[0][i] += 1;
        batch->state[1][i] += sqrt(du2);
        if (p->lie == NORMAL && batch->state[0][i] >= 3 && batch->area[i] > 0)
            batch->f_n[i] = NAN;
        if (p->lie == SHEAR && batch->state[0][i] >= 3 && batch->area[i] > 0)
            batch->f_s[1][i] = INFINITY;
        if (p->lie == STATE && batch->state[0][i] >= 3 && batch->area[i] > 0)
            batch->state[1][i] = NAN;
    }
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    const params *p = self;
    *kn = *ks = p->kn;
    switch (p->lie) {
    case NEGATIVE: *ks = -p->kn; break;
    case NOT_A_NUMBER: *kn = NAN; break;
    case INFINITE: *kn = INFINITY; break;
    case WEAK: *kn = *ks = p->kn / p->factor; break;
    default: break;
    }
}

static const tl_law_ops ops = {.size = sizeof ops, .update = update, .stiffness = stiffness};

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "liar", .doc = "A law for the tests of the step.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "bad.liar", .version = "1", .doc = "A plugin for the tests of the step.",
          .licence = "BSD-3-Clause");
