/* barton_bandis.c - law "barton_bandis": rough joints, by roughness (JRC), wall strength (JCS) and residual friction.
 *
 *     s = kni v / (1 - v / vm)                       normal stress; v = v0 + closure + opening, s(v0) A = f_n0
 *     JRC = JRC0 (L / L0)^(-0.02 JRC0),  JCS = JCS0 (L / L0)^(-0.03 JRC0)
 *     i = JRC log10(JCS / s),  from 0 to 70 deg - phi_r
 *     |f_s| <= A s tan(phi_r + m(u / u_peak) i) / reduction,    u_peak = L / 500 (JRC / L)^0.33
 *     opening += tan(m i / 2) slip                   while m > 0
 *
 * m is JRC_mob / JRC, a line through the points of `mobilised`; below u = 0.3 u_peak the angle rises from 0 to phi_r.
 * The displacement u is the length of the slip and the stretch of the shear spring. So a step of whatever length ends
 * on the curve. Beyond the stress `linear_from` closure is linear with the tangent there, which is the stiffness that
 * the time step needs.
 *
 * Source: Barton and Choubey, Rock Mech. 10 (1977) 1-54; Bandis, Lumsden and Barton, Int. J. Rock Mech. Min. Sci. 18
 * (1981) 1-21 and 20 (1983) 249-268; Barton, Bandis and Bakhtar, ibid. 22 (1985) 121-140.
 *
 * Energy turned to heat: the work of slip, less what it pays for opening the joint, tl_law_lift_work.
 *
 * Limits: slip back opens the joint further, and wears it as slip forth does. */
#include <talus/kit.h>
#include <talus/version.h>

#define LN10 2.30258509299404568402
/* Scaling a force down to its limit, and the slip that follows from it, leave it within some roundings of the limit;
 * without this margin a point at rest would be scaled down by them in every step. */
#define ROUNDING 1e-14
/* What the strength without roughness, which needs no logarithm, must exceed the shear stress by to be believed. */
#define SURE (1 - 1e-12)
/* Step of such a slip, over it, that is no step: the error is squared in each. */
#define FOUND 1e-9
/* Newton's passes for the slip that opens the joint and so raises its own strength. Those that have not met after them,
 * as after a step of many u_peak, do not open in that step. */
#define PASSES 5
/* Largest angle of friction with roughness, deg: Barton and Choubey. */
#define STEEPEST 70
/* Normal stress, Pa, whose logarithm is taken for those below. */
#define FAINT 1e-200
/* Largest stiffness, Pa/m, with which forces and energies stay finite. */
#define STIFFEST 1e50
/* Closure over vm up to which the stored energy is summed as a series: its closed form is a difference of like
 * numbers. */
#define SERIES 0.03125

typedef struct params {
    double jrc, jcs, phi_r, lab_length, length, kni, vm, ks, linear_from, reduction;
    int32_t dilation;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, jrc, "", "joint roughness coefficient of the length lab_length",
             .flags = TL_PARAM_REQUIRED, .min = 0, .max = 30),
    TL_PARAM_POSITIVE(params, jcs, "Pa", "joint wall compressive strength of the length lab_length"),
    TL_PARAM(TL_PARAM_REAL, params, phi_r, "deg", "residual angle of friction",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MAX_OPEN, .min = 0, .max = STEEPEST),
    TL_PARAM(TL_PARAM_REAL, params, lab_length, "m", "length L0 of the specimen of jrc and jcs", .def = {0.1},
             .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM_POSITIVE_OR_NONE(params, length, "m",
                              "length L of the joint between crossings, in metres whatever the other units, for the "
                              "peak's slip is an empirical formula; not given: lab_length"),
    TL_PARAM_STIFF(params, kni, "Pa/m", TL_PARAM_REQUIRED, "normal stiffness of the unloaded joint", .alias = "kn"),
    TL_PARAM_POSITIVE(params, vm, "m", "largest closure, from the unloaded joint"),
    TL_PARAM_STIFF(params, ks, "Pa/m", TL_PARAM_REQUIRED, "shear stiffness where nothing slips"),
    TL_PARAM_POSITIVE_OR_NONE(params, linear_from, "Pa",
                              "normal stress beyond which closure is linear; a smaller one allows a longer time "
                              "step; not given: the wall strength of the joint's length"),
    TL_PARAM(TL_PARAM_REAL, params, reduction, "", "the shear strength is divided by it", .def = {1},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH_DIVISOR, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_BOOL, params, dilation, "", "whether slip opens the joint", .def = {1}),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "slip", "m", "length of the slip so far"),
    TL_STATE(TL_STATE_SCALAR, "opening", "m", "how far slip has opened the joint", .transfer = TL_TRANSFER_LIFT),
};

