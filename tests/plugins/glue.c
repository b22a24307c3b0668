/* glue.c - law "glue", as somebody else may have written it: a brittle glue on rough walls that ride up on each other.
 *
 *     f_n = stiff A (closure + ride - glue apart) + f_n0
 *     stiff A (edge + ride) + f_n0 < -strength A:  the glue is lost, glue = 0
 *     |f_s| <= glue strength A + f_n tan angle;  slip lifts the walls: ride += slip tan climb
 *
 * Glue without strength is none. `edge` is the closure at the outermost fibre, and `apart` how far the part that is not
 * closed is apart. No parameter or state has the name of one of a law that comes with the program, so no test of all
 * laws can know it by a name. Compression is positive. The slip is that at whose end spring and strength agree, as the
 * slip itself presses the walls: slip = (|f_t| - limit) / (soft A + stiff A tan climb tan angle). */

#include <talus/kit.h>

typedef struct params {
    double stiff, soft, angle, strength, climb;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, stiff, "Pa/m", "stiffness across the walls",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, soft, "Pa/m", "stiffness along the walls",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, angle, "deg", "angle of friction", .flags = TL_PARAM_REQUIRED | TL_PARAM_MAX_OPEN,
             .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, strength, "Pa", "strength of the glue, in tension and in shear", .min = 0,
             .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, climb, "deg", "angle at which slip lifts the walls", .flags = TL_PARAM_MAX_OPEN,
             .min = 0, .max = 45),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "glue", "", "1 while it holds, then 0", .initial = 1),
    TL_STATE(TL_STATE_SCALAR, "ride", "m", "how far slip has lifted the walls"),
};

/* Rounding of a force that was brought down to its limit does not count as slip. */
#define ROUNDING 1e-12

/* A product of two forces over a spring's stiffness, J; 0 in a lane without area. */
static double over(double force2, double spring)
{
    return spring > 0 ? force2 / spring : 0;
}

static void move(const params *p, const tl_law_batch *batch, uint32_t i)
{
    const tl_law_columns c = tl_law_columns_from(batch, i);
    const double area = c.area[0], spring = p->stiff * area, along_spring = p->soft * area;
    const double tangent = tl_tan(p->angle * TL_DEGREE), rise = tl_tan(p->climb * TL_DEGREE);
    double *glue = &batch->state[0][i], *ride = &batch->state[1][i];
    const double had = batch->flags[i] & TL_POINT_APART || !(p->strength > 0) ? 0 : *glue;
    const double fibre = spring * (batch->closure_edge[i] + *ride) + c.f_n0[0];
    const double pull = spring * batch->closure_apart[i];
    double press = spring * (c.closure[0] + *ride) + c.f_n0[0], slip = 0, heat = 0;

    const tl_vec3 f = TL_TRIAL_AT(c, 0, along_spring);
    const double trial = tl_v3_norm(f);
    double limit = fmax(0, had * p->strength * area + (press - pull) * tangent);
    *glue = fibre < -p->strength * area || trial > limit ? 0 : had;
    limit = fmax(0, *glue * p->strength * area + (press - *glue * pull) * tangent);
    if (trial > limit * (1 + ROUNDING) && area > 0) {
        slip = (trial - limit) / (along_spring + (press > 0 ? spring * rise * tangent : 0));
        const double before = tl_v3_dot(TL_SHEAR_AT(c, 0), f) / trial;
        heat = 0.5 * (before + trial - along_spring * slip) * slip;
    }
    const double lift = press > 0 ? rise * slip : 0;
    *ride += lift;
    press += spring * lift;
    double total = press - *glue * pull;
    heat -= 0.5 * (c.f_n[0] + total) * lift;
    const bool open = total < 0 && *glue <= 0;
    if (had > *glue) { /* what pulled snaps, on the way from the stretch before */
        const double gone = pull - (open ? total : 0);
        heat += tl_law_snap_work(gone, spring, c.du_n[0]);
    }
    total = open ? 0 : total;
    const bool failed = p->strength > 0 && *glue <= 0;
    batch->flags[i] = (failed ? (uint32_t)TL_POINT_FAILED : 0u) | (open ? (uint32_t)TL_POINT_OPEN : 0u) |
                      (slip > 0 ? (uint32_t)TL_POINT_SLIPPING : 0u);
    c.f_n[0] = total;
    TL_PUT_SHEAR(c, 0, open ? 0 : trial > 0 ? (trial - along_spring * slip) / trial : 0, f);
    if (batch->dissipated)
        batch->dissipated[i] = fmax(0, heat);
    tl_law_store_energy(batch, i, 1, p->stiff, p->soft);
    if (batch->stored)
        batch->stored[i] += over(*glue * pull * press, spring);
}

static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    for (uint32_t i = 0; i < batch->count; i++)
        move(self, batch, i);
    return TL_OK;
}

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    const params *p = self;
    tl_law_lift(batch, p->stiff, batch->state[1], lift);
    for (uint32_t i = 0; i < batch->count; i++)
        hold[i] = batch->flags[i] & TL_POINT_APART || !(p->strength > 0) ? 0 : batch->state[0][i];
}

TL_LAW_STIFFNESS(params, stiff, soft);

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (p->climb <= p->angle)
        return tl_keep(p, sizeof *p, self, report);
    snprintf(report->text, sizeof report->text, "climb = %g deg must be <= angle = %g deg, or slip would make energy",
             p->climb, p->angle);
    return TL_E_ARGUMENT;
}

static const tl_law_ops ops = TL_LAW_OPS(.pulls = tl_pulls_bonded, .across_gap = across_gap, .linear = 1);

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "glue", .doc = "Brittle glue on walls that ride up.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(8, kind, .id = "elsewhere.glue", .version = "1", .doc = "A law from another folder.",
                .licence = "BSD-3-Clause");
