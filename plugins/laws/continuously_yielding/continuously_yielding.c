/* continuously_yielding.c - law "continuously_yielding": a joint that yields from the first slip on, and wears down.
 *
 *     s = s(v),  ds/dv = an s^en, at most kn_max      v = v0 + closure + opening, s(v0) A = f_n0
 *     dt/du = F ks,  ks = as s^es, at most ks_max     t: shear stress against the motion du
 *     F = (1 - t / t_m) / (1 - r),  at most 1         t_m = s tan(phi_m)
 *     d phi_m = -(phi_m - phi) (1 - F) du / R         not where F > 1
 *     opening += max(0, tan(psi)) (1 - F) du          psi = atan(t / s) - phi, at the end of a step
 *
 * r is t / t_m, at most 0.75, where the motion was last reversed, and 0 at first. Without `softening` F is not
 * negative, so that t stays where the wear of t_m overtakes it. In the plane t is the component along du, and the
 * stress stays within the larger of t_m and of what it was; it never is more than s tan(phi_i). Over a step the
 * equation of t is solved exactly, at the mean of phi_m before and after.
 *
 * Reversals. A joint has an r for each way it may move, e: r(e) = a + min(0, b.e), with the states a, `reversal`, and
 * b, `way`. While it moves by du along e, r(e) stays. r(-e), which a motion back begins with, comes to the present -t /
 * t_m, at most 0.75:
 *     dr(-e) = (-t / t_m - r(-e)) du / l,     l = 0.01 t_m / ks + 1e-6 R
 * what b has across e fades as r(-e) does. So a motion back over l or more is a reversal; one that is next to nothing
 * changes next to nothing, for no test tells which is which.
 *
 * Energy. Unloading gives back more than t^2 / (2 ks), for it is softer than ks. What the walls have put in counts as
 * stored up to a bound on what unloading can give back; the rest is heat. With x = t / t_m the bound is 3 (1 + x) t_m^2
 * / ks (x - log(1 + x)). The part beyond t^2 / (2 ks_max) is a state. Where it is used up, as where an initial stress
 * is unloaded, t falls as such a spring's does. Opening the joint costs tl_law_lift_work.
 *
 * Source: Cundall and Hart, report to Itasca (1984), and Eng. Comput. 9 (1992) 101-113;
 * Cundall and Lemos, in Rockbursts and Seismicity in Mines (1990) 107-112.
 *
 * Limits: the normal spring is elastic. Trembling about a point counts as reversals once its ways add up to l. */
#include <talus/kit.h>
#include <talus/version.h>

/* Scaling a stress down to its limit leaves it within some roundings of it. */
#define ROUNDING 1e-14
/* The largest r at a reversal. */
#define MOST_RATIO 0.75
/* The way l in which r comes to that of a motion back, over t_m / ks; and what it is at the least, over the
 * roughness. */
#define MEMORY 0.01
#define LEAST_MEMORY 1e-6
/* Normal stress and strength, Pa, that count as none. */
#define FAINT 1e-200
/* Share by which energy may be above its bound by rounding. */
#define SPARE 1e-12

typedef struct params {
    double an, en, as, es, kn_max, ks_max, phi_i, phi, roughness;
    int32_t softening, dilation;
} params;

static const tl_param param_table[] = {
    TL_PARAM_STIFF(params, an, "Pa^(1-en)/m", TL_PARAM_REQUIRED, "normal stiffness at a normal stress of 1 Pa"),
    TL_PARAM(TL_PARAM_REAL, params, en, "", "exponent of the normal stress in it", .flags = TL_PARAM_MAX_OPEN, .min = 0,
             .max = 1),
    TL_PARAM_STIFF(params, as, "Pa^(1-es)/m", TL_PARAM_REQUIRED, "shear stiffness at a normal stress of 1 Pa"),
    TL_PARAM(TL_PARAM_REAL, params, es, "", "exponent of the normal stress in it", .min = 0, .max = 1),
    TL_PARAM_STIFF(params, kn_max, "Pa/m", TL_PARAM_OPTIONAL,
                   "largest normal stiffness, for the time step; needed with en > 0"),
    TL_PARAM_STIFF(params, ks_max, "Pa/m", TL_PARAM_OPTIONAL,
                   "largest shear stiffness, for the time step; needed with es > 0"),
    TL_PARAM_ANGLE(params, phi_i, TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH_ANGLE,
                   "angle of friction of the fresh joint"),
    TL_PARAM_ANGLE(params, phi, TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | TL_PARAM_STRENGTH_ANGLE,
                   "angle of friction of the worn joint, at most phi_i", .alias = "friction"),
    TL_PARAM_POSITIVE(params, roughness, "m", "slip R in which all but 1/e of the difference wears off"),
    TL_PARAM(TL_PARAM_BOOL, params, softening, "", "whether the stress falls after the strength that wears",
             .def = {1}),
    TL_PARAM(TL_PARAM_BOOL, params, dilation, "", "whether slip opens the joint", .def = {1}),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "wear", "deg", "how far the angle of friction has fallen from phi_i"),
    TL_STATE(TL_STATE_SCALAR, "reversal", "",
             "share of the strength at the last reversal, r, of motions along and across `way`"),
    TL_STATE(TL_STATE_SCALAR, "opening", "m", "how far slip has opened the joint", .transfer = TL_TRANSFER_LIFT),
    TL_STATE(TL_STATE_SCALAR, "shear_energy", "J", "what shear holds beyond a spring of stiffness ks_max",
             .transfer = TL_TRANSFER_ENERGY),
    TL_STATE(TL_STATE_TANGENT, "way", "", "in the direction of the last motion: by how much r is less against it"),
};

