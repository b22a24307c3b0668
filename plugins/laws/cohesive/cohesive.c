/* cohesive.c - law "cohesive": a bond that softens in tension and shear until it is broken, and friction on what is
 * broken.
 *
 * Of the area a share D, the damage, is broken; the bonded rest is elastic:
 *
 *     s = kn closure + f_n0 / A                         normal stress, compression positive
 *     t_n = max(0, -s) + kn apart                       tension, also that of a part apart beside one that is closed
 *     t_s = shear stress of the bonded share (ks times its displacement)
 *     e^2 = (t_n / T)^2 + (t_s / c)^2                   onset of damage at e = 1
 *     h = t_n^2 / (2 kn GI) + t_s^2 / (2 ks GII),  r = e^2 / h
 *     D = r (e - 1) / (e (r - 1)),  never less          linear softening, broken at e = r
 *     f_n = A (max(0, s) - (1 - D) t_n)
 *     f_s = A ((1 - D) t_s + D q),  |q| <= tan(friction) max(0, s)
 *
 * r is the displacement at failure over that at onset. Of a path of one mode mix, the work of tension over GI and that
 * of shear over GII then add up to 1. What breaks keeps the stress it had, up to the friction, and q is the mean over
 * the broken share.
 *
 * Energy turned to heat: of the damage, and of slip of the broken share. Both are what the walls' work, by mean forces,
 * leaves of the stored energy: dD k x0 x1 / 2 of a bonded spring that goes from x0 to x1 while dD breaks. Averaging q
 * only loses energy.
 *
 * Source: Camanho and Davila, NASA/TM-2002-211737 (2002), with the linear criterion of failure; friction on the broken
 * share after Bisoffi-Sauve, Morel and Dubois, Eng. Struct. 182 (2019) 89-104, and Alfano and Sacco, Int. J. Numer.
 * Meth. Engng 68 (2006) 542-582. Walls that come near each other from afar have no bond.
 *
 * Limits: compression does not raise c; it does not crush. Damage begins where a point's area is pulled most, at its
 * outermost fibre. */
#include <talus/kit.h>
#include <talus/version.h>

/* A stress is scaled down to its limit, mixed with another and taken out of the force again. That leaves it within
 * some roundings of the limit. Without this margin a point at rest would be scaled down by them in every step. */
#define ROUNDING 1e-14
/* Damage that leaves less than this share bonded is whole: the stress of the rest could not be told from rounding. */
#define REST 1e-6
/* Damage that is found anew from the forces differs by roundings over the share left, and by less than this. */
#define NOISE 1e-9

typedef struct params {
    double kn, ks, tension, cohesion, energy_tension, energy_shear, friction;
} params;

/* What the bond has: > 0, and must be given. */
#define BOND(member, unit, strength, ...)                                                                              \
    TL_PARAM(TL_PARAM_REAL, params, member, unit, __VA_ARGS__,                                                         \
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN | (strength), .min = 0, .max = INFINITY)

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    BOND(tension, "Pa", TL_PARAM_STRENGTH, "tensile strength of the bond"),
    BOND(cohesion, "Pa", TL_PARAM_STRENGTH, "shear strength of the bond"),
    BOND(energy_tension, "J/m2", TL_PARAM_STRENGTH_ENERGY, "work of fracture in tension, more than tension^2 / (2 kn)",
         .alias = "gi"),
    BOND(energy_shear, "J/m2", TL_PARAM_STRENGTH_ENERGY, "work of fracture in shear, more than cohesion^2 / (2 ks)",
         .alias = "gii"),
    TL_PARAM_FRICTION(params, friction, 0, "angle of friction of what is broken; 90: no slip while it is pressed"),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "damage", "", "share of the bond that is broken: 0 whole, 1 lost"),
    TL_STATE(TL_STATE_TANGENT, "friction_stress", "Pa",
             "shear stress on block B that the broken share carries, over the whole area"),
};

typedef struct cohesive {
    double kn, ks, tangent;
    double per_tension2, per_cohesion2; /* 1 / T^2, 1 / c^2 */
    double per_normal, per_shear;       /* 1 / (2 kn GI), 1 / (2 ks GII) */
} cohesive;