typedef struct rough {
    double kni, vm, ks;
    double v_linear, s_linear, k_linear; /* where closure becomes linear: closure, stress, stiffness */
    double jrc, jcs;                     /* of the joint's length */
    double residual;                     /* rad */
    double tangent;                      /* of it */
    double per_peak;                     /* 1 / u_peak */
    double per_reduction, dilation;
} rough;

static double power(double x, double exponent)
{
    return x > 0 ? tl_lane_exp(exponent * tl_lane_log(x)) : 0;
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    double length = isnan(p->length) ? p->lab_length : p->length, ratio = length / p->lab_length;
    double jrc = p->jrc * power(ratio, -0.02 * p->jrc), jcs = p->jcs * power(ratio, -0.03 * p->jrc);
    double linear = isnan(p->linear_from) ? jcs : p->linear_from, unit = p->kni * p->vm;
    double k = p->kni * (1 + linear / unit) * (1 + linear / unit);
    double peak = length / 500 * power(jrc / length, 0.33);
    if (!(k <= STIFFEST))
        return tl_refuse(report,
                         "linear_from = %g Pa is too much for kni vm = %g Pa: the stiffness there, kni (1 + "
                         "linear_from / (kni vm))^2, must be at most %g Pa/m",
                         linear, unit, STIFFEST);
    const rough law = {.kni = p->kni,
                       .vm = p->vm,
                       .ks = p->ks,
                       .v_linear = linear * p->vm / (unit + linear),
                       .s_linear = linear,
                       .k_linear = k,
                       .jrc = jrc,
                       .jcs = jcs,
                       .residual = p->phi_r * TL_DEGREE,
                       .tangent = tl_lane_tan(p->phi_r * TL_DEGREE),
                       .per_peak = peak > 0 ? 1 / peak : 1e300, /* smooth: all at once */
                       .per_reduction = 1 / p->reduction,
                       .dilation = p->dilation ? 1 : 0};
    return tl_keep(&law, sizeof law, self, report);
}

/* ---------------------------------------------------------------- closure ---------------- */

/* Normal stress at a closure from the unloaded joint; 0 where it is open. */
TL_IN_LOOP double stress_at(const rough *law, double v)
{
    double curved = v < law->v_linear ? v : law->v_linear, beyond = v - curved;
    double stress = law->kni * curved / (1 - curved / law->vm) + law->k_linear * beyond;
    return v < 0 ? 0 : stress;
}

/* Its slope. */
TL_IN_LOOP double slope_at(const rough *law, double v)
{
    double curved = v < law->v_linear ? v : law->v_linear, open = 1 - curved / law->vm;
    return v < 0 ? 0 : law->kni / (open * open);
}

/* The closure of a stress, that of an initial force; one that pulls goes on with the stiffness kni. */
TL_IN_LOOP double closure_of(const rough *law, double stress)
{
    double curved = stress < law->s_linear ? stress : law->s_linear;
    double pressed = curved > 0 ? curved : 0;
    double v = pressed * law->vm / (law->kni * law->vm + pressed);
    return v + (curved - pressed) / law->kni + (stress - curved) / law->k_linear;
}

/* Energy stored per area. */
TL_IN_LOOP double energy_at(const rough *law, double v)
{
    double curved = v < law->v_linear ? v : law->v_linear, beyond = v - curved;
    double x = curved > 0 ? curved / law->vm : 0;
    double y = x < SERIES ? x : SERIES;
    double series =
        y * y *
        (1. / 2 +
         y * (1. / 3 +
              y * (1. / 4 + y * (1. / 5 + y * (1. / 6 + y * (1. / 7 + y * (1. / 8 + y * (1. / 9 + y * (1. / 10)))))))));
    double closed = -(x + tl_lane_log1p(-x));
    double hyperbola = law->kni * law->vm * law->vm * (x < SERIES ? series : closed);
    return hyperbola + beyond * (law->s_linear + 0.5 * law->k_linear * beyond);
}

