/* coulomb.c - law "coulomb": elastic springs with a Coulomb limit on shear and no tensile strength.
 *
 *     f_n = kn A (closure + opening) + f_n0         total, compression positive; after eq. (6)
 *     f_n < 0:  f_n = 0, f_s = 0, open
 *     f_t = f_s - ks A du_s                         eq. (7), on block B
 *     limit = c A + f_n tan(friction)               eq. (10)
 *     |f_t| > limit:  f_s = f_t limit / |f_t|       eq. (12), slipping
 *     opening += tan(dilation) slip                 up to dilation_limit tan(dilation)
 *
 * A total closure: a point that has opened carries again only where its walls meet. State `opening`
 * is how far slip has lifted the walls off each other; it stays, so unloading goes back along the
 * same line. The limit is that of the pressure the slip itself adds, found in one step since all is
 * linear: slip = (|f_t| - limit) / (ks A + kn A tan(dilation) tan(friction)). Closed walls stay closed while slip lifts
 * them as fast as they part, though a step may part them by more than they were closed.
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125. The cohesion stays
 * after slip, and comes back when an opened point closes; see coulomb_tensile for a bond that is lost.
 *
 * Energy turned to heat by slip: the plastic slip (|f_t| - |f_s|) / (ks A) along f_t times the mean of the shear forces
 * before and after in that direction. With the work of the mean force over du_s this balances the change of stored
 * energy exactly; for a reversal within one step it is taken as 0. Of the work of slip, the part f_n tan(dilation) slip
 * lifts the walls against the pressure and is not heat: it is stored in the normal spring or given back to what
 * presses. The rest, (c A + f_n (tan(friction) - tan(dilation))) slip, is heat, and never less than 0 because dilation
 * above friction is refused.
 *
 * Limit: a change of kn or ks, and insitu, take the present force as the one at closure 0; they belong
 * before slip has opened the joint. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    double kn, ks, friction, cohesion, dilation, dilation_limit;
} params;

static const tl_param param_table[] = {
    TL_PARAM_KN(params),
    TL_PARAM_KS(params),
    TL_PARAM_FRICTION(params, friction, 0, "angle of friction; 90: no slip while it is closed"),
    TL_PARAM_STRONG(params, cohesion, "Pa", "shear strength at zero normal stress"),
    TL_PARAM_ANGLE(params, dilation, TL_PARAM_STRENGTH_ANGLE,
                   "angle of dilation: slip opens the joint; at most the friction"),
    TL_PARAM(TL_PARAM_REAL, params, dilation_limit, "m", "slip after which dilation ends", .flags = TL_PARAM_OPTIONAL,
             .min = 0, .max = INFINITY),
};

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "opening", "m", "how far slip has opened the joint", .transfer = TL_TRANSFER_LIFT),
};

typedef struct coulomb {
    double kn, ks, tangent, cohesion;
    tl_law_dilation dilation;
} coulomb;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (p->dilation > p->friction)
        return tl_refuse(report, "dilation = %g deg must be <= friction = %g deg, or slip would make energy",
                         p->dilation, p->friction);
    const coulomb law = {
        .kn = p->kn,
        .ks = p->ks,
        .tangent = tl_tan(p->friction * TL_DEGREE),
        .cohesion = p->cohesion,
        .dilation = tl_law_dilation_of(p->dilation, p->dilation_limit),
    };
    return tl_keep(&law, sizeof law, self, report);
}

/* The law where nothing slips, for TL_LANES lanes from `begin`: most of a rock mass at most times, and without its
 * roots and divisions. false, and nothing done, when some lane slips; the results are those of `move` to the bit. */
TL_IN_LOOP bool stick(const coulomb *law, const tl_law_batch *batch, uint32_t begin)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    const double *restrict opening = batch->state[0] + begin;
    const double kn = law->kn, ks = law->ks, tangent = law->tangent, cohesion = law->cohesion;
    double total[TL_LANES], tx[TL_LANES], ty[TL_LANES], tz[TL_LANES], mark[TL_LANES];
    uint64_t beyond[TL_LANES], any = 0;
#pragma omp simd
    for (uint32_t i = 0; i < TL_LANES; i++) {
        double stiffness = ks * c.area[i];
        total[i] = kn * c.area[i] * (c.closure[i] + opening[i]) + c.f_n0[i];
        tx[i] = c.f_x[i] - stiffness * c.du_x[i];
        ty[i] = c.f_y[i] - stiffness * c.du_y[i];
        tz[i] = c.f_z[i] - stiffness * c.du_z[i];
        double limit = total[i] < 0 ? 0 : cohesion * c.area[i] + total[i] * tangent;
        double trial2 = tx[i] * tx[i] + ty[i] * ty[i] + tz[i] * tz[i];
        beyond[i] = trial2 > limit * limit ? 1 : 0;
    }
#pragma omp simd reduction(| : any)
    for (uint32_t i = 0; i < TL_LANES; i++)
        any |= beyond[i];
    if (any)
        return false;
