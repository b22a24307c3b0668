/* continuously_yielding.c - law "continuously_yielding": a joint that yields from the first slip on, and wears down.
 *
 *     s = s(v),  ds/dv = an s^en, at most kn_max      v = v0 + closure + opening, s(v0) A = f_n0
 *     dt/du = F ks,  ks = as s^es, at most ks_max     t: shear stress against the motion du
 *     F = (1 - t / t_m) / (1 - r),  at most 1         t_m = s tan(phi_m)
 *     d phi_m = -(phi_m - phi) (1 - F) du / R         not where F > 1
 *     opening += max(0, tan(psi)) (1 - F) du          psi = atan(t / s) - phi, at the beginning of a step
 *
 * r is t / t_m, at most 0.75, where the motion was last reversed, and 0 at first. Without `softening` F is not negative, so that
 * t stays where the wear of t_m overtakes it. In the plane t is the component along du, a motion is reversed when it goes
 * against the last one, and the stress stays within the larger of t_m and of what it was; it never is more than
 * s tan(phi_i). Over a step the equation of t is solved exactly, at the mean of phi_m before and after.
 *
 * Energy. Unloading gives back more than t^2 / (2 ks), for it is softer than ks. What the walls have put in counts as stored up to a
 * bound on what unloading can give back, 3 (1 + x) t_m^2 / ks (x - log(1 + x)) with x = t / t_m; the rest is heat.
 *
 * Source: Cundall and Hart, report to Itasca (1984), and Eng. Comput. 9 (1992) 101-113;
 * Cundall and Lemos, in Rockbursts and Seismicity in Mines (1990) 107-112.
 *
 * Limits: the normal spring is elastic. Trembling about a point counts as reversals. The stored energy of field contacts, which
 * the host has from a linear pressure, is not its own with en > 0. */
#include <talus/kit.h>
#include <talus/version.h>

/* Lanes worked on at a time: what is noted of them stays in the nearest cache. */
#define STRIDE 64u
/* Scaling a stress down to its limit leaves it within some roundings of it. */
#define ROUNDING 1e-14
/* The largest r at a reversal. */
#define MOST_RATIO 0.75
/* Normal stress and strength, Pa, that count as none. */
#define FAINT 1e-200
/* Share by which energy may be above its bound by rounding. */
#define SPARE 1e-12

typedef struct params {
    double an, en, as, es, kn_max, ks_max, phi_i, phi, roughness;
    int32_t softening, dilation;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, an, "Pa^(1-en)/m",
             "normal stiffness at a normal stress of 1 Pa",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, en, "", "exponent of the normal stress in it",
             .flags = TL_PARAM_MAX_OPEN, .min = 0, .max = 1),
    TL_PARAM(TL_PARAM_REAL, params, as, "Pa^(1-es)/m", "shear stiffness at a normal stress of 1 Pa",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, es, "", "exponent of the normal stress in it", .min = 0,
             .max = 1),
    TL_PARAM(TL_PARAM_REAL, params, kn_max, "Pa/m",
             "largest normal stiffness, for the time step; needed with en > 0",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, ks_max, "Pa/m",
             "largest shear stiffness, for the time step; needed with es > 0",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, phi_i, "deg", "angle of friction of the fresh joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN, .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, phi, "deg",
             "angle of friction of the worn joint, at most phi_i", .alias = "friction",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN, .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, roughness, "m",
             "slip R in which all but 1/e of the difference wears off",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_BOOL, params, softening, "",
             "whether the stress falls after the strength that wears", .def = {1}),
    TL_PARAM(TL_PARAM_BOOL, params, dilation, "", "whether slip opens the joint", .def = {1}),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "wear", "deg", "how far the angle of friction has fallen from phi_i"),
    TL_STATE(TL_STATE_SCALAR, "reversal", "", "share of the strength at the last reversal, r"),
    TL_STATE(TL_STATE_SCALAR, "opening", "m", "how far slip has opened the joint"),
    TL_STATE(TL_STATE_SCALAR, "shear_energy", "J/m2",
             "what shear has put in and not turned to heat"),
    TL_STATE(TL_STATE_TANGENT, "way", "", "direction of the last motion"),
};

typedef struct yielding {
    double an, en, as, es, kn_max, ks_max;
    double stress_max, closure_max; /* where the normal stiffness is kn_max */
    double initial, residual;       /* rad */
    double tangent_i, tangent;      /* of the two */
    double per_roughness, dilation, softening;
} yielding;