/* ---------------------------------------------------------------- strength --------------- */

/* JRC_mob / JRC at x = u / u_peak; 0 up to 0.3. */
TL_IN_LOOP double mobilised(double x)
{
    double m = x > 0.3 ? (x - 0.3) * (0.75 / 0.3) : 0;
    m = x > 0.6 ? 0.75 + (x - 0.6) * (0.25 / 0.4) : m;
    m = x > 1 ? 1 - (x - 1) * 0.15 : m;
    m = x > 2 ? 0.85 - (x - 2) * (0.15 / 2) : m;
    m = x > 4 ? 0.7 - (x - 4) * (0.2 / 6) : m;
    m = x > 10 ? 0.5 - (x - 10) * (0.1 / 15) : m;
    m = x > 25 ? 0.4 - (x - 25) * (0.4 / 75) : m;
    return x >= 100 ? 0 : m;
}

/* The part i of the angle that is due to roughness, rad, before m. */
TL_IN_LOOP double roughness(const rough *law, double stress)
{
    double s = stress > FAINT ? stress : FAINT, most = STEEPEST * TL_DEGREE - law->residual;
    double i = law->jrc * TL_DEGREE / LN10 * tl_lane_log(law->jcs / s);
    i = i > 0 ? i : 0;
    return i < most ? i : most;
}

/* Strength at a normal stress, with `m` mobilised and the share `base` of the residual angle. */
TL_IN_LOOP double strength_at(const rough *law, double stress, double m, double base)
{
    double angle = base * law->residual + m * roughness(law, stress);
    return stress * tl_lane_tan(angle) * law->per_reduction;
}

/* How fast it rises with the stress. */
TL_IN_LOOP double rise_at(const rough *law, double stress, double m, double base)
{
    double i = roughness(law, stress), most = STEEPEST * TL_DEGREE - law->residual;
    double tangent = tl_lane_tan(base * law->residual + m * i);
    double falls = i < most ? m * law->jrc * TL_DEGREE / LN10 : 0;
    falls = i > 0 ? falls : 0;
    return (tangent - falls * (1 + tangent * tangent)) * law->per_reduction;
}

/* ---------------------------------------------------------------- update ----------------- */

/* What a step comes to: stresses are those of the area. */
typedef struct trial {
    tl_law_scratch walls, opening; /* closure v is their sum */
    tl_law_scratch v, x, y, z, shear, stress;
    tl_law_scratch before, m, base, limit, slip, lift;
} trial;

/* Stresses as if nothing slipped; whether some lane might be beyond its strength, of which this is the part without
 * roughness: tan x >= x below the residual angle. `limit` is that of lanes that do not slip. */
TL_IN_LOOP double press(const rough *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                        trial *restrict t)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict slip = batch->state[0] + begin;
    const double *restrict opening = batch->state[1] + begin;
    const rough law = *given;
    double near = 0;
#pragma omp simd reduction(+ : near)
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0, spring = law.ks * c.area[i];
        tl_vec3 f = TL_TRIAL_AT(c, i, spring);
        double shear = tl_v3_norm(f) * per;
        double walls = closure_of(&law, c.f_n0[i] * per) + c.closure[i], v = walls + opening[i];
        double stress = stress_at(&law, v);
        double u = (slip[i] + shear / law.ks) * law.per_peak;
        double base = u < 0.3 ? u / 0.3 : 1, m = mobilised(u);
        double tangent = u < 0.3 ? base * law.residual : law.tangent;
        near += shear > stress * tangent * law.per_reduction * SURE ? 1 : 0;
        t->walls[i] = walls;
        t->opening[i] = opening[i];
        t->v[i] = v;
        t->x[i] = f.x;
        t->y[i] = f.y;
        t->z[i] = f.z;
        t->shear[i] = shear;
        t->stress[i] = stress;
        t->before[i] = c.f_n[i] * per;
        t->m[i] = m;
        t->base[i] = base;
        t->limit[i] = shear;
        t->slip[i] = 0;
        t->lift[i] = 0;
    }
    return near;
}

