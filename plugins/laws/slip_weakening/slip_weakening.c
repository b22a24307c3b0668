/* slip_weakening.c - law "slip_weakening": a joint that loses strength while it slips, and may heal.
 *
 *     f_n = max(0, kn A closure + f_n0)                      total, compression positive
 *     f_t = f_s - ks A du_s                                  on block B
 *     strength(s) = c_r A + f_n tan(phi_r) + w(s) ((c - c_r) A + f_n (tan phi - tan phi_r))
 *     w(s) = max(0, 1 - s / D_c)  or  exp(-s / D_c)          linear, exponential
 *     |f_t| > strength:  |f_s| = strength(s + ds) = |f_t| - ks A ds,   s += ds
 *
 * The slip s of a step is the one at whose end the strength is met. So the force lies on the curve at any length of
 * step. Where the strength falls faster than the spring, ks < (c - c_r + s_n (tan phi - tan phi_r)) / D_c, it cannot:
 * the point then falls to the next crossing of the two within the step, and what the spring gives off beyond the
 * strength is heat.
 *
 * Healing of a point that does not slip: s goes back to 0 at once, or shrinks by exp(-t / healing_time). With healing s
 * is no more than D_c in the linear form. It changes the strength only, so it makes no energy.
 *
 * Source: Ida, J. Geophys. Res. 77 (1972) 3796-3805; Andrews, J. Geophys. Res. 81 (1976) 5679-5687; stability after
 * Rice, Pure Appl. Geophys. 121 (1983) 443-475. */
#include <talus/kit.h>
#include <talus/version.h>

/* Share of the strength that a bound of it is trusted by: their roundings differ. */
#define SURE (1 - 1e-12)
/* Step of Newton's search, over D_c, that is no step: the error is squared in each. */
#define FOUND 1e-9
/* Newton's passes for the slip of the exponential form: the start is within a quarter of it, and the error is
 * squared. */
#define PASSES 6
/* Share of D_c below which slip that heals is gone: its strength is lost in rounding. */
#define HEALED 1e-16

enum { LINEAR, EXPONENTIAL };
enum { HEAL_NONE, HEAL_INSTANT, HEAL_TIME };
static const char *const forms[] = {[LINEAR] = "linear", [EXPONENTIAL] = "exponential", NULL};
static const char *const healings[] = {[HEAL_NONE] = "none", [HEAL_INSTANT] = "instant", [HEAL_TIME] = "time", NULL};

typedef struct params {
    double kn, ks, friction, cohesion, residual_friction, residual_cohesion, distance;
    int32_t form, healing;
    double healing_time;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    TL_PARAM_FRICTION(params, friction, TL_PARAM_REQUIRED,
                      "angle of friction before slip; 90: none while it is closed"),
    TL_PARAM_STRONG(params, cohesion, "Pa", "cohesion before slip"),
    TL_PARAM_FRICTION(params, residual_friction, TL_PARAM_OPTIONAL,
                      "angle of friction after slip, at most friction; not given: friction"),
    TL_PARAM_STRONG(params, residual_cohesion, "Pa", "cohesion after slip, at most cohesion"),
    TL_PARAM_POSITIVE(params, distance, "m",
                      "slip D_c over which the strength falls: all of it, or in the exponential form all but 1/e"),
    TL_PARAM(TL_PARAM_ENUM, params, form, "", "how the strength falls with slip", .def = {LINEAR}, .choices = forms),
    TL_PARAM(TL_PARAM_ENUM, params, healing, "",
             "whether strength comes back where slip has ended: never, at once, or in time", .def = {HEAL_NONE},
             .choices = healings),
    TL_PARAM_POSITIVE_OR_NONE(params, healing_time, "s",
                              "for healing = \"time\": time in which all but 1/e of the lost strength comes back"),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "slip", "m", "length of the slip so far, less what has healed"),
};