typedef struct yielding {
    double an, en, as, es, kn_max, ks_max;
    double stress_max, closure_max; /* where the normal stiffness is kn_max */
    double stress_top;              /* s(closure_max), as it is computed */
    double initial, residual;       /* rad */
    double tangent_i, tangent;      /* of the two */
    double per_roughness, least_memory, dilation, softening;
} yielding;

/* `curved` is a constant at each call: whether stiffness depends on the stress, which takes logarithms and
 * exponentials. */

/* s(v) of the power law, without its bound. */
TL_IN_LOOP double curved_stress(const int curved, const yielding *law, double v)
{
    if (!curved)
        return law->an * v;
    double rest = 1 - law->en, x = rest * law->an * v;
    double power = tl_lane_exp(tl_lane_log(x > FAINT ? x : FAINT) / rest);
    power = x > FAINT ? power : 0;
    return law->en > 0 ? power : law->an * v;
}

TL_IN_LOOP double stress_at(const int curved, const yielding *law, double v)
{
    double below = v < law->closure_max ? v : law->closure_max;
    double stress = curved_stress(curved, law, below) + law->kn_max * (v - below);
    return v < 0 ? 0 : stress;
}

/* The closure of an initial stress; one that pulls goes on with the stiffness kn_max. */
TL_IN_LOOP double closure_of(const int curved, const yielding *law, double stress)
{
    double below = stress < law->stress_max ? stress : law->stress_max;
    double pressed = below > 0 ? below : 0, safe = pressed > FAINT ? pressed : FAINT;
    double rest = 1 - law->en;
    double v = pressed / law->an;
    if (curved) {
        double power = tl_lane_exp(rest * tl_lane_log(safe)) / (rest * law->an);
        power = pressed > FAINT ? power : 0;
        v = law->en > 0 ? power : v;
    }
    return v + (stress - pressed) / law->kn_max;
}

/* Energy of the normal spring per area, at the stress that belongs to v. */
TL_IN_LOOP double energy_at(const yielding *law, double v, double stress)
{
    double below = v < law->closure_max ? v : law->closure_max, beyond = v - below;
    double from = v < law->closure_max ? stress : law->stress_top, rest = 1 - law->en;
    double work = from * below * rest / (1 + rest);
    return (v > 0 ? work : 0) + beyond * (from + 0.5 * law->kn_max * beyond);
}

TL_IN_LOOP double shear_stiffness(const int curved, const yielding *law, double stress)
{
    if (!curved)
        return stress > 0 ? law->as : 0;
    double s = stress > FAINT ? stress : FAINT;
    double power = law->as * tl_lane_exp(law->es * tl_lane_log(s));
    power = power < law->ks_max ? power : law->ks_max;
    return stress > 0 ? power : 0;
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (p->phi > p->phi_i)
        return tl_refuse(report, "phi = %g deg must be <= phi_i = %g deg", p->phi, p->phi_i);
    if (p->en > 0 && isnan(p->kn_max))
        return tl_refuse(report, "en > 0 needs kn_max, the largest normal stiffness, Pa/m, which the time step "
                                 "follows from");
    if (p->es > 0 && isnan(p->ks_max))
        return tl_refuse(report, "es > 0 needs ks_max, the largest shear stiffness, Pa/m, which the time step "
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
                    .least_memory = LEAST_MEMORY * p->roughness,
                    .dilation = p->dilation ? 1 : 0,
                    .softening = p->softening ? 1 : 0};
    double most = p->en > 0 ? tl_lane_exp(tl_lane_log(p->kn_max / p->an) / p->en) : 1e300;
    law.closure_max = p->en > 0 ? closure_of(1, &law, most) : 1e300;
    law.stress_max = most;
    law.stress_top = stress_at(1, &law, law.closure_max);
    return tl_keep(&law, sizeof law, self, report);
}