/* The strength; whether some lane is beyond its own. */
TL_IN_LOOP double resist(const rough *given, uint32_t lanes, trial *restrict t)
{
    const rough law = *given;
    double beyond = 0;
#pragma omp simd reduction(+ : beyond)
    for (uint32_t i = 0; i < lanes; i++) {
        double limit = strength_at(&law, t->stress[i], t->m[i], t->base[i]);
        beyond += t->shear[i] > limit * (1 + ROUNDING) ? 1 : 0;
        t->limit[i] = limit;
    }
    return beyond;
}

/* One of Newton's passes for the slip of lanes that open by `opens` of it; how many have not found theirs. */
TL_IN_LOOP double pass(const rough *given, uint32_t lanes, const trial *restrict t, const double *restrict opens,
                       double *restrict slip, double *restrict found)
{
    const rough law = *given;
    double left = 0;
#pragma omp simd reduction(+ : left)
    for (uint32_t i = 0; i < lanes; i++) {
        double v = t->v[i] + opens[i] * slip[i], stress = stress_at(&law, v);
        double strength = strength_at(&law, stress, t->m[i], t->base[i]);
        double over = t->shear[i] - law.ks * slip[i] - strength;
        double rise = rise_at(&law, stress, t->m[i], t->base[i]) * slope_at(&law, v) * opens[i];
        double next = slip[i] + over / (law.ks + (rise > 0 ? rise : 0));
        next = next > 0 ? next : 0;
        double step = next > slip[i] ? next - slip[i] : slip[i] - next;
        double same = step > FOUND * next ? 0 : 1;
        slip[i] = found[i] > 0 ? slip[i] : next;
        found[i] = found[i] > 0 ? 1 : same;
        left += found[i] > 0 ? 0 : 1;
    }
    return left;
}

/* Slip of the lanes that are beyond their strength, how far it opens the joint, and the strength after it:
 * shear - ks slip = strength(s(v + d slip)). */
TL_IN_LOOP void rub(const rough *given, uint32_t lanes, trial *restrict t)
{
    const rough law = *given;
    tl_law_scratch opens, slip, found;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        /* walls that were pressed ride up from there, those that meet now, or hardly met, from what presses them now */
        double pressed = t->before[i] > t->stress[i] ? t->before[i] : t->stress[i];
        /* those that part in this step ride up while they are pressed */
        double before = closure_of(&law, t->before[i]), v = t->v[i], parts = before - v;
        double share = v < 0 ? before / (parts > 0 ? parts : 1) : 1;
        opens[i] = share * law.dilation * tl_lane_tan(0.5 * t->m[i] * roughness(&law, pressed));
        slip[i] = 0;
        found[i] = t->shear[i] > t->limit[i] * (1 + ROUNDING) ? 0 : 1;
    }
    for (int k = 0; k < PASSES && law.dilation > 0; k++)
        if (!(pass(given, lanes, t, opens, slip, found) > 0))
            break;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double limit = t->limit[i], shear = t->shear[i], lift = opens[i] * slip[i];
        double stress = stress_at(&law, t->walls[i] + (t->opening[i] + lift));
        double after = strength_at(&law, stress, t->m[i], t->base[i]);
        double met = t->before[i] > 0 ? 1 : 0, still = stress > 0 ? met : 0;
        double meets = t->v[i] >= 0 ? 1 : still;
        double slips = shear > limit * (1 + ROUNDING) ? meets : 0;
        double opened = slips * (after < shear ? 1 : 0);
        double reached = opened > 0 ? after : limit;
        t->lift[i] = opened > 0 ? lift : 0;
        t->stress[i] = opened > 0 ? stress : t->stress[i];
        t->limit[i] = reached;
        t->slip[i] = slips > 0 ? (shear - reached) / law.ks : 0;
    }
}