#pragma omp simd
    for (uint32_t i = 0; i < TL_LANES; i++) {
        c.f_n[i] = total[i] < 0 ? 0 : total[i];
        c.f_x[i] = tx[i];
        c.f_y[i] = ty[i];
        c.f_z[i] = tz[i];
        mark[i] = total[i] < 0 ? TL_POINT_OPEN : 0;
    }
    tl_law_put_flags(batch, begin, TL_LANES, mark);
    if (batch->dissipated)
        memset(batch->dissipated + begin, 0, TL_LANES * sizeof *batch->dissipated);
    return true;
}

/* The law itself, for up to TL_LANES lanes from `begin`. `heat` and `dilates` are constants at each call, so that the
 * loop exists once for each and none has a branch in it; without dilation the opening of slip in the past still counts.
 * A NaN goes through all comparisons to the forces, where the host finds it. `mark` is for tl_law_put_flags. */
TL_IN_LOOP void move(const coulomb *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes,
                     double *restrict mark, const int heat, const int dilates)
{
    const tl_law_columns c = tl_law_columns_from(batch, begin);
    double *restrict opening = batch->state[0] + begin;
    double *restrict dissipated = heat ? batch->dissipated + begin : NULL;
    const double kn = law->kn, ks = law->ks, tangent = law->tangent, cohesion = law->cohesion;
    const tl_law_dilation dilation = law->dilation;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double stiffness = ks * c.area[i], opened = opening[i], lift = 0;
        double total = kn * c.area[i] * (c.closure[i] + opened) + c.f_n0[i];
        tl_vec3 f = TL_TRIAL_AT(c, i, stiffness);
        double trial = tl_v3_norm(f);
        if (dilates) {
            double strength = cohesion * c.area[i] + total * tangent;
            lift = tl_law_lift_of_slip(dilation, trial, strength, c.f_n[i], total, kn * c.area[i], stiffness, tangent,
                                       opened);
            opened = opened + lift;
            opening[i] = opened;
            total = kn * c.area[i] * (c.closure[i] + opened) + c.f_n0[i];
        }
        double normal = total < 0 ? 0 : total;
        double limit = total < 0 ? 0 : cohesion * c.area[i] + normal * tangent;
        double scale = tl_law_scale(trial, limit);
        if (heat) {
            double along = tl_v3_dot(TL_SHEAR_AT(c, i), f);
            double pays = dilates ? 0.5 * (c.f_n[i] + normal) * lift : 0;
            dissipated[i] = tl_law_slip_heat(along, trial, limit, stiffness, pays);
        }
        double flag = trial > TL_LAW_MOST(limit) ? TL_POINT_SLIPPING : 0;
        mark[i] = total < 0 ? TL_POINT_OPEN : flag;
        c.f_n[i] = normal;
        TL_PUT_SHEAR(c, i, scale, f);
    }
}

/* The law for up to TL_LANES lanes from `begin`; a constant number of them at each call. */
TL_IN_LOOP void update_lanes(const coulomb *law, const tl_law_batch *batch, uint32_t begin, uint32_t lanes)
{
    double mark[TL_LANES];
    if (law->dilation.tangent > 0 && batch->dissipated)
        move(law, batch, begin, lanes, mark, 1, 1);
    else if (law->dilation.tangent > 0)
        move(law, batch, begin, lanes, mark, 0, 1);
    else if (batch->dissipated)
        move(law, batch, begin, lanes, mark, 1, 0);
    else
        move(law, batch, begin, lanes, mark, 0, 0);
    tl_law_put_flags(batch, begin, lanes, mark);
}

/* Energies at once, not in a loop of their own: their divisions are made while the next lanes are worked on. */
TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const coulomb *law = self;
    uint32_t begin = 0;
    for (; begin + TL_LANES <= batch->count; begin += TL_LANES) {
        if (!stick(law, batch, begin))
            update_lanes(law, batch, begin, TL_LANES);
        tl_law_store_energy(batch, begin, TL_LANES, law->kn, law->ks);
    }
    if (begin < batch->count) {
        update_lanes(law, batch, begin, batch->count - begin);
        tl_law_store_energy(batch, begin, batch->count - begin, law->kn, law->ks);
    }
    return TL_OK;
}

TL_LAW_STIFFNESS(coulomb, kn, ks);

static int stateless(const void *self)
{
    return ((const coulomb *)self)->dilation.tangent == 0;
}

static void across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    tl_law_lift(batch, ((const coulomb *)self)->kn, batch->state[0], lift);
    tl_law_hold_none(batch, hold);
}

static const tl_law_ops ops =
    TL_LAW_OPS(.never_fails = 1, .linear = 1, .pulls = tl_pulls_none, .stateless = stateless, .across_gap = across_gap);

static const tl_kind kind = TL_KIND(TL_KIND_LAW, ops, .name = "coulomb",
                                    .doc = "Coulomb friction with cohesion and dilation, and no tensile strength.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN(kind, .id = "talus.coulomb", .version = TALUS_VERSION, .doc = "Coulomb joint law.",
          .licence = "BSD-3-Clause");