/* ---------------------------------------------------------------- update ----------------- */

/* A point after a step, in stresses; x, y, z is the stress on B. */
typedef struct trial {
    tl_law_scratch walls, v, spring;
    tl_law_scratch x, y, z, size, before;
    tl_law_scratch begins, ends; /* work of half of the stress before the step, and after it */
    /* beyond a spring of ks_max: before, after; in that spring; share of the stress that can be paid for */
    tl_law_scratch had, kept, elastic, share;
    tl_law_scratch angle, ratio, wear, lift, slides;
    tl_law_scratch way_x, way_y, way_z;
    tl_law_scratch moved; /* 0: the force stays, to the bit */
    tl_law_scratch pressed, held, bound;
} trial;

/* Rise of the stress `t` along the way `d`, when the strength is `most`. */
TL_IN_LOOP double rise(const yielding *law, double t, double most, double ratio, double ks, double d)
{
    double gap = most - t, reach = most * (1 - ratio);
    double exact = gap * (1 - tl_lane_exp(-ks * d / (reach > FAINT ? reach : FAINT)));
    double up = exact < ks * d ? exact : ks * d;
    return (gap < 0 ? law->softening : 1) * up;
}

/* Puts the closures of initial forces into `walls`; most joints have none. */
TL_IN_LOOP void press(const yielding *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                      trial *restrict t, const int curved)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const yielding law = *given;
    double forces = 0;
#pragma omp simd reduction(+ : forces)
    for (uint32_t i = 0; i < lanes; i++) {
        forces += c.f_n0[i] == 0 ? 0 : 1;
        t->walls[i] = 0;
    }
    if (!(forces > 0))
        return;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0;
        t->walls[i] = closure_of(curved, &law, c.f_n0[i] * per);
    }
}

/* How many lanes move along the joint. */
TL_IN_LOOP double moving(const tl_law_batch *batch, uint32_t begin, uint32_t lanes)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (uint32_t i = 0; i < lanes; i++) {
        double way2 = c.du_x[i] * c.du_x[i] + c.du_y[i] * c.du_y[i] + c.du_z[i] * c.du_z[i];
        sum += way2 == 0 ? 0 : 1; /* not-a-number moves */
    }
    return sum;
}

/* Rise of the stress along the way, slip, and the share of roughness that it leaves. */
typedef struct wearing {
    double up, slip, left;
} wearing;

/* Found twice: with the angle before, and with the mean of it and of what that comes to. */
TL_IN_LOOP wearing wear_off(const yielding *law, double along, double angle, double v, double stress, double most,
                            double ratio, double ks, double d)
{
    wearing w = {.up = rise(law, along, most, ratio, ks, d)};
    w.slip = d - w.up / (ks > 0 ? ks : 1);
    w.slip = w.slip > 0 ? w.slip : 0;
    w.left = tl_lane_exp(-w.slip * law->per_roughness);
    double mean = law->residual + (angle - law->residual) * 0.5 * (1 + w.left);
    w.up = rise(law, along, stress * tl_lane_tan(mean), ratio, ks, d);
    w.slip = d - w.up / (ks > 0 ? ks : 1);
    w.slip = w.slip > 0 ? w.slip : 0;
    w.slip = v < 0 ? 0 : w.slip;
    w.left = tl_lane_exp(-w.slip * law->per_roughness);
    return w;
}

/* What is remembered of the way that a point was moved: the ratio for the way it is moved now, the share of the old way
 * that stays, and what this way adds along itself. */
typedef struct turning {
    double ratio, across, along;
} turning;

/* Half of what was remembered is left after a way of the length `memory`; `share` is that of the strength which is used
 * along this way. */
TL_IN_LOOP turning remember(double last, double toward, double share, double ratio, double way, double memory)
{
    double back = last - (toward > 0 ? toward : 0), renewed = way / (way + memory);
    double opposite = -share < MOST_RATIO ? -share : MOST_RATIO;
    back = back + renewed * (opposite - back);
    double across = 1 - renewed;
    return (turning){ratio > back ? ratio : back, across, ratio - back - across * toward};
}

