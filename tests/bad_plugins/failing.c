/* failing.c - a law and a damping that fail when they are told to, in the midst of what they overwrite; and a law that says
 * it never fails. */
#include <math.h>
#include <stdio.h>
#include <talus/plugin.h>

/* ---------------------------------------------------------------- laws ------------------- */

typedef struct law_params {
    double kn, ks, beyond;
    int32_t fails;
} law_params;

static const tl_param law_table[] = {
    TL_PARAM(TL_PARAM_REAL, law_params, kn, "Pa/m", "normal stiffness", .flags = TL_PARAM_REQUIRED, .min = 0,
             .max = 1e20),
    TL_PARAM(TL_PARAM_REAL, law_params, ks, "Pa/m", "shear stiffness", .flags = TL_PARAM_REQUIRED, .min = 0,
             .max = 1e20),
    TL_PARAM(TL_PARAM_REAL, law_params, beyond, "m", "closure from which on it fails", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, law_params, fails, "", "whether it does", .def = {0.0}),
};

/* Springs that remember how often they were asked and how far they have slid. */
static const tl_state law_states[] = {
    TL_STATE(TL_STATE_SCALAR, "calls", "", "steps made"),
    TL_STATE(TL_STATE_TANGENT, "slid", "m", "way in the common plane"),
};

static tl_status update_law(const void *self, const tl_law_batch *b, tl_report *report)
{
    const law_params *p = self;
    tl_status status = TL_OK;
    for (uint32_t i = 0; i < b->count; i++) {
        double normal = p->kn * b->area[i] * b->closure[i] + b->f_n0[i];
        b->f_n[i] = 0.5 * (b->f_n[i] + (normal > 0 ? normal : 0)); /* of the step before, too */
        b->state[0][i] += 1;
        b->flags[i] = normal > 0 ? 0 : TL_POINT_OPEN;
        for (int k = 0; k < 3; k++) {
            b->f_s[k][i] -= p->ks * b->area[i] * b->du_s[k][i];
            b->state[1 + k][i] += b->du_s[k][i];
        }
        if (p->fails && b->area[i] > 0 && b->closure[i] > p->beyond && status == TL_OK) {
            status = TL_E_NUMERIC;
            report->first_bad = i;
            snprintf(report->text, sizeof report->text, "it was told to fail");
        }
    }
    return status;
}

static void law_stiffness(const void *self, double *kn, double *ks)
{
    const law_params *p = self;
    *kn = p->kn;
    *ks = p->ks;
}

static const tl_law_ops law_ops = {.size = sizeof law_ops, .update = update_law, .stiffness = law_stiffness};
static const tl_law_ops liar_ops = {
    .size = sizeof liar_ops, .update = update_law, .stiffness = law_stiffness, .never_fails = true};

/* ---------------------------------------------------------------- damping ---------------- */

typedef struct damping_params {
    double factor, step;
    int32_t fails;
} damping_params;

static const tl_param damping_table[] = {
    TL_PARAM(TL_PARAM_REAL, damping_params, factor, "", "share of the force of the step before", .def = {0.1}, .min = 0,
             .max = 1),
    TL_PARAM(TL_PARAM_REAL, damping_params, step, "", "factor of the time step, of any size", .def = {1.0},
             .min = -INFINITY, .max = INFINITY),
    TL_PARAM(TL_PARAM_BOOL, damping_params, fails, "", "whether it fails", .def = {0.0}),
};

static const tl_state damping_states[] = {
    TL_STATE(TL_STATE_SCALAR, "calls", "", "steps made"),
};

static tl_status begin_damping(const void *self, const tl_damping_totals *totals, double *const *state,
                               tl_report *report)
{
    (void)self;
    (void)totals;
    (void)report;
    *state[0] += 1;
    return TL_OK;
}

static tl_status update_damping(const void *self, const tl_damping_batch *b, tl_report *report)
{
    const damping_params *p = self;
    for (uint32_t i = 0; i < b->count; i++)
        for (int k = 0; k < 3; k++)
            b->damping_force[k][i] = -p->factor * b->force_before[k][i] / (1 + *b->state[0]);
    if (!p->fails)
        return TL_OK;
    snprintf(report->text, sizeof report->text, "it was told to fail");
    return TL_E_NUMERIC;
}

static double step_factor(const void *self)
{
    return ((const damping_params *)self)->step;
}

static const tl_damping_ops damping_ops = {.size = sizeof damping_ops,
                                           .begin = begin_damping,
                                           .update = update_damping,
                                           .step_factor = step_factor,
                                           .before = true};

/* ---------------------------------------------------------------- plugin ----------------- */

#define LAW(name_, ops_)                                                                                               \
    {                                                                                                                  \
        .size = sizeof(tl_kind), .type = TL_KIND_LAW, .name = (name_), .doc = "Springs that fail.",                    \
        TL_KIND_PARAMS(law_params, law_table), TL_KIND_STATES(law_states), .ops = &(ops_),                             \
    }

static const tl_kind kinds[] = {
    LAW("failing", law_ops),
    LAW("failing_silently", liar_ops),
    TL_KIND(TL_KIND_DAMPING, damping_ops, .name = "failing_damping", .doc = "A damping that fails.",
            TL_KIND_PARAMS(damping_params, damping_table), TL_KIND_STATES(damping_states)),
};

TL_PLUGIN(kinds, .id = "bad.failing", .version = "1", .doc = "A plugin for the test of steps that are undone.",
          .licence = "BSD-3-Clause");
