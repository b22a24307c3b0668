/* coulomb_tensile.c - law "coulomb_tensile": a bonded Coulomb joint that breaks once and for all.
 *
 *     f_n = kn A (closure + opening - apart) + f_n0 total, compression positive; after eq. (6)
 *     f_t = f_s - ks A du_s                         eq. (7), on block B
 *     fails when  f_e < -T A   or   |f_t| > max(0, c A + f_n tan(friction))       eq. (10)
 *     f_n < 0 where no tension is held:  f_n = 0, f_s = 0, open
 *     |f_t| > limit:  f_s = f_t limit / |f_t|       eq. (12), slipping
 *     opening += tan(dilation) slip                 up to dilation_limit tan(dilation)
 *
 * Where a part of the area is closed and another apart, by `apart` in the mean, the bond pulls on the latter; without
 * it only the closed part carries. f_e is the normal force that the area A would have with the closure at its outermost
 * fibre: a bond in bending breaks where it is pulled most. T, c and the friction are those of the bond while it holds.
 * At the first failure, in tension or in shear, the bond is lost for good: T, c and the friction drop to their residual
 * values within that step (brittle), as 3DEC does. State `bond` is 1 while it holds, 0 when lost; of a point that has
 * been given area of both kinds it is the share that is bonded. Such a point has the mean strengths in shear, pulls
 * with that share of its area, and fails where a whole one does; no residual tension holds on it. Since the closure is
 * a total one, a point that has opened carries again only where its walls meet. A residual tensile strength holds while
 * f_e >= -T A. Walls that have parted beyond it do not pull on their way back: it holds again once they have met over
 * the whole area. Dilation and its state `opening` are those of the law "coulomb"; under tension slip does not dilate.
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125; the loss of the bond
 * after the manual of 3DEC. Walls that come near each other from afar have no bond.
 *
 * Energy turned to heat: as in the law "coulomb", and what a tensile spring has got when it lets go, bond or residual.
 * The walls work by the mean of the forces before and after a step: tl_law_snap_work.
 *
 * Limit: as for "coulomb", changes of kn and ks and insitu belong before slip has opened the joint. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    double kn, ks, friction, cohesion, tension;
    double residual_friction, residual_cohesion, residual_tension;
    double dilation, dilation_limit;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    TL_PARAM_FRICTION(params, friction, 0, "angle of friction; 90: no slip while it is pressed"),
    TL_PARAM_STRONG(params, cohesion, "Pa", "cohesion of the bond"),
    TL_PARAM_STRONG(params, tension, "Pa", "tensile strength of the bond"),
    TL_PARAM_FRICTION(params, residual_friction, TL_PARAM_OPTIONAL,
                      "angle of friction after the bond is lost; not given: friction"),
    TL_PARAM_STRONG(params, residual_cohesion, "Pa", "cohesion after the bond is lost"),
    TL_PARAM_STRONG(params, residual_tension, "Pa", "tensile strength after the bond is lost"),
    TL_PARAM_ANGLE(params, dilation, TL_PARAM_STRENGTH_ANGLE,
                   "angle of dilation: slip opens the joint; at most the friction, whole and residual"),
    TL_PARAM(TL_PARAM_REAL, params, dilation_limit, "m", "slip after which dilation ends", .flags = TL_PARAM_OPTIONAL,
             .min = 0, .max = INFINITY),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "bond", "", "1 while the bond holds, 0 when it is lost", .initial = 1),
    TL_STATE(TL_STATE_SCALAR, "opening", "m", "how far slip has opened the joint", .transfer = TL_TRANSFER_LIFT),
};

/* Strength of a joint: with the bond, or without. */
typedef struct strength {
    double tangent, cohesion, tension;
} strength;

typedef struct bonded {
    double kn, ks;
    strength peak, residual;
    tl_law_dilation dilation;
    double most_pull; /* least normal force that counts for friction: tension takes nothing off that of 90 deg */
} bonded;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    double residual = isnan(p->residual_friction) ? p->friction : p->residual_friction;
    double least = residual < p->friction ? residual : p->friction;
    if (p->dilation > least)
        return tl_refuse(report, "dilation = %g deg must be <= %s = %g deg, or slip would make energy", p->dilation,
                         least < p->friction ? "residual_friction" : "friction", least);
    const bonded law = {
        .kn = p->kn,
        .ks = p->ks,
        .peak = {tl_tan(p->friction * TL_DEGREE), p->cohesion, p->tension},
        .residual = {tl_tan(residual * TL_DEGREE), p->residual_cohesion, p->residual_tension},
        .dilation = tl_law_dilation_of(p->dilation, p->dilation_limit),
        .most_pull = p->friction < 90 && residual < 90 ? -INFINITY : 0,
    };
    return tl_keep(&law, sizeof law, self, report);
}