/* Closure, shear stress and wear. `moves`, a constant: 0 if no lane moves along the joint; then no angle is needed, and
 * the results are the same to the bit. How many lanes slip opens. */
TL_IN_LOOP double slide(const yielding *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                        trial *restrict t, const int curved, const int moves)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict worn = batch->state[0] + begin;
    const double *restrict last = batch->state[1] + begin, *restrict opened = batch->state[2] + begin;
    const double *restrict way_x = batch->state[4] + begin, *restrict way_y = batch->state[5] + begin;
    const double *restrict way_z = batch->state[6] + begin;
    const yielding law = *given;
    double opens = 0;
#pragma omp simd reduction(+ : opens)
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0;
        double walls = t->walls[i] + c.closure[i], v = walls + opened[i];
        double stress = stress_at(curved, &law, v), ks = shear_stiffness(curved, &law, stress);
        tl_vec3 du = TL_SLIDE_AT(c, i), force = TL_SHEAR_AT(c, i);
        tl_vec3 way = {way_x[i], way_y[i], way_z[i]};
        double d = tl_v3_norm(du), per_way = d > 0 ? 1 / (d > 0 ? d : 1) : 0;
        tl_vec3 e = tl_v3_scale(per_way, du);
        double before = tl_v3_norm(force) * per, along = -tl_v3_dot(force, e) * per;
        double angle = law.initial - worn[i] * TL_DEGREE, most = moves ? stress * tl_lane_tan(angle) : 0;
        double toward = tl_v3_dot(e, way);
        double was = worn[i], ratio = last[i] + (toward < 0 ? toward : 0);
        wearing w = {.left = 1};
        if (moves)
            w = wear_off(&law, along, angle, v, stress, most, ratio, ks, d);
        double up = w.up, slip = w.slip, after = law.residual + (angle - law.residual) * w.left;
        tl_vec3 f = tl_v3_sub(tl_v3_scale(per, force), tl_v3_scale(up, e));
        double size = tl_v3_norm(f), bound = before > most ? before : most;
        double peak = stress * law.tangent_i;
        bound = bound < peak ? bound : peak;
        double yields = slip > 0.5 * d ? 1 : 0, changes = up < 0 ? 1 : up;
        double over = size > bound * (1 + ROUNDING) ? 1 : 0;
        double scale = over > 0 ? bound / (over > 0 ? size : 1) : 1;
        /* Of the stresses before, a point that presses less than others and is pressed more in this step would open by
         * less than they: it would stay behind them, and part. */
        double slope = stress > FAINT ? scale * size / (stress > FAINT ? stress : 1) : 0;
        double tangent = (slope - law.tangent) / (1 + slope * law.tangent);
        tangent = tangent > 0 ? law.dilation * tangent : 0;
        double share = -scale * tl_v3_dot(f, e) / (most > FAINT ? most : 1);
        double memory = (ks > 0 ? MEMORY * most / (ks > 0 ? ks : 1) : 0) + law.least_memory;
        turning turned = remember(last[i], toward, most > FAINT ? share : 0, ratio, d, memory);
        t->walls[i] = walls;
        t->v[i] = v;
        t->spring[i] = ks;
        t->pressed[i] = stress;
        t->x[i] = scale * f.x;
        t->y[i] = scale * f.y;
        t->z[i] = scale * f.z;
        t->size[i] = scale * size;
        t->moved[i] = over + changes == 0 ? 0 : 1; /* not-a-number has moved */
        t->before[i] = before;
        t->begins[i] = -0.5 * tl_v3_dot(force, du) * per;
        t->ends[i] = -0.5 * scale * tl_v3_dot(f, du);
        t->angle[i] = after;
        t->ratio[i] = turned.ratio;
        t->way_x[i] = d > 0 ? turned.across * way.x + turned.along * e.x : way.x;
        t->way_y[i] = d > 0 ? turned.across * way.y + turned.along * e.y : way.y;
        t->way_z[i] = d > 0 ? turned.across * way.z + turned.along * e.z : way.z;
        t->wear[i] = slip > 0 ? (law.initial - after) / TL_DEGREE : was;
        t->lift[i] = tangent * slip;
        opens += t->lift[i] == 0 ? 0 : 1;
        t->slides[i] = over + yields > 0 ? 1 : 0;
    }
    return opens;
}