typedef struct weakening {
    double kn, ks;
    double tangent, cohesion;           /* residual */
    double tangent_drop, cohesion_drop; /* what is lost */
    double distance, healing_time;
    int form, healing;
} weakening;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    double residual = isnan(p->residual_friction) ? p->friction : p->residual_friction;
    if (residual > p->friction)
        return tl_refuse(report, "residual_friction = %g deg must be <= friction = %g deg", residual, p->friction);
    if (p->residual_cohesion > p->cohesion)
        return tl_refuse(report, "residual_cohesion = %g Pa must be <= cohesion = %g Pa", p->residual_cohesion,
                         p->cohesion);
    if (p->healing == HEAL_TIME && isnan(p->healing_time))
        return tl_refuse(report, "healing = \"time\" needs healing_time, in s");
    if (p->healing != HEAL_TIME && !isnan(p->healing_time))
        return tl_refuse(report, "healing_time is given, but healing is \"%s\"", healings[p->healing]);
    double tangent = tl_tan(residual * TL_DEGREE);
    const weakening law = {.kn = p->kn,
                           .ks = p->ks,
                           .tangent = tangent,
                           .cohesion = p->residual_cohesion,
                           .tangent_drop = tl_tan(p->friction * TL_DEGREE) - tangent,
                           .cohesion_drop = p->cohesion - p->residual_cohesion,
                           .distance = p->distance,
                           .healing_time = p->healing_time,
                           .form = p->form,
                           .healing = p->healing};
    return tl_keep(&law, sizeof law, self, report);
}

/* Share of the drop that is left after a slip. */
TL_IN_LOOP double left_of(const int form, double per_distance, double slip)
{
    double linear = 1 - slip * per_distance;
    if (form == EXPONENTIAL)
        return tl_lane_exp(-slip * per_distance);
    return linear > 0 ? linear : 0;
}

/* Slip over D_c at which the linear strength meets the spring. Both are over the spring's force of D_c: `above` is the
 * spring less the residual, `drop` what is left to lose, and above > drop. */
TL_IN_LOOP double linear_slip(double above, double drop, double room, double slope)
{
    double steep = 1 - slope;
    double soon = steep > 0 ? (above - drop) / (steep > 0 ? steep : 1) : above;
    soon = soon <= room ? soon : above;
    return steep > 0 ? soon : above;
}

/* Where Newton's search for the same of the exponential strength begins. It is the root of g(x) = above - x - drop
 * exp(-x), which is concave, so that steps from beyond the root stay beyond it. The start replaces exp(-x) by 1 - x +
 * x^2/3, which is less up to x = 1. */
TL_IN_LOOP double exponential_start(double above, double drop)
{
    double b = 1 - drop, over = above - drop, q = drop * (1. / 3);
    over = over > 0 ? over : 0;
    double root = sqrt(b * b + 4 * q * over), sum = b + root;
    double by_sum = 2 * over / (sum > 0 ? sum : 1);
    double by_difference = (root - b) / (q > 0 ? 2 * q : 1);
    double near = b > 0 ? by_sum : by_difference;
    double start = near < above ? near : above;
    return near <= 1 ? start : above;
}

/* One of its passes; how many lanes have not found their root. They stay at one that they have found, so that it does
 * not matter which others they are with. */
TL_IN_LOOP double exponential_pass(const double *restrict above, const double *restrict drop, double *restrict x,
                                   double *restrict found, uint32_t lanes)
{
    double left = 0;
#pragma omp simd reduction(+ : left)
    for (uint32_t i = 0; i < lanes; i++) {
        double falls = drop[i] * tl_lane_exp(-x[i]), slope = falls - 1;
        double next = x[i] - (above[i] - x[i] - falls) / (slope < 0 ? slope : -1);
        next = next > 0 ? next : x[i];
        next = slope < 0 ? next : x[i];
        double step = next > x[i] ? next - x[i] : x[i] - next, same = step > FOUND * next ? 0 : 1;
        x[i] = found[i] > 0 ? x[i] : next;
        found[i] = found[i] > 0 ? 1 : same;
        left += found[i] > 0 ? 0 : 1;
    }
    return left;
}

