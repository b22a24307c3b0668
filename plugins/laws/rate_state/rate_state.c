/* rate_state.c - law "rate_state": friction that depends on the rate of slip and on a state of the surface.
 *
 *     f_n = max(0, kn A closure + f_n0)                      total, compression positive
 *     |f_s| / A = s mu(V, theta) + eta V,  s = f_n / A       V: rate of slip, along the shear force
 *     mu = a arsinh(V / (2 V0) exp((mu0 + b ln(V0 theta / D_c)) / a))
 *     theta' = 1 - V theta / D_c              aging;     theta' = -(V theta / D_c) ln(V theta / D_c)      slip
 *     f_s <- f_s - ks A (du_s - V dt)
 *
 * For V > 0 this is mu0 + a ln(V / V0) + b ln(V0 theta / D_c), regularised at V = 0. A state goes on by the exact
 * solution at its V. The force of a step is that of the state in its middle, reached with the rate of the step itself.
 * So slip of many D_c in a step keeps to steady friction. V follows from y, with E = (mu0 + b ln(V0 theta / D_c)) / a
 * at the beginning:
 *
 *     V = V0 (exp(y - E) - exp(-y - E)),    s mu + (ks dt + eta) V = |f_t| / A
 *
 * by Newton's steps from the rate of the step before, kept between bounds that close in on a root.
 *
 * In a step without time, as those of a relaxation are, what moves slips at V0: |f_s| / A <= s mu(V0, theta) + eta V0,
 * and the state goes on for the time that the slip takes at V0. It does not age.
 *
 * Source: Dieterich, J. Geophys. Res. 84 (1979) 2161-2168; Ruina, J. Geophys. Res. 88 (1983) 10359-10370; the form with
 * arsinh after Rice and Ben-Zion, Proc. Natl. Acad. Sci. 93 (1996) 3811-3818; eta: Rice, J. Geophys. Res. 98 (1993)
 * 9885-9907.
 *
 * Limit: slip never ends, so a joint under shear stress creeps. Scaled masses falsify the rates. */
#include <talus/kit.h>
#include <talus/version.h>

/* Newton's passes at most: 4 do in steady slip, and some 50 halve the bounds to nothing. A lane that has found its root
 * stays there, so that it does not matter which others it is with. */
#define PASSES 60
/* Step of y, which is about ln V, that is no step. */
#define FOUND 1e-12
/* Step of Newton that squares to no step. */
#define NEAR 1e-7
/* Slip of a half step over D_c below which the exact solution is summed as a series. */
#define SERIES 1e-3
/* Least rate over V0 whose logarithm is taken. */
#define SLOWEST 1e-100

enum { AGING, SLIP };
static const char *const evolutions[] = {[AGING] = "aging", [SLIP] = "slip", NULL};

typedef struct params {
    double kn, ks, mu0, a, b, distance, velocity, damping, theta;
    int32_t evolution;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    TL_PARAM(TL_PARAM_REAL, params, mu0, "", "coefficient of friction in steady slip at `velocity`", .def = {0.6},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH, .min = 0, .max = 10),
    TL_PARAM(TL_PARAM_REAL, params, a, "", "direct effect of the rate",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH, .min = 0, .max = 1),
    TL_PARAM(TL_PARAM_REAL, params, b, "", "effect of the state; b > a weakens with the rate",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_STRENGTH, .min = 0, .max = 1),
    TL_PARAM_POSITIVE(params, distance, "m", "slip D_c over which the state changes", .alias = "dc"),
    TL_PARAM(TL_PARAM_REAL, params, velocity, "m/s", "reference rate V0", .alias = "v0", .def = {1e-6},
             .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM_NOT_NEGATIVE(params, damping, "Pa s/m",
                          "viscous part eta: shear modulus over twice the speed of shear waves, where blocks do "
                          "not radiate themselves"),
    TL_PARAM_POSITIVE_OR_NONE(params, theta, "s",
                              "state of a new contact; not given: distance / velocity, that of steady slip"),
    TL_PARAM(TL_PARAM_ENUM, params, evolution, "", "how the state changes: it also ages at rest, or with slip only",
             .def = {AGING}, .choices = evolutions),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "theta", "s", "state of the surface; 0 before the first step"),
    TL_STATE(TL_STATE_SCALAR, "slip_rate", "m/s", "rate of slip in the last step"),
};

