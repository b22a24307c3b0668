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
 * linear: slip = (|f_t| - limit) / (ks A + kn A tan(dilation) tan(friction)).
 *
 * Source: Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125. The cohesion stays
 * after slip, and comes back when an opened point closes; see coulomb_tensile for a bond that is lost.
 *
 * Energy turned to heat by slip: the plastic slip (|f_t| - |f_s|) / (ks A) along f_t times the mean of
 * the shear forces before and after in that direction. With the work of the mean force over du_s this
 * balances the change of stored energy exactly; for a reversal within one step it is taken as 0. Of
 * the work of slip, the part f_n tan(dilation) slip lifts the walls against the pressure and is not
 * heat: it is stored in the normal spring or given back to what presses. The rest,
 * (c A + f_n (tan(friction) - tan(dilation))) slip, is heat, and never less than 0 because dilation
 * above friction is refused.
 *
 * Limit: a change of kn or ks, and insitu, take the present force as the one at closure 0; they belong
 * before slip has opened the joint. */
#include <talus/elementary.h>
#include <talus/plugin.h>
#include <talus/version.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (3.14159265358979323846 / 180)
/* Lanes worked on at a time: none of them slips, or all are looked at for slip. */
#define STRIDE TL_LANES
/* Scaling a force down to its limit leaves it within 2 roundings of it; without this margin a point at
 * rest would be scaled down by a rounding in every step. */
#define ROUNDING 1e-15

typedef struct params {
    double kn, ks, friction, cohesion, dilation, dilation_limit;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, kn, "Pa/m", "normal stiffness of the joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, ks, "Pa/m", "shear stiffness of the joint",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, friction, "deg", "angle of friction",
             .flags = TL_PARAM_MAX_OPEN, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, cohesion, "Pa", "shear strength at zero normal stress",
             .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, dilation, "deg",
             "angle of dilation: slip opens the joint; at most the friction",
             .flags = TL_PARAM_MAX_OPEN, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dilation_limit, "m", "slip after which dilation ends",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = INFINITY),
};

static const tl_state state_table[] = {
    {.size = sizeof(tl_state),
     .kind = TL_STATE_SCALAR,
     .transfer = TL_TRANSFER_COPY,
     .name = "opening",
     .unit = "m",
     .doc = "how far slip has opened the joint",
     .initial = 0},
};

typedef struct coulomb {
    double kn, ks, tangent, cohesion;
    double dilation, most_opening; /* tangent; m */
} coulomb;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (p->dilation > p->friction) {
        snprintf(report->text, sizeof report->text,
                 "dilation = %g deg must be <= friction = %g deg, or slip would make energy",
                 p->dilation, p->friction);
        return TL_E_ARGUMENT;
    }
    coulomb *law = malloc(sizeof *law);
    if (!law) {
        snprintf(report->text, sizeof report->text, "out of memory");
        return TL_E_MEMORY;
    }
    *law = (coulomb){
        .kn = p->kn,
        .ks = p->ks,
        .tangent = tl_tan(p->friction * DEGREE),
        .cohesion = p->cohesion,
        .dilation = tl_tan(p->dilation * DEGREE),
        .most_opening =
            isnan(p->dilation_limit) ? INFINITY : tl_tan(p->dilation * DEGREE) * p->dilation_limit,
    };
    *self = law;
    return TL_OK;
}

/* Elastic energy of both springs; 0 for a lane of no area. */
static inline __attribute__((always_inline)) void store_energy(const coulomb *law,
                                                               const tl_law_batch *batch,
                                                               uint32_t begin, uint32_t lanes)
{
    const double *restrict area = batch->area + begin, *restrict f_n = batch->f_n + begin;
    const double *restrict f_x = batch->f_s[0] + begin, *restrict f_y = batch->f_s[1] + begin;
    const double *restrict f_z = batch->f_s[2] + begin;
    double *restrict stored = batch->stored + begin;
    const double half_n = 0.5 / law->kn, half_s = 0.5 / law->ks;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double inverse = area[i] > 0 ? 1 / (area[i] > 0 ? area[i] : 1) : 0;
        double shear2 = f_x[i] * f_x[i] + f_y[i] * f_y[i] + f_z[i] * f_z[i];
        stored[i] = (half_n * f_n[i] * f_n[i] + half_s * shear2) * inverse;
    }
}