/* What a step comes to before slip is looked at. */
typedef struct trial {
    tl_law_scratch total, x, y, z, shear;
    tl_law_scratch residual, drop, limit, slip;
} trial;

/* Share of the drop that is left, or less: exp(-x) >= 1 - x needs no exponential. */
TL_IN_LOOP double least_left_of(const int form, double per_distance, double slip)
{
    double least = left_of(LINEAR, per_distance, slip);
    return form == EXPONENTIAL ? SURE * least : least;
}

/* Forces as if nothing slipped, and the least strength; whether some lane is beyond it. */
TL_IN_LOOP double press(const weakening *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                        trial *restrict t, const int form)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict slip = batch->state[0] + begin;
    const double kn = law->kn, ks = law->ks, tangent = law->tangent, cohesion = law->cohesion;
    const double tangent_drop = law->tangent_drop, cohesion_drop = law->cohesion_drop;
    const double per_distance = 1 / law->distance;
    double beyond = 0;
#pragma omp simd reduction(+ : beyond)
    for (uint32_t i = 0; i < lanes; i++) {
        double stiffness = ks * c.area[i], total = kn * c.area[i] * c.closure[i] + c.f_n0[i];
        tl_vec3 f = TL_TRIAL_AT(c, i, stiffness);
        double shear = tl_v3_norm(f);
        double normal = total < 0 ? 0 : total;
        double residual = total < 0 ? 0 : cohesion * c.area[i] + normal * tangent;
        double drop = total < 0 ? 0 : cohesion_drop * c.area[i] + normal * tangent_drop;
        double limit = residual + least_left_of(form, per_distance, slip[i]) * drop;
        beyond += shear > TL_LAW_MOST(limit) ? 1 : 0;
        t->total[i] = total;
        t->x[i] = f.x;
        t->y[i] = f.y;
        t->z[i] = f.z;
        t->shear[i] = shear;
        t->residual[i] = residual;
        t->drop[i] = drop;
        t->limit[i] = limit;
        t->slip[i] = slip[i];
    }
    return beyond;
}

/* The strength of the exponential form; whether some lane is beyond it. */
TL_IN_LOOP double resist(const weakening *law, uint32_t lanes, trial *restrict t)
{
    const double per_distance = 1 / law->distance;
    double beyond = 0;
#pragma omp simd reduction(+ : beyond)
    for (uint32_t i = 0; i < lanes; i++) {
        double limit = t->residual[i] + left_of(EXPONENTIAL, per_distance, t->slip[i]) * t->drop[i];
        beyond += t->shear[i] > TL_LAW_MOST(limit) ? 1 : 0;
        t->limit[i] = limit;
    }
    return beyond;
}

/* Slip of the lanes that are beyond their strength, and the strength after it. Open points do not rub. */
TL_IN_LOOP void rub(const weakening *law, const double *restrict area, uint32_t lanes, trial *restrict t,
                    const int form)
{
    const double distance = law->distance, per_distance = 1 / law->distance, ks = law->ks;
    tl_law_scratch above, drop, grown, found;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double spring = ks * area[i] * distance, per = spring > 0 ? 1 / (spring > 0 ? spring : 1) : 0;
        double left = left_of(form, per_distance, t->slip[i]), most = t->drop[i] * per;
        above[i] = (t->shear[i] - t->residual[i]) * per;
        drop[i] = most * left;
        grown[i] = form == EXPONENTIAL ? exponential_start(above[i], drop[i])
                                       : linear_slip(above[i], drop[i], left, left > 0 ? most : 0);
        found[i] = t->shear[i] > TL_LAW_MOST(t->limit[i]) ? 0 : 1;
    }
    for (int k = 0; form == EXPONENTIAL && k < PASSES; k++)
        if (!(exponential_pass(above, drop, grown, found, lanes) > 0))
            break;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double limit = t->limit[i], slip = t->slip[i] + grown[i] * distance;
        double after = t->residual[i] + left_of(form, per_distance, slip) * t->drop[i];
        double slips = t->total[i] >= 0 ? 1 : 0;
        slips = t->shear[i] > TL_LAW_MOST(limit) ? slips : 0;
        t->slip[i] = slips > 0 ? slip : t->slip[i];
        t->limit[i] = slips > 0 ? after : limit;
    }
}

