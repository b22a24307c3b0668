/* my_law.c - law "my_law": Coulomb friction that falls while the joint slips.
 *
 *     f_n = kn A closure + f_n0,  f_n < 0: open, both forces 0
 *     tan phi = tan residual + (tan peak - tan residual) max(0, 1 - slip / distance)
 *     |f_s| <= f_n tan phi;  slip grows by the part of the motion that the spring does not take
 *
 * Compression is positive. The friction is that at the end of the step, so a step without motion changes nothing: with
 * limit = f_n tan phi at its beginning and soft = f_n (tan peak - tan residual) / distance, slip grows by (|f_t| -
 * limit) / (ks A - soft). Where the friction falls faster than the spring unloads, it falls to the residual one at
 * once. */
#include <talus/kit.h>

/* What a script gives; the host fills it in from the table below, checked and with defaults. */
typedef struct params {
    double kn, ks, peak, residual, distance;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    TL_PARAM(TL_PARAM_REAL, params, peak, "deg", "angle of friction before slip", .alias = "friction",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MAX_OPEN | TL_PARAM_STRENGTH_ANGLE, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, residual, "deg", "angle of friction after the whole distance",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MAX_OPEN | TL_PARAM_STRENGTH_ANGLE, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, distance, "m", "slip over which the friction falls", .flags = TL_PARAM_MIN_OPEN,
             .def = {0.01}, .min = 0, .max = INFINITY),
};

/* What a contact point remembers; the host owns it, carries it over and writes it into files. */
static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "slip", "m", "length of the slip so far"),
};

/* Slip of a step in which the spring alone would take the force `trial`, above `limit`, N. `soft`: by how much the
 * limit falls for a metre of slip, N/m; `lowest`: the limit after the whole distance. */
static double slip_of(double trial, double limit, double lowest, double stiffness, double soft)
{
    double to_lowest = (trial - lowest) / stiffness;
    if (soft >= stiffness)
        return to_lowest;
    double slip = (trial - limit) / (stiffness - soft);
    return slip < to_lowest ? slip : to_lowest;
}

/* Called by several threads at once: a pure function of what it is given. */
static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    const double low = tl_tan(p->residual * TL_DEGREE);
    const double drop = fmax(0, tl_tan(p->peak * TL_DEGREE) - low);
    double *slip = batch->state[0];
    for (uint32_t i = 0; i < batch->count; i++) {
        double area = batch->area[i], stiffness = p->ks * area;
        double normal = p->kn * area * batch->closure[i] + batch->f_n0[i], f[3];
        double f_n = fmax(0, normal), along = 0, moved = 0;
        for (int k = 0; k < 3; k++)
            f[k] = batch->f_s[k][i] - stiffness * batch->du_s[k][i];
        double trial = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        double left = fmax(0, 1 - slip[i] / p->distance), limit = f_n * (low + drop * left);
        double f_s = trial;
        /* a padding lane has area 0: it must neither divide by it nor slip; 1e-12 keeps rounding from counting as
         * slip */
        if (trial > limit * (1 + 1e-12) && stiffness > 0) {
            double soft = left > 0 ? f_n * drop / p->distance : 0;
            moved = f_n > 0 ? slip_of(trial, limit, f_n * low, stiffness, soft) : trial / stiffness;
            f_s = f_n > 0 ? trial - stiffness * moved : 0; /* an open point lets go of all */
            for (int k = 0; k < 3; k++)
                along += batch->f_s[k][i] * f[k] / trial; /* the force before, along the slip */
        }
        slip[i] += f_n > 0 ? moved : 0;
        batch->flags[i] = normal < 0 ? TL_POINT_OPEN : moved > 0 ? TL_POINT_SLIPPING : 0;
        batch->f_n[i] = f_n;
        for (int k = 0; k < 3; k++)
            batch->f_s[k][i] = trial > 0 ? f[k] * (f_s / trial) : 0;
        if (batch->stored)
            batch->stored[i] = area > 0 ? f_n * f_n / (2 * p->kn * area) + f_s * f_s / (2 * stiffness) : 0;
        if (batch->dissipated)
            batch->dissipated[i] = fmax(0, moved * (along + f_s) / 2);
    }
    return TL_OK;
}

/* Upper bounds, Pa/m: the time step follows from them. */
static void stiffness(const void *self, double *kn, double *ks)
{
    const params *p = self;
    *kn = p->kn;
    *ks = p->ks;
}

/* No normal force across a gap. */
static const tl_law_ops ops = {
    .size = sizeof ops, .update = update, .stiffness = stiffness, .linear = 1, .pulls = tl_pulls_none};

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "my_law", .doc = "Coulomb friction that falls with slip.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "example.my_law", .version = "1.0", .doc = "A slip-weakening joint law.",
          .licence = "BSD-3-Clause");
