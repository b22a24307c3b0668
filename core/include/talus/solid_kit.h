/* solid_kit.h - what solids have in common, for whoever writes one: elasticity, principal stresses, flags, energies.
 *
 * Functions on lanes take the TL_LANES zones of a batch from `begin` on, which are a group. A solid works group by
 * group: its columns then stay in the nearest cache, and a group that stays elastic ends early. What happens to a zone
 * may not depend on the others of its group.
 *
 * Signs: tension is positive; components are in the order xx yy zz xy yz zx. */
#ifndef TALUS_SOLID_KIT_H
#define TALUS_SOLID_KIT_H

#include <talus/kit.h>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunknown-pragmas"
#endif

/* A number of each zone of a group, and the six components of a tensor. */
typedef double tl_lanes[TL_LANES];
typedef tl_lanes tl_lanes6[6];

/* A loop over the zones of a group, which are a vector. */
#define TL_EACH_LANE(i) for (uint32_t i = 0; i < TL_LANES; i++)

/* ---------------------------------------------------------------- elasticity ------------- */

/* Rows of the table of parameters of a struct `owner` with the members young, poisson, bulk and shear. */
#define TL_PARAMS_ELASTIC(owner)                                                                                       \
    TL_PARAM_POSITIVE_OR_NONE(owner, young, "Pa", "Young's modulus; with poisson"),                                    \
        TL_PARAM(TL_PARAM_REAL, owner, poisson, "", "Poisson's ratio; with young", .alias = "nu",                      \
                 .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN, .min = -1, .max = 0.5),           \
        TL_PARAM_POSITIVE_OR_NONE(owner, bulk, "Pa", "bulk modulus; with shear, in the place of young and poisson"),   \
        TL_PARAM_POSITIVE_OR_NONE(owner, shear, "Pa", "shear modulus; with bulk")

/* Moduli of an isotropic solid, Pa. */
typedef struct tl_isotropic {
    double bulk, shear;
    double lame;        /* K - 2 G / 3 */
    double constrained; /* K + 4 G / 3 */
} tl_isotropic;

/* Of the parameters of TL_PARAMS_ELASTIC; refuses what is not one of the two pairs. */
static inline tl_status tl_isotropic_of(double young, double poisson, double bulk, double shear, tl_isotropic *out,
                                        tl_report *report)
{
    int first = !isnan(young) + !isnan(poisson), second = !isnan(bulk) + !isnan(shear);
    if (!((first == 2 && second == 0) || (first == 0 && second == 2)))
        return tl_refuse(report, "give young and poisson, or bulk and shear, and none of the other pair");
    out->bulk = first ? young / (3 * (1 - 2 * poisson)) : bulk;
    out->shear = first ? young / (2 * (1 + poisson)) : shear;
    out->lame = out->bulk - 2 * out->shear / 3;
    out->constrained = out->bulk + 4 * out->shear / 3;
    return TL_OK;
}

/* Defines `moduli` for a struct `type` whose member `elastic` is a tl_isotropic. */
#define TL_SOLID_MODULI(type)                                                                                          \
    static void moduli(const void *self, double *constrained, double *shear)                                           \
    {                                                                                                                  \
        *constrained = ((const type *)self)->elastic.constrained;                                                      \
        *shear = ((const type *)self)->elastic.shear;                                                                  \
    }                                                                                                                  \
    _Static_assert(sizeof(type) > 0, "a struct")

/* Operations of a solid that has made itself with tl_keep and never fails: `create`, `update`, `moduli`, `energy` and
 * what is given. */
#define TL_SOLID_OPS(...)                                                                                              \
    {                                                                                                                  \
        .size = sizeof(tl_solid_ops), .create = create, .update = update, .moduli = moduli, .destroy = free,           \
        .energy = energy, .never_fails = 1, __VA_ARGS__                                                                \
    }

/* sigma + D d, the stress if the step were elastic. */
TL_IN_LOOP void tl_solid_trial(const tl_solid_batch *batch, uint32_t begin, const tl_isotropic *elastic,
                               tl_lanes6 trial)
{
    const double lame = elastic->lame, twice = 2 * elastic->shear;
    const double *xx = batch->strain[0] + begin, *yy = batch->strain[1] + begin, *zz = batch->strain[2] + begin;
    for (uint32_t k = 0; k < 6; k++) {
        const double *strain = batch->strain[k] + begin, *stress = batch->stress[k] + begin;
        const double volumetric = k < 3 ? lame : 0;
        TL_EACH_ALONE
        TL_EACH_LANE(i)
        trial[k][i] = stress[i] + (volumetric * (xx[i] + yy[i] + zz[i]) + twice * strain[i]);
    }
}

/* Elastic energy of a stress of an isotropic solid, J/m3: s:s / (4 G) + p^2 / (2 K). */
TL_IN_LOOP double tl_isotropic_energy(double bulk, double shear, double xx, double yy, double zz, double xy, double yz,
                                      double zx)
{
    double p = (xx + yy + zz) / 3;
    double x = xx - p, y = yy - p, z = zz - p;
    double squares = x * x + y * y + z * z + 2 * (xy * xy + yz * yz + zx * zx);
    return squares / (4 * shear) + p * p / (2 * bulk);
}