/* The law where nothing slips, for TL_LANES lanes from `begin`: most of a rock mass at most times, and
 * without its roots and divisions. false, and nothing done, when some lane slips; the results are those of
 * `move` to the bit. */
static inline __attribute__((always_inline)) bool stick(const coulomb *law,
                                                        const tl_law_batch *batch, uint32_t begin)
{
    const double *restrict area = batch->area + begin, *restrict closure = batch->closure + begin;
    const double *restrict f_n0 = batch->f_n0 + begin, *restrict opening = batch->state[0] + begin;
    const double *restrict du_x = batch->du_s[0] + begin, *restrict du_y = batch->du_s[1] + begin;
    const double *restrict du_z = batch->du_s[2] + begin;
    double *restrict f_n = batch->f_n + begin, *restrict f_x = batch->f_s[0] + begin;
    double *restrict f_y = batch->f_s[1] + begin, *restrict f_z = batch->f_s[2] + begin;
    const double kn = law->kn, ks = law->ks, tangent = law->tangent, cohesion = law->cohesion;
    double total[TL_LANES], tx[TL_LANES], ty[TL_LANES], tz[TL_LANES], mark[TL_LANES];
    uint64_t beyond[TL_LANES], any = 0;
#pragma omp simd
    for (uint32_t i = 0; i < TL_LANES; i++) {
        double stiffness = ks * area[i];
        total[i] = kn * area[i] * (closure[i] + opening[i]) + f_n0[i];
        tx[i] = f_x[i] - stiffness * du_x[i];
        ty[i] = f_y[i] - stiffness * du_y[i];
        tz[i] = f_z[i] - stiffness * du_z[i];
        double limit = total[i] < 0 ? 0 : cohesion * area[i] + total[i] * tangent;
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
        f_n[i] = total[i] < 0 ? 0 : total[i];
        f_x[i] = tx[i];
        f_y[i] = ty[i];
        f_z[i] = tz[i];
        mark[i] = total[i] < 0 ? TL_POINT_OPEN : 0;
    }
    uint32_t *restrict flags = batch->flags + begin;
#pragma omp simd
    for (uint32_t i = 0; i < TL_LANES; i++)
        flags[i] = (uint32_t)(int32_t)mark[i];
    if (batch->dissipated)
        memset(batch->dissipated + begin, 0, TL_LANES * sizeof *batch->dissipated);
    return true;
}

/* The law itself, for up to STRIDE lanes from `begin`. `heat` and `dilates` are constants at each call,
 * so that the loop exists once for each and none has a branch in it; without dilation the opening of
 * slip in the past still counts. A NaN goes through
 * all comparisons to the forces, where the host finds it. `mark` takes the flags as doubles: a loop
 * over lanes of two widths is not vectorised for every machine. */