/* Forces, states, energies and flags; `mark` is for tl_law_put_flags. */
TL_IN_LOOP void settle(const rough *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                       const trial *restrict t, double *restrict mark, double *restrict stored,
                       double *restrict dissipated, const int slid, const int energy)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict slip = batch->state[0] + begin, *restrict opening = batch->state[1] + begin;
    const rough law = *given;
    const double half_s = 0.5 / law.ks;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double limit = t->limit[i], shear = t->shear[i], opened = t->opening[i] + t->lift[i];
        double v = t->walls[i] + opened;
        double slips = shear > limit * (1 + ROUNDING) ? 1 : 0, whole = shear * c.area[i];
        double scale = slips > 0 ? limit / (slips > 0 ? shear : 1) : 1, after = scale * shear;
        tl_vec3 f = {t->x[i], t->y[i], t->z[i]};
        if (energy) {
            double held = energy_at(&law, v), paid = 0;
            if (slid) {
                double rise = held - energy_at(&law, t->v[i]), from = stress_at(&law, t->v[i]);
                double per = c.area[i] > 0 ? 1 / c.area[i] : 0;
                paid = c.area[i] * tl_law_lift_work(rise, c.f_n[i] * per, from, t->lift[i]);
            }
            double along = tl_v3_dot(TL_SHEAR_AT(c, i), f);
            double mean = 0.5 * (along / (whole > 0 ? whole : 1) + limit * c.area[i]);
            double work = mean * (shear - limit) / law.ks;
            double heat = slips > 0 ? work - paid : 0;
            dissipated[i] = heat > 0 ? heat : 0;
            stored[i] = c.area[i] * (held + half_s * after * after);
        }
        mark[i] = v < 0 ? TL_POINT_OPEN : slips * TL_POINT_SLIPPING;
        c.f_n[i] = c.area[i] * t->stress[i];
        TL_PUT_SHEAR(c, i, scale, f);
        slip[i] = slip[i] + t->slip[i];
        opening[i] = opened;
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    tl_law_scratch mark, stored, dissipated;
    trial t;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LAW_STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < TL_LAW_STRIDE ? left : TL_LAW_STRIDE;
        double *held = batch->stored ? batch->stored + begin : stored;
        double *heat = batch->dissipated ? batch->dissipated + begin : dissipated;
        bool near = press(self, batch, begin, lanes, &t) > 0;
        bool slid = near && resist(self, lanes, &t) > 0, energy = batch->stored || batch->dissipated;
        if (slid)
            rub(self, lanes, &t);
        if (slid && energy)
            settle(self, batch, begin, lanes, &t, mark, held, heat, 1, 1);
        else if (slid)
            settle(self, batch, begin, lanes, &t, mark, held, heat, 1, 0);
        else if (energy)
            settle(self, batch, begin, lanes, &t, mark, held, heat, 0, 1);
        else
            settle(self, batch, begin, lanes, &t, mark, held, heat, 0, 0);
        tl_law_put_flags(batch, begin, lanes, mark);
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(rough, k_linear, ks);

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    for (uint32_t i = 0; i < batch->count; i++) {
        double area = batch->area[i], stress = batch->f_n0[i] / (area > 0 ? area : 1);
        lift[i] = closure_of(self, stress) + batch->state[1][i];
    }
    tl_law_hold_none(batch, hold);
}

/* Energy and force of the springs that press. */
static void pressed(const void *self, const tl_law_batch *batch, double *energy)
{
    const rough law = *(const rough *)self;
    const double *restrict opening = batch->state[1];
#pragma omp simd
    for (uint32_t i = 0; i < batch->count; i++) {
        double area = batch->area[i], per = area > 0 ? 1 / area : 0;
        double v = closure_of(&law, batch->f_n0[i] * per) + batch->closure[i] + opening[i];
        energy[i] = v > 0 ? area * energy_at(&law, v) : 0;
        batch->f_n[i] = v > 0 ? area * stress_at(&law, v) : 0;
    }
}

static const tl_law_ops ops =
    TL_LAW_OPS(.never_fails = 1, .pulls = tl_pulls_none, .across_gap = across_gap, .pressed = pressed);

static const tl_kind kind =
    TL_KIND(TL_KIND_LAW, ops, .name = "barton_bandis",
            .doc = "Rough joints: hyperbolic closure, and friction from roughness and wall strength that "
                   "slip wears down.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.barton_bandis", .version = TALUS_VERSION, .doc = "Joint law of Barton and Bandis.",
          .licence = "BSD-3-Clause");