/* `energy` of an isotropic solid. */
TL_IN_LOOP void tl_isotropic_energies(const tl_isotropic *elastic, uint32_t count, const double *const stress[6],
                                      double *stored)
{
    const double bulk = elastic->bulk, shear = elastic->shear;
    const double *xx = stress[0], *yy = stress[1], *zz = stress[2], *xy = stress[3], *yz = stress[4], *zx = stress[5];
    TL_EACH_ALONE
    for (uint32_t i = 0; i < count; i++)
        stored[i] = tl_isotropic_energy(bulk, shear, xx[i], yy[i], zz[i], xy[i], yz[i], zx[i]);
}

/* ---------------------------------------------------------------- axes ------------------- */

/* Rows of the table of parameters of a struct `owner` with the members dip and dip_direction, of layers or of a
 * plane. */
#define TL_PARAMS_DIP(owner, of)                                                                                       \
    TL_PARAM(TL_PARAM_REAL, owner, dip, "deg", "dip of " of " at the beginning", .min = 0, .max = 90),                 \
        TL_PARAM(TL_PARAM_REAL, owner, dip_direction, "deg", "dip direction of " of " at the beginning", .min = 0,     \
                 .max = 360)

/* The axis of a zone, of unit length, whose first column is `column`; `own` where it has none yet. */
TL_IN_LOOP void tl_axis_at(double *const *state, uint32_t column, uint32_t i, tl_vec3 own, double n[3])
{
    double x = state[column][i], y = state[column + 1][i], z = state[column + 2][i], size2 = x * x + y * y + z * z;
    double by = 1 / sqrt(size2 > 0 ? size2 : 1);
    n[0] = size2 > 0 ? x * by : own.x;
    n[1] = size2 > 0 ? y * by : own.y;
    n[2] = size2 > 0 ? z * by : own.z;
}

/* ---------------------------------------------------------------- results ---------------- */

/* What a flag of this step, TL_ZONE_SHEAR and the like as a number, makes of the flags before: what yielded before has
 * yielded in the past. */
TL_IN_LOOP uint32_t tl_zone_flags(uint32_t before, double mark)
{
    uint32_t past = before & (TL_ZONE_SHEAR_PAST | TL_ZONE_TENSION_PAST | TL_ZONE_JOINT_PAST);
    past |= (before & (TL_ZONE_SHEAR | TL_ZONE_TENSION)) << 2;
    past |= (before & TL_ZONE_JOINT) << 1;
    return past | (uint32_t)(int32_t)mark;
}

/* Heat of an isotropic solid whose stress would have become `trial`, J/m3: the mean of the stresses before and after,
 * times the plastic strain. Not below 0. */
TL_IN_LOOP void tl_isotropic_heat(const tl_solid_batch *batch, uint32_t begin, const tl_isotropic *elastic,
                                  const tl_lanes6 trial, const tl_lanes6 after)
{
    const double by_shear = 0.25 / elastic->shear, by_bulk = 0.5 / (3 * elastic->bulk);
    double *heat = batch->dissipated + begin;
    double *const *s = batch->stress;
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double xx = trial[0][i] - after[0][i], yy = trial[1][i] - after[1][i], zz = trial[2][i] - after[2][i];
        double mean = (xx + yy + zz) / 3, volume = mean * by_bulk;
        double work = (s[0][begin + i] + after[0][i]) * ((xx - mean) * by_shear + volume);
        work += (s[1][begin + i] + after[1][i]) * ((yy - mean) * by_shear + volume);
        work += (s[2][begin + i] + after[2][i]) * ((zz - mean) * by_shear + volume);
        double shear = (s[3][begin + i] + after[3][i]) * (trial[3][i] - after[3][i]);
        shear += (s[4][begin + i] + after[4][i]) * (trial[4][i] - after[4][i]);
        shear += (s[5][begin + i] + after[5][i]) * (trial[5][i] - after[5][i]);
        work += 2 * by_shear * shear;
        heat[i] = work > 0 ? work : 0;
    }
}

/* Puts stresses, flags and energies of a group of an isotropic solid into the batch. `mark`: flags of this step. */
TL_IN_LOOP void tl_isotropic_put(const tl_solid_batch *batch, uint32_t begin, const tl_isotropic *elastic,
                                 const tl_lanes6 trial, const tl_lanes6 after, const tl_lanes mark)
{
    if (batch->dissipated)
        tl_isotropic_heat(batch, begin, elastic, trial, after);
    if (batch->stored) {
        const double *const stress[6] = {after[0], after[1], after[2], after[3], after[4], after[5]};
        tl_isotropic_energies(elastic, TL_LANES, stress, batch->stored + begin);
    }
    for (uint32_t k = 0; k < 6; k++)
        memcpy(batch->stress[k] + begin, after[k], sizeof after[k]);
    uint32_t *flags = batch->flags + begin;
    TL_EACH_LANE(i)
    flags[i] = tl_zone_flags(flags[i], mark[i]);
}

/* ---------------------------------------------------------------- principal stresses ----- */