/* The least of what unloading can give back, over size^2 / ks: 3 (1 + x) (x - log(1 + x)) >= 1.5 x^2, less rounding. */
#define LEAST 1.499999

/* What unloading can give back, over t_m^2 / ks: 3 (1 + x) (x - log(1 + x)). */
TL_IN_LOOP double elastic(double x)
{
    double series = x * x * (1. / 2 - x * (1. / 3 - x * (1. / 4 - x * (1. / 5))));
    double closed = x - tl_lane_log1p(x);
    return 3 * (1 + x) * (x < 1e-3 ? series : closed);
}

/* Share of a stress to which it falls when there is only so much energy: `paid` and the work `ends` of what stays of
 * it, and its spring would hold `spring`. */
TL_IN_LOOP double afforded(double spring, double paid, double ends)
{
    double square = ends * ends + 4 * spring * paid, some = spring > 0 ? spring : 1;
    double share = (ends + sqrt(square > 0 ? square : 0)) / (2 * some);
    share = share < 1 ? share : 1;
    return share > 0 ? share : 0;
}

/* Dilation, and what it leaves of the energy that shear has put in; whether some of that might be more than unloading
 * can give back. `opens`, a constant: 0 if no lane is opened by slip. */
TL_IN_LOOP double lift(const yielding *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                       trial *restrict t, const int curved, const int opens)
{
    const double *restrict area = batch->area + begin, *restrict opening = batch->state[2] + begin;
    const double *restrict held = batch->state[3] + begin, *restrict f_n = batch->f_n + begin;
    const yielding law = *given;
    double near = 0;
#pragma omp simd reduction(+ : near)
    for (uint32_t i = 0; i < lanes; i++) {
        double per = area[i] > 0 ? 1 / area[i] : 0, softness = 0.5 / law.ks_max;
        double size2 = t->size[i] * t->size[i], ks = t->spring[i], had = held[i] * per;
        double opened = opening[i], v = t->v[i], pressed = t->pressed[i], lifted = 0, paid = 0;
        double rest = energy_at(&law, v, pressed), work = t->begins[i] + t->ends[i];
        double before = softness * t->before[i] * t->before[i];
        double spring = t->moved[i] > 0 ? softness * size2 : before;
        if (opens) {
            /* shear pays for it, or the walls do not part */
            double needs = 0.5 * size2 / (ks > 0 ? ks : 1), up = t->lift[i];
            double above = t->walls[i] + (opened + up);
            lifted = energy_at(&law, above, stress_at(curved, &law, above)) - rest;
            paid = tl_law_lift_work(lifted, f_n[i] * per, pressed, up);
            up = had + before + work - paid >= needs ? up : 0;
            lifted = up > 0 ? lifted : 0;
            paid = up > 0 ? paid : 0;
            opened = opened + up;
            v = t->walls[i] + opened;
            pressed = stress_at(curved, &law, v);
            ks = shear_stiffness(curved, &law, pressed);
        }
        double sum = had + (before - spring) + work - paid;
        double share = afforded(spring, had + before - paid + t->begins[i], t->ends[i]);
        share = sum < 0 ? share : 1;
        t->v[i] = v;
        t->lift[i] = opened;
        t->pressed[i] = pressed;
        t->spring[i] = ks;
        t->had[i] = had;
        t->kept[i] = sum;
        t->share[i] = share;
        t->size[i] = share * t->size[i];
        t->elastic[i] = share * share * spring;
        t->held[i] = rest + lifted;
        t->bound[i] = INFINITY;
        double room = ks > 0 ? LEAST * size2 / (ks > 0 ? ks : 1) : 0;
        near += sum + spring <= room ? 0 : 1;
    }
    return near;
}

/* What unloading can give back. */
TL_IN_LOOP void bound(uint32_t lanes, trial *restrict t)
{
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double most = t->pressed[i] * tl_lane_tan(t->angle[i]), ks = t->spring[i];
        double x = t->size[i] / (most > FAINT ? most : 1);
        t->bound[i] = ks > 0 ? most * most / (ks > 0 ? ks : 1) * elastic(x) : 0;
    }
}