/* A work of fracture no larger than the spring holds at onset would snap back. */
static bool snaps(const char *energy, double given, const char *strength, double stress, double k, tl_report *report)
{
    double least = 0.5 * stress * stress / k;
    if (given > least)
        return false;
    tl_refuse(report, "%s = %g J/m2 must be > %s^2 / (2 k) = %g J/m2, what the spring holds when damage begins", energy,
              given, strength, least);
    return true;
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (snaps("energy_tension", p->energy_tension, "tension", p->tension, p->kn, report) ||
        snaps("energy_shear", p->energy_shear, "cohesion", p->cohesion, p->ks, report))
        return TL_E_ARGUMENT;
    const cohesive law = {.kn = p->kn,
                          .ks = p->ks,
                          .tangent = tl_tan(p->friction * TL_DEGREE),
                          .per_tension2 = 1 / (p->tension * p->tension),
                          .per_cohesion2 = 1 / (p->cohesion * p->cohesion),
                          .per_normal = 0.5 / (p->kn * p->energy_tension),
                          .per_shear = 0.5 / (p->ks * p->energy_shear)};
    return tl_keep(&law, sizeof law, self, report);
}

/* The factor that brings a stress of this size down to its limit; 1 where it is below. */
TL_IN_LOOP double down_to(double size, double limit)
{
    double beyond = size > limit * (1 + ROUNDING) ? 1 : 0;
    return beyond > 0 ? limit / (beyond > 0 ? size : 1) : 1;
}

/* Damage as it is: where points have been put together, what is left may be a rounding. */
TL_IN_LOOP double told(double damage)
{
    return damage < 1 - NOISE ? damage : 1;
}

/* Damage that belongs to elastic stresses of the bond, squared: see the head of the file. */
TL_IN_LOOP double damage_of(const cohesive *law, double tension2, double shear2)
{
    double e2 = tension2 * law->per_tension2 + shear2 * law->per_cohesion2;
    double h = tension2 * law->per_normal + shear2 * law->per_shear;
    double e = sqrt(e2), r = e2 / (h > 0 ? h : 1);
    double damage = r * (e - 1) / (e * (r - 1) > 0 ? e * (r - 1) : 1);
    damage = damage < 1 - REST ? damage : 1;
    return e > 1 ? damage : 0;
}

TL_IN_LOOP tl_vec3 either(double first, tl_vec3 a, tl_vec3 b)
{
    return tl_v3(first > 0 ? a.x : b.x, first > 0 ? a.y : b.y, first > 0 ? a.z : b.z);
}

/* a u + b v */
TL_IN_LOOP tl_vec3 mix(double a, tl_vec3 u, double b, tl_vec3 v)
{
    return tl_v3_add(tl_v3_scale(a, u), tl_v3_scale(b, v));
}

/* What the broken share carries: what it did, if that is `then` as it is `now`. */
TL_IN_LOOP double carried(double before, double then, double now)
{
    return now == then ? before : now;
}

/* Heat of the slip of a spring of unit stiffness that is brought down from a trial stress; `along`: its product with
 * that before. */
TL_IN_LOOP double slip_heat(double along, double trial, double limit)
{
    double size = trial > limit ? trial : 1;
    return 0.5 * (along / size + limit) * (trial - limit);
}

/* Flags, as a number. */
TL_IN_LOOP double flag_of(double total, double lost, double anew, double breaks)
{
    double rubs = (anew > 0 ? 1 : 0) + (1 - lost) * breaks;
    double flag = lost * TL_POINT_FAILED + rubs * TL_POINT_SLIPPING;
    double apart = total < 0 ? lost : 0;
    return apart > 0 ? TL_POINT_FAILED + TL_POINT_OPEN : flag;
}

/* Tension that damages: that of the outermost fibre, if it is more than the mean. */
TL_IN_LOOP double most_pulled(double kn, double edge, double initial, double mean)
{
    double fibre = -(kn * edge + initial);
    return fibre > mean ? fibre : mean;
}

/* The law for up to TL_LANES points from `begin`. A NaN goes through all comparisons to the forces, where the host
 * finds it. `mark` is for tl_law_put_flags. */