/* s(v) of the power law, without its bound. */
TL_IN_LOOP double curved_stress(const yielding *law, double v)
{
    double rest = 1 - law->en, x = rest * law->an * v;
    double power = tl_lane_exp(tl_lane_log(x > FAINT ? x : FAINT) / rest);
    power = x > FAINT ? power : 0;
    return law->en > 0 ? power : law->an * v;
}

TL_IN_LOOP double stress_at(const yielding *law, double v)
{
    double below = v < law->closure_max ? v : law->closure_max;
    double stress = curved_stress(law, below) + law->kn_max * (v - below);
    return v < 0 ? 0 : stress;
}

/* The closure of an initial stress; one that pulls goes on with the stiffness kn_max. */
TL_IN_LOOP double closure_of(const yielding *law, double stress)
{
    double below = stress < law->stress_max ? stress : law->stress_max;
    double pressed = below > 0 ? below : 0, safe = pressed > FAINT ? pressed : FAINT;
    double rest = 1 - law->en;
    double v = tl_lane_exp(rest * tl_lane_log(safe)) / (rest * law->an);
    v = pressed > FAINT ? v : 0;
    v = law->en > 0 ? v : pressed / law->an;
    return v + (stress - pressed) / law->kn_max;
}

/* Energy of the normal spring per area. */
TL_IN_LOOP double energy_at(const yielding *law, double v)
{
    double below = v < law->closure_max ? v : law->closure_max, beyond = v - below;
    double stress = stress_at(law, below), rest = 1 - law->en;
    double curved = stress * below * rest / (1 + rest);
    return (v > 0 ? curved : 0) + beyond * (stress + 0.5 * law->kn_max * beyond);
}

TL_IN_LOOP double shear_stiffness(const yielding *law, double stress)
{
    double s = stress > FAINT ? stress : FAINT;
    double power = law->as * tl_lane_exp(law->es * tl_lane_log(s));
    power = power < law->ks_max ? power : law->ks_max;
    return stress > 0 ? power : 0;
}

static tl_status fail(tl_report *report, const char *text)
{
    snprintf(report->text, sizeof report->text, "%s", text);
    return TL_E_ARGUMENT;
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (p->phi > p->phi_i) {
        snprintf(report->text, sizeof report->text, "phi = %g deg must be <= phi_i = %g deg",
                 p->phi, p->phi_i);
        return TL_E_ARGUMENT;
    }
    if (p->en > 0 && isnan(p->kn_max))
        return fail(report,
                    "en > 0 needs kn_max, the largest normal stiffness, Pa/m, which the time step "
                    "follows from");
    if (p->es > 0 && isnan(p->ks_max))
        return fail(report,
                    "es > 0 needs ks_max, the largest shear stiffness, Pa/m, which the time step "
                    "follows from");
    yielding law = {.an = p->an,
                    .en = p->en,
                    .as = p->as,
                    .es = p->es,
                    .kn_max = p->en > 0 ? p->kn_max : p->an,
                    .ks_max = p->es > 0 ? p->ks_max : p->as,
                    .stress_max = INFINITY,
                    .closure_max = INFINITY,
                    .initial = p->phi_i * TL_DEGREE,
                    .residual = p->phi * TL_DEGREE,
                    .tangent_i = tl_tan(p->phi_i * TL_DEGREE),
                    .tangent = tl_tan(p->phi * TL_DEGREE),
                    .per_roughness = 1 / p->roughness,
                    .dilation = p->dilation ? 1 : 0,
                    .softening = p->softening ? 1 : 0};
    double most = p->en > 0 ? tl_lane_exp(tl_lane_log(p->kn_max / p->an) / p->en) : 1e300;
    law.closure_max = p->en > 0 ? closure_of(&law, most) : 1e300;
    law.stress_max = most;
    return tl_keep(&law, sizeof law, self, report);
}

/* ---------------------------------------------------------------- update ----------------- */

/* A point after a step, in stresses; x, y, z is the stress on B. */
typedef struct trial {
    double walls[STRIDE], v[STRIDE], spring[STRIDE];
    double x[STRIDE], y[STRIDE], z[STRIDE], size[STRIDE], work[STRIDE];
    double angle[STRIDE], ratio[STRIDE], wear[STRIDE], lift[STRIDE], slides[STRIDE];
    double moved[STRIDE]; /* 0: the force stays, to the bit */
} trial;

/* Rise of the stress `t` along the way `d`, when the strength is `most`. */
TL_IN_LOOP double rise(const yielding *law, double t, double most, double ratio, double ks,
                       double d)
{
    double gap = most - t, reach = most * (1 - ratio);
    double exact = gap * (1 - tl_lane_exp(-ks * d / (reach > FAINT ? reach : FAINT)));
    double up = exact < ks * d ? exact : ks * d;
    return (gap < 0 ? law->softening : 1) * up;
}