/* Forces, states, energies and flags; `mark` is for tl_law_put_flags. */
TL_IN_LOOP void settle(const tl_law_batch *batch, uint32_t begin, uint32_t lanes, const trial *restrict t,
                       double *restrict mark, double *restrict stored, double *restrict dissipated)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict wear = batch->state[0] + begin, *restrict reversal = batch->state[1] + begin;
    double *restrict opening = batch->state[2] + begin, *restrict held = batch->state[3] + begin;
    double *restrict way_x = batch->state[4] + begin, *restrict way_y = batch->state[5] + begin;
    double *restrict way_z = batch->state[6] + begin;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double sum = t->kept[i];
        double most = t->bound[i] - t->elastic[i], kept = sum > 0 ? sum : 0;
        kept = sum > most + t->bound[i] * SPARE ? (most > 0 ? most : 0) : kept;
        double heat = sum > kept ? sum - kept : 0, moved = t->share[i] < 1 ? 1 : t->moved[i];
        dissipated[i] = c.area[i] > 0 ? c.area[i] * heat : 0;
        stored[i] = c.area[i] > 0 ? c.area[i] * (kept + t->elastic[i] + t->held[i]) : 0;
        mark[i] = t->v[i] < 0 ? TL_POINT_OPEN : t->slides[i] * TL_POINT_SLIPPING;
        c.f_n[i] = c.area[i] * t->pressed[i];
        c.f_x[i] = moved > 0 ? c.area[i] * (t->share[i] * t->x[i]) : c.f_x[i];
        c.f_y[i] = moved > 0 ? c.area[i] * (t->share[i] * t->y[i]) : c.f_y[i];
        c.f_z[i] = moved > 0 ? c.area[i] * (t->share[i] * t->z[i]) : c.f_z[i];
        wear[i] = t->wear[i];
        reversal[i] = t->ratio[i];
        opening[i] = t->lift[i];
        held[i] = kept == t->had[i] ? held[i] : c.area[i] * kept;
        way_x[i] = t->way_x[i];
        way_y[i] = t->way_y[i];
        way_z[i] = t->way_z[i];
    }
}

TL_IN_LOOP void update_lanes(const yielding *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                             const int curved)
{
    tl_law_scratch mark, stored, dissipated;
    trial t;
    press(law, batch, begin, lanes, &t, curved);
    double opens = moving(batch, begin, lanes) > 0 ? slide(law, batch, begin, lanes, &t, curved, 1)
                                                   : slide(law, batch, begin, lanes, &t, curved, 0);
    double near =
        opens > 0 ? lift(law, batch, begin, lanes, &t, curved, 1) : lift(law, batch, begin, lanes, &t, curved, 0);
    if (near > 0)
        bound(lanes, &t);
    settle(batch, begin, lanes, &t, mark, batch->stored ? batch->stored + begin : stored,
           batch->dissipated ? batch->dissipated + begin : dissipated);
    tl_law_put_flags(batch, begin, lanes, mark);
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const yielding *law = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LAW_STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < TL_LAW_STRIDE ? left : TL_LAW_STRIDE;
        if (law->en > 0 || law->es > 0)
            update_lanes(law, batch, begin, lanes, 1);
        else
            update_lanes(law, batch, begin, lanes, 0);
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(yielding, kn_max, ks_max);

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    for (uint32_t i = 0; i < batch->count; i++) {
        double area = batch->area[i], stress = batch->f_n0[i] / (area > 0 ? area : 1);
        lift[i] = closure_of(1, self, stress) + batch->state[2][i];
    }
    tl_law_hold_none(batch, hold);
}

/* Energy of the springs that press. */
static void pressed(const void *self, const tl_law_batch *batch, double *energy)
{
    const yielding law = *(const yielding *)self;
    const int curved = law.en > 0;
    const double *restrict opening = batch->state[2];
    for (uint32_t i = 0; i < batch->count; i++) {
        double area = batch->area[i], per = area > 0 ? 1 / area : 0;
        double v = closure_of(curved, &law, batch->f_n0[i] * per) + batch->closure[i] + opening[i];
        double stress = stress_at(curved, &law, v);
        energy[i] = v > 0 ? area * energy_at(&law, v, stress) : 0;
        batch->f_n[i] = v > 0 ? area * stress : 0;
    }
}

static const tl_law_ops ops =
    TL_LAW_OPS(.never_fails = 1, .pulls = tl_pulls_none, .across_gap = across_gap, .pressed = pressed);

static const tl_kind kind =
    TL_KIND(TL_KIND_LAW, ops, .name = "continuously_yielding",
            .doc = "A joint that yields from the first slip on, and whose friction wears down: for cyclic loading.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.continuously_yielding", .version = TALUS_VERSION,
          .doc = "Continuously yielding joint law.", .licence = "BSD-3-Clause");