static inline __attribute__((always_inline)) void move(const coulomb *law,
                                                       const tl_law_batch *batch, uint32_t begin,
                                                       uint32_t lanes, double *restrict mark,
                                                       const int heat, const int dilates)
{
    const double *restrict area = batch->area + begin, *restrict closure = batch->closure + begin;
    const double *restrict f_n0 = batch->f_n0 + begin;
    const double *restrict du_x = batch->du_s[0] + begin, *restrict du_y = batch->du_s[1] + begin;
    const double *restrict du_z = batch->du_s[2] + begin;
    double *restrict f_n = batch->f_n + begin, *restrict f_x = batch->f_s[0] + begin;
    double *restrict f_y = batch->f_s[1] + begin, *restrict f_z = batch->f_s[2] + begin;
    double *restrict opening = batch->state[0] + begin;
    double *restrict dissipated = heat ? batch->dissipated + begin : NULL;
    const double kn = law->kn, ks = law->ks, tangent = law->tangent, cohesion = law->cohesion;
    const double dilation = law->dilation, most_opening = law->most_opening;
#pragma omp simd
    for (uint32_t i = 0; i < lanes; i++) {
        double stiffness = ks * area[i], opened = opening[i], lift = 0;
        double total = kn * area[i] * (closure[i] + opened) + f_n0[i];
        double tx = f_x[i] - stiffness * du_x[i];
        double ty = f_y[i] - stiffness * du_y[i];
        double tz = f_z[i] - stiffness * du_z[i];
        double trial = sqrt(tx * tx + ty * ty + tz * tz);
        if (dilates) {
            double strength = cohesion * area[i] + total * tangent;
            double yield = stiffness + kn * area[i] * dilation * tangent;
            double grown = dilation * (trial - strength) / (yield > 0 ? yield : 1);
            double room = most_opening > opened ? most_opening - opened : 0;
            grown = grown < room ? grown : room;
            grown = total < 0 ? 0 : grown;
            lift = trial > strength * (1 + ROUNDING) ? grown : 0;
            opened = opened + lift;
            opening[i] = opened;
            total = kn * area[i] * (closure[i] + opened) + f_n0[i];
        }
        double normal = total < 0 ? 0 : total;
        double limit = total < 0 ? 0 : cohesion * area[i] + normal * tangent;
        double most = limit * (1 + ROUNDING);
        double whole = trial > most ? trial : 1;
        double scale = trial > most ? limit / whole : 1;
        if (heat) {
            double mean = 0.5 * ((f_x[i] * tx + f_y[i] * ty + f_z[i] * tz) / whole + limit);
            double slip = (trial - limit) / (stiffness > 0 ? stiffness : 1);
            double work = trial > most ? mean * slip : 0;
            if (dilates)
                work = work - 0.5 * (f_n[i] + normal) * lift;
            work = work > 0 ? work : 0;
            dissipated[i] = stiffness > 0 ? work : 0;
        }
        double flag = trial > most ? TL_POINT_SLIPPING : 0;
        mark[i] = total < 0 ? TL_POINT_OPEN : flag;
        f_n[i] = normal;
        f_x[i] = scale * tx;
        f_y[i] = scale * ty;
        f_z[i] = scale * tz;
    }
}

/* The law for up to STRIDE lanes from `begin`; a constant number of them at each call. */
static inline __attribute__((always_inline)) void update_lanes(const coulomb *law,
                                                               const tl_law_batch *batch,
                                                               uint32_t begin, uint32_t lanes)
{
    double mark[STRIDE];
    if (law->dilation > 0 && batch->dissipated)
        move(law, batch, begin, lanes, mark, 1, 1);
    else if (law->dilation > 0)
        move(law, batch, begin, lanes, mark, 0, 1);
    else if (batch->dissipated)
        move(law, batch, begin, lanes, mark, 1, 0);
    else
        move(law, batch, begin, lanes, mark, 0, 0);
    for (uint32_t i = 0; i < lanes; i++)
        batch->flags[begin + i] = (uint32_t)(int32_t)mark[i];
}

/* Energies at once, not in a loop of their own: their divisions are made while the next lanes are worked on. */
TL_VECTORIZED static tl_status update(const void *self, const tl_law_batch *batch,
                                      tl_report *report)
{
    (void)report;
    const coulomb *law = self;
    uint32_t begin = 0;
    for (; begin + STRIDE <= batch->count; begin += STRIDE) {
        if (!stick(law, batch, begin))
            update_lanes(law, batch, begin, STRIDE);
        if (batch->stored)
            store_energy(law, batch, begin, STRIDE);
    }
    if (begin < batch->count) {
        update_lanes(law, batch, begin, batch->count - begin);
        if (batch->stored)
            store_energy(law, batch, begin, batch->count - begin);
    }
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    const coulomb *law = self;
    *kn = law->kn;
    *ks = law->ks;
}

static int stateless(const void *self)
{
    return ((const coulomb *)self)->dilation == 0;
}

/* Open points carry nothing, unless slip has lifted them. */
static uint32_t pulls(const void *self)
{
    return ((const coulomb *)self)->dilation > 0 ? TL_PULL_ANY : TL_PULL_NONE;
}

static const tl_law_ops ops = {.size = sizeof ops,
                               .create = create,
                               .update = update,
                               .stiffness = stiffness,
                               .destroy = free,
                               .stateless = stateless,
                               .never_fails = true,
                               .pulls = pulls};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_LAW,
    .name = "coulomb",
    .doc = "Coulomb friction with cohesion and dilation, and no tensile strength.",
    TL_KIND_PARAMS(params, param_table),
    TL_KIND_STATES(state_table),
    .ops = &ops,
};

TL_PLUGIN(kind, .id = "talus.coulomb", .version = TALUS_VERSION, .doc = "Coulomb joint law.",
          .licence = "BSD-3-Clause");