/* Closure, shear stress and wear. */
TL_IN_LOOP void slide(const yielding *given, const tl_law_batch *batch, uint32_t begin,
                      uint32_t lanes, trial *restrict t)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict worn = batch->state[0] + begin;
    const double *restrict last = batch->state[1] + begin, *restrict opened =
                                                               batch->state[2] + begin;
    const double *restrict way_x = batch->state[4] + begin, *restrict way_y =
                                                                batch->state[5] + begin;
    const double *restrict way_z = batch->state[6] + begin;
    const yielding law = *given;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0;
        double walls = closure_of(&law, c.f_n0[i] * per) + c.closure[i], v = walls + opened[i];
        double stress = stress_at(&law, v), ks = shear_stiffness(&law, stress);
        double d = sqrt(c.du_x[i] * c.du_x[i] + c.du_y[i] * c.du_y[i] + c.du_z[i] * c.du_z[i]);
        double per_way = d > 0 ? 1 / (d > 0 ? d : 1) : 0;
        double ex = c.du_x[i] * per_way, ey = c.du_y[i] * per_way, ez = c.du_z[i] * per_way;
        double before = sqrt(c.f_x[i] * c.f_x[i] + c.f_y[i] * c.f_y[i] + c.f_z[i] * c.f_z[i]) * per;
        double along = -(c.f_x[i] * ex + c.f_y[i] * ey + c.f_z[i] * ez) * per;
        double angle = law.initial - worn[i] * TL_DEGREE, most = stress * tl_lane_tan(angle);
        double back = ex * way_x[i] + ey * way_y[i] + ez * way_z[i];
        double share = along / (most > FAINT ? most : 1);
        share = share < MOST_RATIO ? share : MOST_RATIO;
        double was = worn[i], ratio = last[i], reversed = most > FAINT ? share : 0;
        ratio = back < 0 ? reversed : ratio;
        /* the angle of dilation is that of the stresses before; walls that meet now had none */
        double press = c.f_n[i] * per, held = press > 0 ? press : stress;
        double slope = before / (held > FAINT ? held : 1);
        double tangent = (slope - law.tangent) / (1 + slope * law.tangent);
        tangent = tangent > 0 ? law.dilation * tangent : 0;
        /* twice: with the angle before, and with the mean of it and of what that comes to */
        double up = rise(&law, along, most, ratio, ks, d);
        double slip = d - up / (ks > 0 ? ks : 1);
        slip = slip > 0 ? slip : 0;
        double left = tl_lane_exp(-slip * law.per_roughness);
        double mean = law.residual + (angle - law.residual) * 0.5 * (1 + left);
        up = rise(&law, along, stress * tl_lane_tan(mean), ratio, ks, d);
        slip = d - up / (ks > 0 ? ks : 1);
        slip = slip > 0 ? slip : 0;
        slip = stress > 0 ? slip : 0;
        left = tl_lane_exp(-slip * law.per_roughness);
        double after = law.residual + (angle - law.residual) * left;
        double x = c.f_x[i] * per - up * ex, y = c.f_y[i] * per - up * ey,
               z = c.f_z[i] * per - up * ez;
        double size = sqrt(x * x + y * y + z * z), bound = before > most ? before : most;
        double peak = stress * law.tangent_i;
        bound = bound < peak ? bound : peak;
        double yields = slip > 0.5 * d ? 1 : 0, changes = up < 0 ? 1 : up;
        double over = size > bound * (1 + ROUNDING) ? 1 : 0;
        double scale = over > 0 ? bound / (over > 0 ? size : 1) : 1;
        double dot = (c.f_x[i] * per + scale * x) * c.du_x[i] +
                     (c.f_y[i] * per + scale * y) * c.du_y[i] +
                     (c.f_z[i] * per + scale * z) * c.du_z[i];
        t->walls[i] = walls;
        t->v[i] = v;
        t->spring[i] = ks;
        t->x[i] = scale * x;
        t->y[i] = scale * y;
        t->z[i] = scale * z;
        t->size[i] = scale * size;
        t->moved[i] = over + changes == 0 ? 0 : 1; /* not-a-number has moved */
        t->work[i] = -0.5 * dot;
        t->angle[i] = after;
        t->ratio[i] = ratio;
        t->wear[i] = slip > 0 ? (law.initial - after) / TL_DEGREE : was;
        t->lift[i] = tangent * slip;
        t->slides[i] = over + yields > 0 ? 1 : 0;
    }
}