TL_IN_LOOP void move(const cohesive *given, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                     double *restrict mark, double *restrict stored, double *restrict dissipated)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict damage = batch->state[0] + begin, *restrict rub_x = batch->state[1] + begin;
    double *restrict rub_y = batch->state[2] + begin, *restrict rub_z = batch->state[3] + begin;
    const double *restrict edge = batch->closure_edge + begin;
    const double *restrict apart = batch->closure_apart + begin;
    const cohesive law = *given;
    const double kn = law.kn, ks = law.ks, half_n = 0.5 / kn, half_s = 0.5 / ks;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0;
        double total = kn * c.area[i] * c.closure[i] + c.f_n0[i], stress = total * per;
        double beside = kn * apart[i], pull1 = (stress < 0 ? -stress : 0) + beside;
        double pull0 = pull1 > kn * c.du_n[i] ? pull1 - kn * c.du_n[i] : 0;
        double was = told(damage[i]), left = 1 - was, has = left > 0 ? 1 : 0;
        tl_vec3 d = TL_SLIDE_AT(c, i), f = TL_SHEAR_AT(c, i), before = tl_v3_scale(per, f);
        tl_vec3 carries = {rub_x[i], rub_y[i], rub_z[i]};
        /* a bond that is lost has all of its stress from friction, whatever the state says */
        double each = was > 0 ? 1 / (was > 0 ? was : 1) : 0;
        tl_vec3 q = either(left, tl_v3_scale(each, carries), before);
        /* shear of the bonded share, before and now */
        double inverse = has / (left > 0 ? left : 1), spring = has * ks;
        tl_vec3 a = tl_v3_scale(inverse, mix(1, before, -was, q)), b = mix(1, a, -spring, d);
        double shear2 = tl_v3_norm2(b);
        double most = most_pulled(kn, edge[i], c.f_n0[i] * per, pull1);
        double found = damage_of(&law, most * most, shear2);
        double is = found - was > NOISE ? found : was, right = 1 - is, broken = is - was;
        /* friction of what was broken, and of what breaks now */
        double limit = stress > 0 ? law.tangent * stress : 0, glide = was > 0 ? ks : 0;
        tl_vec3 t = mix(1, q, -glide, d);
        double trial = tl_v3_norm(t);
        double by_old = down_to(trial, limit), by_new = down_to(sqrt(shear2), limit);
        double share = broken > 0 ? broken / is : 0, o = (1 - share) * by_old, n = share * by_new;
        tl_vec3 r = mix(o, t, n, b);
        double rub2 = tl_v3_norm2(r);
        /* heat: of the bond and of new friction, or of slip alone */
        double bond = broken * (half_n * pull0 * pull1 + half_s * tl_v3_dot(a, b));
        double work = 0.5 * was * tl_v3_dot(q, d) + 0.5 * is * tl_v3_dot(r, d);
        double kept = half_s * (is * rub2 - was * tl_v3_norm2(q));
        double slides = trial > limit * (1 + ROUNDING) ? 1 : 0;
        double sliding = slides * was * slip_heat(tl_v3_dot(q, t), trial, limit) / ks;
        double heat = broken > 0 ? bond - work - kept : sliding;
        dissipated[i] = heat > 0 ? c.area[i] * heat : 0;
        /* changes, so that a point at rest keeps its force to the bit */
        tl_vec3 change = tl_v3_add(mix(right, b, -left, a), mix(is, r, -was, q));
        tl_vec3 after = mix(1, f, c.area[i], change);
        double breaks = broken > 0 ? 1 : 0, lost = right > 0 ? 0 : 1;
        /* 0 is added, for -0 would become 0 in the next step */
        double anew = lost * (breaks + slides);
        after = either(anew, tl_v3_add(tl_v3(0, 0, 0), tl_v3_scale(c.area[i], r)), after);
        mark[i] = flag_of(total, lost, anew, breaks);
        double press = stress > 0 ? stress : 0;
        double held = right * (half_n * pull1 * pull1 + half_s * shear2);
        stored[i] = c.area[i] * (held + half_n * press * press + is * half_s * rub2);
        c.f_n[i] = total < 0 ? right * total : total - right * (c.area[i] * beside);
        TL_PUT_SHEAR(c, i, 1, after);
        damage[i] = is;
        rub_x[i] = right > 0 ? carried(carries.x, was * q.x, is * r.x) : after.x * per;
        rub_y[i] = right > 0 ? carried(carries.y, was * q.y, is * r.y) : after.y * per;
        rub_z[i] = right > 0 ? carried(carries.z, was * q.z, is * r.z) : after.z * per;
    }
}

/* The same of points that have never been damaged nor rubbed, for TL_LANES lanes from `begin`, without roots and most
 * divisions. false, and nothing done, when some lane is or has been; the results are those of `move` to the bit. */