/* A bond after a step, and the strength that is left with it. */
typedef struct gripping {
    double bond, tangent, cohesion;
} gripping;

/* The normal force that counts for friction. */
TL_IN_LOOP double normal_for_friction(double total, double most_pull)
{
    return total < most_pull ? most_pull : total;
}

/* Whether a bond holds a step: under a shear force on trial, what presses or pulls, and the force at the outermost
 * fibre. */
TL_IN_LOOP gripping hold_on(const strength *peak, const strength *residual, double before, double area, double trial,
                            double total, double fibre, double most_pull)
{
    double rest = 1 - before;
    double bound = (before * peak->cohesion + rest * residual->cohesion) * area +
                   normal_for_friction(total, most_pull) * (before * peak->tangent + rest * residual->tangent);
    double after = trial > (bound < 0 ? 0 : bound) ? 0 : before;
    after = fibre < -peak->tension * area ? 0 : after;
    rest = 1 - after;
    return (gripping){after, after * peak->tangent + rest * residual->tangent,
                      after * peak->cohesion + rest * residual->cohesion};
}

/* The law itself, for up to TL_LAW_STRIDE lanes from `begin`. `heat` and `dilates` are constants at each call, so that
 * the loop exists once for each and none has a branch in it; without dilation the opening of slip in the past still
 * counts. A NaN goes through all comparisons to the forces, where the host finds it. `mark` is given 1 of walls that
 * were apart and have not met since, else 0, and is then for tl_law_put_flags. `more` takes the energy beyond that of
 * the sum f_n: P Q / (kn A) of points of which a part presses and another pulls, and that of a share that pulls
 * alone. */