/* What unloading can give back, over t_m^2 / ks: 3 (1 + x) (x - log(1 + x)). */
TL_IN_LOOP double elastic(double x)
{
    double series = x * x * (1. / 2 - x * (1. / 3 - x * (1. / 4 - x * (1. / 5))));
    double closed = x - tl_lane_log1p(x);
    return 3 * (1 + x) * (x < 1e-3 ? series : closed);
}

/* Dilation, forces, states, energies and flags; `mark` takes the flags as doubles: a loop over lanes of two widths is not
 * vectorised for every machine. */
TL_IN_LOOP void settle(const yielding *given, const tl_law_batch *batch, uint32_t begin,
                       uint32_t lanes, const trial *restrict t, double *restrict mark,
                       double *restrict stored, double *restrict dissipated)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict wear = batch->state[0] + begin, *restrict reversal = batch->state[1] + begin;
    double *restrict opening = batch->state[2] + begin, *restrict put_in = batch->state[3] + begin;
    double *restrict way_x = batch->state[4] + begin, *restrict way_y = batch->state[5] + begin;
    double *restrict way_z = batch->state[6] + begin;
    const yielding law = *given;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double d = sqrt(c.du_x[i] * c.du_x[i] + c.du_y[i] * c.du_y[i] + c.du_z[i] * c.du_z[i]);
        double per_way = d > 0 ? 1 / (d > 0 ? d : 1) : 0, lift = t->lift[i];
        /* shear pays for it, or the walls do not part */
        double rest = energy_at(&law, t->v[i]), paid = put_in[i] + t->work[i];
        double lifted = energy_at(&law, t->walls[i] + (opening[i] + lift)) - rest;
        double ks = t->spring[i], spring = 0.5 * t->size[i] * t->size[i] / (ks > 0 ? ks : 1);
        lift = paid - lifted >= spring ? lift : 0;
        lifted = lift > 0 ? lifted : 0;
        double opened = opening[i] + lift, v = t->walls[i] + opened, pressed = stress_at(&law, v);
        double most = pressed * tl_lane_tan(t->angle[i]);
        double x = t->size[i] / (most > FAINT ? most : 1);
        ks = shear_stiffness(&law, pressed);
        double bound = ks > 0 ? most * most / (ks > 0 ? ks : 1) * elastic(x) : 0;
        double sum = paid - lifted;
        double kept = sum > bound * (1 + SPARE) ? bound : (sum > 0 ? sum : 0);
        double heat = sum > kept ? sum - kept : 0;
        dissipated[i] = c.area[i] > 0 ? c.area[i] * heat : 0;
        stored[i] = c.area[i] > 0 ? c.area[i] * (kept + rest + lifted) : 0;
        mark[i] = v < 0 ? TL_POINT_OPEN : t->slides[i] * TL_POINT_SLIPPING;
        c.f_n[i] = c.area[i] * pressed;
        c.f_x[i] = t->moved[i] > 0 ? c.area[i] * t->x[i] : c.f_x[i];
        c.f_y[i] = t->moved[i] > 0 ? c.area[i] * t->y[i] : c.f_y[i];
        c.f_z[i] = t->moved[i] > 0 ? c.area[i] * t->z[i] : c.f_z[i];
        wear[i] = t->wear[i];
        reversal[i] = t->ratio[i];
        opening[i] = opened;
        put_in[i] = kept;
        way_x[i] = d > 0 ? c.du_x[i] * per_way : way_x[i];
        way_y[i] = d > 0 ? c.du_y[i] * per_way : way_y[i];
        way_z[i] = d > 0 ? c.du_z[i] * per_way : way_z[i];
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch,
                                      tl_report *report)
{
    (void)report;
    double mark[STRIDE], stored[STRIDE], dissipated[STRIDE];
    trial t;
    for (uint32_t begin = 0; begin < batch->count; begin += STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < STRIDE ? left : STRIDE;
        slide(self, batch, begin, lanes, &t);
        settle(self, batch, begin, lanes, &t, mark, batch->stored ? batch->stored + begin : stored,
               batch->dissipated ? batch->dissipated + begin : dissipated);
        tl_law_put_flags(batch, begin, lanes, mark);
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(yielding, kn_max, ks_max);

static const tl_law_ops ops = TL_LAW_OPS(.pulls = tl_pulls_any);

static const tl_kind kind = TL_KIND(
    TL_KIND_LAW, ops, .name = "continuously_yielding",
    .doc = "A joint that yields from the first slip on, and whose friction wears down: for cyclic "
           "loading.",
    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.continuously_yielding", .version = TALUS_VERSION,
          .doc = "Continuously yielding joint law.", .licence = "BSD-3-Clause");