TL_IN_LOOP bool hold(const cohesive *given, const tl_law_batch *batch, uint32_t begin)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict damage = batch->state[0] + begin;
    const double *restrict rub_x = batch->state[1] + begin, *restrict rub_y = batch->state[2] + begin;
    const double *restrict rub_z = batch->state[3] + begin;
    const double *restrict edge = batch->closure_edge + begin;
    const double *restrict apart = batch->closure_apart + begin;
    const cohesive law = *given;
    const double kn = law.kn, ks = law.ks, half_n = 0.5 / kn, half_s = 0.5 / ks;
    double force[TL_LANES], x[TL_LANES], y[TL_LANES], z[TL_LANES], held[TL_LANES];
    double broken = 0;
#pragma omp simd reduction(+ : broken)
    for (uint32_t i = 0; i < TL_LANES; i++) {
        double per = c.area[i] > 0 ? 1 / c.area[i] : 0;
        double total = kn * c.area[i] * c.closure[i] + c.f_n0[i], stress = total * per;
        double beside = kn * apart[i];
        double pull = (stress < 0 ? -stress : 0) + beside, press = stress > 0 ? stress : 0;
        double most = most_pulled(kn, edge[i], c.f_n0[i] * per, pull);
        tl_vec3 f = TL_SHEAR_AT(c, i), a = tl_v3_scale(per, f);
        tl_vec3 b = mix(1, a, -ks, TL_SLIDE_AT(c, i));
        double shear2 = tl_v3_norm2(b), rub2 = tl_v3_norm2(tl_v3(rub_x[i], rub_y[i], rub_z[i]));
        double e2 = most * most * law.per_tension2 + shear2 * law.per_cohesion2;
        double beyond = e2 > 1 ? 1 : 0, was = damage[i] + rub2;
        /* not-a-number is for `move` */
        broken += was == 0 ? beyond : 1;
        broken += e2 >= 0 ? 0 : 1;
        force[i] = total - c.area[i] * beside;
        tl_vec3 after = mix(1, f, c.area[i], tl_v3_sub(b, a));
        x[i] = after.x;
        y[i] = after.y;
        z[i] = after.z;
        held[i] = c.area[i] * (half_n * pull * pull + half_s * shear2 + half_n * press * press);
    }
    if (broken > 0)
        return false;
    for (uint32_t i = 0; i < TL_LANES; i++) {
        c.f_n[i] = force[i];
        c.f_x[i] = x[i];
        c.f_y[i] = y[i];
        c.f_z[i] = z[i];
    }
    memset(batch->flags + begin, 0, TL_LANES * sizeof *batch->flags);
    if (batch->stored)
        memcpy(batch->stored + begin, held, sizeof held);
    if (batch->dissipated)
        memset(batch->dissipated + begin, 0, TL_LANES * sizeof *batch->dissipated);
    return true;
}

/* The law for `lanes` points from `begin`; a constant number of them at each call. */
TL_IN_LOOP void update_lanes(const cohesive *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes)
{
    double mark[TL_LANES], stored[TL_LANES], dissipated[TL_LANES];
    move(law, batch, begin, lanes, mark, batch->stored ? batch->stored + begin : stored,
         batch->dissipated ? batch->dissipated + begin : dissipated);
    tl_law_put_flags(batch, begin, lanes, mark);
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    uint32_t begin = 0;
    /* walls that came near from afar were never bonded */
    for (uint32_t i = 0; i < batch->count; i++)
        batch->state[0][i] = batch->flags[i] & TL_POINT_APART ? 1 : batch->state[0][i];
    for (; begin + TL_LANES <= batch->count; begin += TL_LANES)
        if (!hold(self, batch, begin))
            update_lanes(self, batch, begin, TL_LANES);
    if (begin < batch->count)
        update_lanes(self, batch, begin, batch->count - begin);
    return TL_OK;
}

TL_LAW_STIFFNESS(cohesive, kn, ks);

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    const cohesive *law = self;
    tl_law_lift(batch, law->kn, NULL, lift);
    for (uint32_t i = 0; i < batch->count; i++)
        hold[i] = batch->flags[i] & TL_POINT_APART ? 0 : 1 - told(batch->state[0][i]);
}

static const tl_law_ops ops =
    TL_LAW_OPS(.never_fails = 1, .linear = 1, .pulls = tl_pulls_bonded, .across_gap = across_gap);

static const tl_kind kind =
    TL_KIND(TL_KIND_LAW, ops, .name = "cohesive",
            .doc = "A bond that softens and breaks in tension and shear (mixed mode), with friction on what is broken.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(8, kind, .id = "talus.cohesive", .version = TALUS_VERSION, .doc = "Cohesive joint law of mixed mode.",
                .licence = "BSD-3-Clause");