static tl_status create(const void *given, void **self, tl_report *report)
{
    params law = *(const params *)given;
    if (isnan(law.theta))
        law.theta = law.distance / law.velocity;
    return tl_keep(&law, sizeof law, self, report);
}

/* (1 - exp(-x)) / x */
TL_IN_LOOP double mean_decay(double x, double decay)
{
    double series = 1 - x * (1. / 2 - x * (1. / 6 - x * (1. / 24 - x * (1. / 120))));
    return x < SERIES ? series : (1 - decay) / (x < SERIES ? 1 : x);
}

/* The state after `time` at a rate of slip. */
TL_IN_LOOP double go_on(const int evolution, double distance, double theta, double rate, double time)
{
    double x = rate * time / distance, decay = tl_lane_exp(-x);
    if (evolution == AGING)
        return theta * decay + time * mean_decay(x, decay);
    double least = SLOWEST, ratio = rate * theta / distance;
    ratio = ratio > least ? ratio : least;
    return theta * tl_lane_exp((decay - 1) * tl_lane_log(ratio));
}

/* d ln theta / d ln V of that, from -1 in steady slip to 0. */
TL_IN_LOOP double answer(const int evolution, double distance, double theta, double rate, double time)
{
    double x = rate * time / distance, decay = tl_lane_exp(-x);
    if (evolution == AGING) {
        double mean = mean_decay(x, decay);
        double near = x < SERIES ? x * (1. / 2 - x * (1. / 3 - x * (1. / 8))) : mean - decay;
        return -(x * theta * decay + time * near) / (theta * decay + time * mean);
    }
    double least = SLOWEST, ratio = rate * theta / distance;
    ratio = ratio > least ? ratio : least;
    return decay - 1 - x * decay * tl_lane_log(ratio);
}

/* What a step comes to before slip; stresses are those of the area. */
typedef struct trial {
    tl_law_scratch total, x, y, z, shear;
    tl_law_scratch theta, effect, exponent, rate, time;
    tl_law_scratch root, low, high, found;
} trial;

/* Forces as if nothing slipped, and the bounds of y: no slip, and as much as leaves no stress. How many lanes carry
 * shear. */
TL_IN_LOOP double press(const params *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                        trial *restrict t)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict state = batch->state[0] + begin;
    const double *restrict rate = batch->state[1] + begin;
    const params law = *given;
    const double slows = law.ks * batch->dt + law.damping;
    const double per_velocity = law.velocity / law.distance;
    double busy = 0;
#pragma omp simd reduction(+ : busy)
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0, spring = law.ks * c.area[i];
        double total = law.kn * c.area[i] * c.closure[i] + c.f_n0[i];
        tl_vec3 f = TL_TRIAL_AT(c, i, spring);
        double shear = tl_v3_norm(f) * per;
        double theta = state[i] > 0 ? state[i] : law.theta;
        double effect = total > 0 ? law.a * total * per : 0;
        double exponent = (law.mu0 + law.b * tl_lane_log(theta * per_velocity)) / law.a;
        /* arsinh(z exp E), for the bound and for the rate of the step before */
        double viscous = 0.5 * shear / (slows > 0 ? slows * law.velocity : 1);
        double before = 0.5 * rate[i] / law.velocity, small = tl_lane_exp(-2 * exponent);
        double most = viscous + sqrt(viscous * viscous + small);
        double last = before + sqrt(before * before + small);
        double high = exponent + tl_lane_log(most > SLOWEST ? most : SLOWEST);
        double root = exponent + tl_lane_log(last > SLOWEST ? last : SLOWEST);
        high = high > 0 ? high : 0;
        root = root > 0 ? root : 0;
        t->total[i] = total;
        t->x[i] = f.x;
        t->y[i] = f.y;
        t->z[i] = f.z;
        t->shear[i] = shear;
        t->theta[i] = theta;
        t->effect[i] = effect;
        t->exponent[i] = exponent;
        t->low[i] = 0;
        t->high[i] = high;
        /* no more than would carry the stress without slip in this step: a point at rest has slowed down since the
         * last */
        double still = shear / (effect > 0 ? effect : 1);
        root = root < still ? root : still;
        t->root[i] = root < high ? root : high;
        double idle = effect > 0 ? 0 : 1;
        t->found[i] = shear > 0 ? idle : 1;
        busy += t->found[i] > 0 ? 0 : 1;
    }
    return busy;
}