/* Principal stresses s[0] >= s[1] >= s[2], and their directions v[0], v[1] and v[2]. */
typedef struct tl_principal {
    double s[3], v[3][3];
} tl_principal;

/* A turn of Jacobi's method that takes the off-diagonal component *pq to 0. `rp` and `rq` are the other two, vp and vq
 * the directions of p and q. */
TL_IN_LOOP void tl_jacobi_turn(double *pp, double *qq, double *pq, double *rp, double *rq, double vp[3], double vq[3])
{
    double apart = *qq - *pp, twice = 2 * *pq;
    double root = sqrt(apart * apart + twice * twice), size = fabs(apart) + root;
    double tangent = (apart < 0 ? -twice : twice) / (size > 0 ? size : 1);
    double cosine = 1 / sqrt(1 + tangent * tangent), sine = tangent * cosine;
    double p = *rp, q = *rq;
    *pp -= tangent * *pq;
    *qq += tangent * *pq;
    *pq = 0;
    *rp = cosine * p - sine * q;
    *rq = sine * p + cosine * q;
    double x = vp[0], y = vp[1], z = vp[2];
    vp[0] = cosine * x - sine * vq[0];
    vp[1] = cosine * y - sine * vq[1];
    vp[2] = cosine * z - sine * vq[2];
    vq[0] = sine * x + cosine * vq[0];
    vq[1] = sine * y + cosine * vq[1];
    vq[2] = sine * z + cosine * vq[2];
}

/* Takes the larger of two principal stresses to the front. */
TL_IN_LOOP void tl_principal_order(double *a, double *b, double va[3], double vb[3])
{
    double p = *a, q = *b;
    int swap = p < q;
    *a = swap ? q : p;
    *b = swap ? p : q;
    double px = va[0], py = va[1], pz = va[2], qx = vb[0], qy = vb[1], qz = vb[2];
    va[0] = swap ? qx : px;
    va[1] = swap ? qy : py;
    va[2] = swap ? qz : pz;
    vb[0] = swap ? px : qx;
    vb[1] = swap ? py : qy;
    vb[2] = swap ? pz : qz;
}

/* Turns that leave off-diagonal components below a rounding of the largest one, as tests of random tensors show. */
TL_IN_LOOP tl_principal tl_principal_of(double xx, double yy, double zz, double xy, double yz, double zx)
{
    tl_principal p = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
#define TL_JACOBI_SWEEP()                                                                                              \
    (tl_jacobi_turn(&xx, &yy, &xy, &zx, &yz, p.v[0], p.v[1]), tl_jacobi_turn(&yy, &zz, &yz, &xy, &zx, p.v[1], p.v[2]), \
     tl_jacobi_turn(&xx, &zz, &zx, &xy, &yz, p.v[0], p.v[2]))
    TL_JACOBI_SWEEP();
    TL_JACOBI_SWEEP();
    TL_JACOBI_SWEEP();
    TL_JACOBI_SWEEP();
#undef TL_JACOBI_SWEEP
    tl_principal_order(&xx, &yy, p.v[0], p.v[1]);
    tl_principal_order(&yy, &zz, p.v[1], p.v[2]);
    tl_principal_order(&xx, &yy, p.v[0], p.v[1]);
    p.s[0] = xx;
    p.s[1] = yy;
    p.s[2] = zz;
    return p;
}

/* A component of the tensor with the principal values a, b and c along the directions of `p`. */
TL_IN_LOOP double tl_principal_part(const tl_principal *p, double a, double b, double c, int row, int column)
{
    return a * p->v[0][row] * p->v[0][column] + b * p->v[1][row] * p->v[1][column] + c * p->v[2][row] * p->v[2][column];
}

/* ---------------------------------------------------------------- tables ----------------- */

/* Values at `x` of a table of a parameter, in lanes: straight between its rows, and those of its ends beyond. */
TL_IN_LOOP void tl_table_at(tl_points table, const tl_lanes x, tl_lanes value)
{
    TL_EACH_LANE(i)
    value[i] = table.at[0].y;
    for (size_t k = 1; k < table.count; k++) {
        const double from = table.at[k - 1].x, low = table.at[k - 1].y, high = table.at[k].y;
        const double slope = (high - low) / (table.at[k].x - from), to = table.at[k].x;
        TL_EACH_ALONE
        TL_EACH_LANE(i)
        {
            double between = low + slope * (x[i] - from), beyond = x[i] < to ? between : high;
            value[i] = x[i] > from ? beyond : value[i];
        }
    }
}

/* Refuses a table with a value outside [least, most), or a first column below 0. */
static inline tl_status tl_table_check(const char *name, tl_points table, double least, double most, tl_report *report)
{
    for (size_t k = 0; k < table.count; k++) {
        if (!(table.at[k].x >= 0))
            return tl_refuse(report, "%s, row %zu: the plastic strain %g must not be negative", name, k + 1,
                             table.at[k].x);
        if (!(table.at[k].y >= least && table.at[k].y < most))
            return tl_refuse(report, "%s, row %zu: %g is outside [%g, %g)", name, k + 1, table.at[k].y, least, most);
    }
    return TL_OK;
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#endif