/* Forces, heat and flags; `mark` is for tl_law_put_flags. */
TL_IN_LOOP void settle(const weakening *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                       const trial *restrict t, double *restrict mark, const int heat)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict slip = batch->state[0] + begin;
    double *restrict dissipated = heat ? batch->dissipated + begin : NULL;
    const double ks = law->ks;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double limit = t->limit[i], shear = t->shear[i], most = TL_LAW_MOST(limit);
        double scale = tl_law_scale(shear, limit);
        tl_vec3 f = {t->x[i], t->y[i], t->z[i]};
        if (heat) {
            double along = tl_v3_dot(TL_SHEAR_AT(c, i), f);
            double mean = 0.5 * (along / (shear > most ? shear : 1) + limit), stiffness = ks * c.area[i];
            double work = mean * (shear - limit) / (stiffness > 0 ? stiffness : 1);
            work = stiffness > 0 ? work : 0;
            work = shear > most ? work : 0;
            dissipated[i] = work > 0 ? work : 0;
        }
        double flag = shear > most ? TL_POINT_SLIPPING : 0;
        mark[i] = t->total[i] < 0 ? TL_POINT_OPEN : flag;
        c.f_n[i] = t->total[i] < 0 ? 0 : t->total[i];
        TL_PUT_SHEAR(c, i, scale, f);
        slip[i] = t->slip[i];
    }
}

/* Strength that comes back in a step: slip of points that do not slip in it. */
TL_IN_LOOP void heal(const weakening *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                     const double *restrict mark)
{
    double *restrict slip = batch->state[0] + begin;
    const double factor = law->healing == HEAL_TIME ? tl_lane_exp(-batch->dt / law->healing_time) : 0;
    const double most = law->form == LINEAR ? law->distance : INFINITY;
    const double least = HEALED * law->distance;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double kept = slip[i] < most ? slip[i] : most;
        double healed = kept * factor;
        healed = healed > least ? healed : 0;
        slip[i] = mark[i] == TL_POINT_SLIPPING ? kept : healed;
    }
}

TL_IN_LOOP void update_lanes(const weakening *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                             const int form)
{
    trial t;
    tl_law_scratch mark;
    bool near = press(law, batch, begin, lanes, &t, form) > 0;
    if (near && (form == LINEAR || resist(law, lanes, &t) > 0))
        rub(law, batch->area + begin, lanes, &t, form);
    if (batch->dissipated)
        settle(law, batch, begin, lanes, &t, mark, 1);
    else
        settle(law, batch, begin, lanes, &t, mark, 0);
    if (law->healing != HEAL_NONE)
        heal(law, batch, begin, lanes, mark);
    tl_law_put_flags(batch, begin, lanes, mark);
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const weakening *law = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LAW_STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < TL_LAW_STRIDE ? left : TL_LAW_STRIDE;
        if (law->form == EXPONENTIAL)
            update_lanes(law, batch, begin, lanes, EXPONENTIAL);
        else
            update_lanes(law, batch, begin, lanes, LINEAR);
        tl_law_store_energy(batch, begin, lanes, law->kn, law->ks);
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(weakening, kn, ks);

static const tl_law_ops ops = TL_LAW_OPS(.never_fails = 1, .linear = 1, .pulls = tl_pulls_none);

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "slip_weakening",
                                    .doc = "Friction and cohesion that fall with slip, and may heal where it ends.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.slip_weakening", .version = TALUS_VERSION, .doc = "Slip-weakening joint law.",
          .licence = "BSD-3-Clause");