/* One of Newton's passes; how many lanes have not found their root. */
TL_IN_LOOP double pass(const params *given, double dt, uint32_t lanes, trial *restrict t, const int evolution)
{
    const params law = *given;
    const double slows = law.ks * dt + law.damping, half = 0.5 * dt, share = law.b / law.a;
    double left = 0;
#pragma omp simd reduction(+ : left)
    for (uint32_t i = 0; i < lanes; i++) {
        double y = t->root[i], e = t->exponent[i], start = t->theta[i];
        double twice = tl_lane_exp(-2 * y), up = tl_lane_exp(y - e), down = up * twice;
        double rate = law.velocity * (up - down);
        double theta = go_on(evolution, law.distance, start, rate, half);
        double aged = share * tl_lane_log(theta / start);
        /* arsinh(exp(aged) sinh y) */
        double sine = 0.5 * (1 - twice);
        double sum = sqrt(sine * sine + tl_lane_exp(-2 * (y + aged)));
        double arsinh = y + aged + tl_lane_log(sine + sum);
        double over = t->effect[i] * arsinh + slows * rate - t->shear[i];
        double rise = 1 + share * answer(evolution, law.distance, start, rate, half);
        double slope = t->effect[i] * 0.5 * (1 + twice) * rise / sum + slows * law.velocity * (up + down);
        double low = over < 0 ? y : t->low[i], high = over < 0 ? t->high[i] : y;
        double next = y - over / (slope > 0 ? slope : 1);
        double inside = slope > 0 ? 1 : 0;
        inside = next >= low ? inside : 0;
        inside = next <= high ? inside : 0;
        next = inside > 0 ? next : 0.5 * (low + high);
        double step = next > y ? next - y : y - next;
        double moves = t->found[i] > 0 ? 0 : 1;
        t->root[i] = moves > 0 ? next : y;
        t->low[i] = low;
        t->high[i] = high;
        t->found[i] = step > (inside > 0 ? NEAR : FOUND) ? t->found[i] : 1;
        left += t->found[i] > 0 ? 0 : 1;
    }
    return left;
}

/* The rate of slip of each lane, 0 of open ones, in a step that takes time. */
TL_IN_LOOP void find_rates(const params *given, double dt, uint32_t lanes, trial *restrict t)
{
    const double velocity = given->velocity, slows = given->ks * dt + given->damping;
    const double most = slows > 0 ? 1 / slows : 0;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double y = t->root[i], e = t->exponent[i], slides = t->shear[i] > 0 ? 1 : 0;
        double rate = slides * velocity * (tl_lane_exp(y - e) - tl_lane_exp(-y - e));
        double limit = t->shear[i] * most;
        rate = rate < limit ? rate : limit; /* the stress does not change its sign */
        t->rate[i] = t->effect[i] > 0 ? rate : 0;
        t->time[i] = dt;
    }
}