TL_IN_LOOP void move(const bonded *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                     double *restrict mark, double *restrict more, const int heat, const int dilates)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict edge = batch->closure_edge + begin;
    const double *restrict apart = batch->closure_apart + begin;
    double *restrict bond = batch->state[0] + begin, *restrict opening = batch->state[1] + begin;
    double *restrict dissipated = heat ? batch->dissipated + begin : NULL;
    const double kn = law->kn, ks = law->ks, most_pull = law->most_pull;
    const tl_law_dilation dilation = law->dilation;
    const strength peak = law->peak, residual = law->residual;
    /* without tensile strength nothing pulls */
    const double grips = peak.tension > 0 ? 1 : 0, grips_on = residual.tension > 0 ? 1 : 0;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double stiffness = ks * c.area[i], opened = opening[i], lift = 0;
        double pressed = kn * c.area[i] * (c.closure[i] + opened) + c.f_n0[i];
        double before = bond[i], near = 1 - mark[i];
        double whole = before * (1 - before) > 0 ? 0 : grips_on; /* of a share nothing does */
        double held = before > 0 ? before * grips : near * whole;
        double grip = kn * c.area[i] * apart[i], pull = held * grip;
        tl_vec3 f = TL_TRIAL_AT(c, i, stiffness);
        double trial = tl_v3_norm(f);

        double fibre = kn * c.area[i] * (edge[i] + opened) + c.f_n0[i];
        gripping g = hold_on(&peak, &residual, before, c.area[i], trial,
                             (pressed < 0 ? held * pressed : pressed) - pull, fibre, most_pull);
        double after = g.bond, tangent = g.tangent, cohesion = g.cohesion;
        double left = fibre < -residual.tension * c.area[i] ? 0 : whole;
        double holds = after * grips + (held - after * grips) * left;
        double pulls = holds * grip, total = pressed - pulls;
        if (dilates) {
            double strong = cohesion * c.area[i] + normal_for_friction(total, most_pull) * tangent;
            lift = tl_law_lift_of_slip(dilation, trial, strong, c.f_n[i], total, kn * c.area[i], stiffness, tangent,
                                       opened);
            opened = opened + lift;
            opening[i] = opened;
            pressed = kn * c.area[i] * (c.closure[i] + opened) + c.f_n0[i];
            total = pressed - pulls;
        }
        double parted = pressed < 0 ? 1 - holds : 0, stretched = pressed < 0 ? -pressed : 0;
        total = pressed < 0 ? -(holds * stretched) - pulls : total;
        double limit =
            (cohesion - parted * residual.cohesion) * c.area[i] + normal_for_friction(total, most_pull) * tangent;
        limit = ((limit < 0) | !(parted < 1)) ? 0 : limit;
        double scale = tl_law_scale(trial, limit);
        if (heat) {
            double along = tl_v3_dot(TL_SHEAR_AT(c, i), f);
            double pays = dilates ? 0.5 * (c.f_n[i] + total) * lift : 0;
            double work = tl_law_slip_heat(along, trial, limit, stiffness, pays);
            /* What lets go gives up its tensile spring. */
            dissipated[i] = work + (held - holds) * tl_law_snap_work(grip + stretched, kn * c.area[i], c.du_n[i]);
        }
        double let_go = ((pressed > 0) & !(apart[i] > 0)) ? 0 : grips_on * (1 - holds);
        double lost = TL_POINT_FAILED + let_go * TL_POINT_APART;
        mark[i] = after > 0 ? 0 : lost;
        double flag = trial > TL_LAW_MOST(limit) ? TL_POINT_SLIPPING : 0;
        mark[i] += !(parted < 1) ? TL_POINT_OPEN : flag;
        c.f_n[i] = !(parted < 1) ? 0 : total;
        double alone = 0.5 * holds * (1 - holds) * (stretched * stretched + grip * grip);
        more[i] =
            (pulls * (pressed < 0 ? -(holds * stretched) : pressed) + alone) / (c.area[i] > 0 ? kn * c.area[i] : 1);
        TL_PUT_SHEAR(c, i, scale, f);
        bond[i] = after;
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const bonded *law = self;
    tl_law_scratch mark, more;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LAW_STRIDE) {
        uint32_t left = batch->count - begin, lanes = left < TL_LAW_STRIDE ? left : TL_LAW_STRIDE;
        /* walls that came near from afar were never bonded */
        for (uint32_t i = 0; i < lanes; i++) {
            mark[i] = batch->flags[begin + i] & TL_POINT_APART ? 1 : 0;
            batch->state[0][begin + i] = mark[i] > 0 ? 0 : batch->state[0][begin + i];
        }
        if (law->dilation.tangent > 0 && batch->dissipated)
            move(law, batch, begin, lanes, mark, more, 1, 1);
        else if (law->dilation.tangent > 0)
            move(law, batch, begin, lanes, mark, more, 0, 1);
        else if (batch->dissipated)
            move(law, batch, begin, lanes, mark, more, 1, 0);
        else
            move(law, batch, begin, lanes, mark, more, 0, 0);
        tl_law_put_flags(batch, begin, lanes, mark);
        tl_law_store_energy(batch, begin, lanes, law->kn, law->ks);
        for (uint32_t i = 0; i < lanes && batch->stored; i++)
            batch->stored[begin + i] += more[i];
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(bonded, kn, ks);

static uint32_t pulls(const void *self)
{
    const bonded *law = self;
    if (law->residual.tension > 0)
        return TL_PULL_ANY;
    return law->peak.tension > 0 ? TL_PULL_BONDED : TL_PULL_NONE;
}

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    const bonded *law = self;
    const double *bond = batch->state[0], strong = law->peak.tension > 0 ? 1 : 0;
    const double strong_on = law->residual.tension > 0 ? 1 : 0;
    tl_law_lift(batch, law->kn, batch->state[1], lift);
    for (uint32_t i = 0; i < batch->count; i++)
        hold[i] = batch->flags[i] & TL_POINT_APART ? 0 : bond[i] > 0 ? bond[i] * strong : strong_on;
}

static const tl_law_ops ops = TL_LAW_OPS(.never_fails = 1, .linear = 1, .pulls = pulls, .across_gap = across_gap);

static const tl_kind kind =
    TL_KIND(TL_KIND_LAW, ops, .name = "coulomb_tensile",
            .doc = "Coulomb friction with a bond that breaks in tension or shear and does not heal.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(8, kind, .id = "talus.coulomb_tensile", .version = TALUS_VERSION,
                .doc = "Coulomb joint law with a brittle bond.", .licence = "BSD-3-Clause");