/* The same in a step without time: what moves slips at V0 until its stress is that of V0, and takes the time for it. */
TL_IN_LOOP void slip_timelessly(const params *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                                trial *restrict t)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const params law = *given;
    const double per_slip = 1 / (law.ks * law.velocity), viscous = law.damping * law.velocity;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double e = t->exponent[i];
        double arsinh = e + tl_lane_log(0.5 + sqrt(0.25 + tl_lane_exp(-2 * e)));
        double over = t->shear[i] - t->effect[i] * arsinh - viscous;
        double moves = tl_v3_norm2(TL_SLIDE_AT(c, i)) > 0 ? 1 : 0;
        moves = t->effect[i] > 0 ? moves : 0;
        double slips = over > 0 ? moves : 0;
        t->rate[i] = slips * law.velocity;
        t->time[i] = slips * over * per_slip;
    }
}

/* Forces, states, energies and flags; `mark` is for tl_law_put_flags. */
TL_IN_LOOP void settle(const params *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                       const trial *restrict t, double *restrict mark, double *restrict stored,
                       double *restrict dissipated, const int evolution)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict state = batch->state[0] + begin, *restrict rates = batch->state[1] + begin;
    const params law = *given;
    const double half_n = 0.5 / law.kn, half_s = 0.5 / law.ks;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0, total = t->total[i];
        double shear = t->shear[i], slip = t->rate[i] * t->time[i];
        double left = total < 0 ? 0 : shear - law.ks * slip;
        double scale = shear > 0 ? left / (shear > 0 ? shear : 1) : 1;
        double whole = shear * c.area[i];
        tl_vec3 f = {t->x[i], t->y[i], t->z[i]};
        double along = tl_v3_dot(TL_SHEAR_AT(c, i), f);
        double mean = 0.5 * (along / (whole > 0 ? whole : 1) + left * c.area[i]);
        double heat = mean * (shear - left) / law.ks;
        double press = total < 0 ? 0 : total;
        dissipated[i] = heat > 0 ? heat : 0;
        stored[i] = half_n * press * press * per + half_s * left * left * c.area[i];
        double slips = t->rate[i] >= law.velocity ? TL_POINT_SLIPPING : 0;
        mark[i] = total < 0 ? TL_POINT_OPEN : slips;
        c.f_n[i] = total < 0 ? 0 : total;
        TL_PUT_SHEAR(c, i, scale, f);
        state[i] = go_on(evolution, law.distance, t->theta[i], t->rate[i], t->time[i]);
    }
    if (batch->dt > 0)
        for (uint32_t i = 0; i < lanes; i++)
            rates[i] = t->rate[i];
}

TL_IN_LOOP void update_lanes(const params *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                             const int evolution)
{
    tl_law_scratch mark, stored, dissipated;
    trial t;
    double left = press(law, batch, begin, lanes, &t);
    for (int k = 0; k < PASSES && batch->dt > 0 && left > 0; k++)
        left = pass(law, batch->dt, lanes, &t, evolution);
    if (batch->dt > 0)
        find_rates(law, batch->dt, lanes, &t);
    else
        slip_timelessly(law, batch, begin, lanes, &t);
    settle(law, batch, begin, lanes, &t, mark, batch->stored ? batch->stored + begin : stored,
           batch->dissipated ? batch->dissipated + begin : dissipated, evolution);
    tl_law_put_flags(batch, begin, lanes, mark);
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const params *law = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LAW_STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < TL_LAW_STRIDE ? left : TL_LAW_STRIDE;
        if (law->evolution == AGING)
            update_lanes(law, batch, begin, lanes, AGING);
        else
            update_lanes(law, batch, begin, lanes, SLIP);
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(params, kn, ks);

static const tl_law_ops ops = TL_LAW_OPS(.never_fails = 1, .linear = 1, .pulls = tl_pulls_none);

static const tl_kind kind =
    TL_KIND(TL_KIND_LAW, ops, .name = "rate_state",
            .doc = "Friction that depends on the rate of slip and on a state of the surface that ages.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.rate_state", .version = TALUS_VERSION, .doc = "Rate-and-state joint law.",
          .licence = "BSD-3-Clause");
