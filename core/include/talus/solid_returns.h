/* solid_returns.h - Mohr-Coulomb with a tension cut-off: strength, tables and the exact return, for solids that
 * yield so.
 *
 *     f = (1 + sin phi) s1 - (1 - sin phi) s3 - 2 c cos phi <= 0,  s1 <= T
 *     g = (1 + sin psi) s1 - (1 - sin psi) s3
 *
 * with principal stresses s1 >= s2 >= s3, positive in tension. f and g are a plane and its flow for each pair of
 * principal stresses. The return is implicit: the stress after the step is on the surface. The plastic strain is a
 * sum of flows, none of them backward, of the planes it lies on (Koiter 1953; Clausen, Damkilde and Andersen 2006).
 * With psi = phi it is the closest point in the elastic energy. */
#ifndef TALUS_SOLID_RETURNS_H
#define TALUS_SOLID_RETURNS_H

#include <talus/solid_kit.h>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunknown-pragmas"
#endif

/* Tolerance: by how much a stress may be beyond the surface and count as on it, relative to the stresses. Returns end
 * within a hundredth of it, so that a zone at rest on the surface does not yield by a rounding in every step. */
#define TL_YIELD_ROUNDING 1e-13

/* ---------------------------------------------------------------- in principal stresses --- */

/* What a zone withstands in this step. */
typedef struct tl_mohr_coulomb {
    double friction; /* sin phi */
    double dilation; /* sin psi */
    double cohesion; /* 2 c cos phi, Pa */
    double tension;  /* Pa, at most that of the apex */
} tl_mohr_coulomb;

/* Principal stresses after a step, and what yields: TL_ZONE_SHEAR and TL_ZONE_TENSION, or 0. */
typedef struct tl_returned {
    double a, b, c, mark;
} tl_returned;

/* Onto the planes of shear alone: the plane of s1 and s3, or an edge of it where two of them come out equal. */
TL_IN_LOOP tl_returned tl_return_shear(const tl_isotropic *elastic, const tl_mohr_coulomb *y, double s1, double s2,
                                       double s3)
{
    const double f = y->friction, d = y->dilation, shear = elastic->shear;
    const double volume = 2 * elastic->lame * d; /* stress that the flow's volume takes off all three */
    const double r1 = volume + 2 * shear * (1 + d), r3 = volume - 2 * shear * (1 - d);
    double over = (1 + f) * s1 - (1 - f) * s3 - y->cohesion;
    double flow = over / (2 * f * volume + 4 * shear * (1 + f * d));
    double a = s1 - flow * r1, b = s2 - flow * volume, c = s3 - flow * r3;
    /* s1 = s2: two planes share the flow */
    double mean = 0.5 * (s1 + s2), r = volume + shear * (1 + d);
    double edge = ((1 + f) * mean - (1 - f) * s3 - y->cohesion) / ((1 + f) * r - (1 - f) * r3);
    double a_edge = mean - edge * r, c_edge = s3 - edge * r3;
    int upper = a < b, lower = b < c;
    /* s2 = s3 */
    mean = 0.5 * (s2 + s3);
    r = volume - shear * (1 - d);
    edge = ((1 + f) * s1 - (1 - f) * mean - y->cohesion) / ((1 + f) * r1 - (1 - f) * r);
    double a_low = s1 - edge * r1, c_low = mean - edge * r;
    tl_returned to;
    to.a = upper ? a_edge : lower ? a_low : a;
    to.b = upper ? a_edge : lower ? c_low : b;
    to.c = upper ? c_edge : lower ? c_low : c;
    to.mark = TL_ZONE_SHEAR;
    return to;
}

/* Onto the planes of tension alone: one, two or three principal stresses are the strength. */
TL_IN_LOOP tl_returned tl_return_tension(const tl_isotropic *elastic, double tension, double s1, double s2, double s3)
{
    const double lame = elastic->lame, constrained = elastic->constrained;
    double over = (s1 - tension) / constrained;
    double b = s2 - lame * over, c = s3 - lame * over;
    double c_two = s3 - lame * (s1 + s2 - 2 * tension) / (constrained + lame);
    int two = b > tension, three = two & (c_two > tension);
    tl_returned to;
    to.a = tension;
    to.b = two ? tension : b;
    to.c = three ? tension : two ? c_two : c;
    to.mark = TL_ZONE_TENSION;
    return to;
}

/* Onto the line on which both are met, s1 = tension and s3 = low, or one of its ends. `dilation`: sin psi there. */
TL_IN_LOOP tl_returned tl_return_both(const tl_isotropic *elastic, double dilation, double tension, double low,
                                      double s1, double s2, double s3)
{
    const double d = dilation, lame = elastic->lame, shear = elastic->shear, volume = 2 * lame * d;
    double over = s1 - tension, under = s3 - low;
    double shears = (over * lame - under * elastic->constrained) / (4 * shear * (1 - d) * (lame + shear));
    double tears = (over - shears * (volume + 2 * shear * (1 + d))) / elastic->constrained;
    double b = s2 - shears * volume - tears * lame;
    b = b > tension ? tension : b;
    tl_returned to;
    to.a = tension;
    to.b = b < low ? low : b;
    to.c = low;
    to.mark = TL_ZONE_SHEAR | TL_ZONE_TENSION;
    return to;
}

/* The return of a stress. One way of yielding is right where the other is not needed; where both are, both are met. */
TL_IN_LOOP tl_returned tl_mohr_coulomb_return(const tl_isotropic *elastic, const tl_mohr_coulomb *y, double s1,
                                              double s2, double s3)
{
    const double f = y->friction, tension = y->tension;
    double scale = TL_YIELD_ROUNDING * (y->cohesion + fabs(s1) + fabs(s3));
    int shears = (1 + f) * s1 - (1 - f) * s3 - y->cohesion > scale, tears = s1 - tension > scale;
    tl_returned by_shear = tl_return_shear(elastic, y, s1, s2, s3);
    tl_returned by_tension = tl_return_tension(elastic, tension, s1, s2, s3);
    double low = ((1 + f) * tension - y->cohesion) / (1 - f);
    low = low < tension ? low : tension;
    tl_returned by_both = tl_return_both(elastic, y->dilation, tension, low, s1, s2, s3);
    double largest = by_shear.a > by_shear.c ? by_shear.a : by_shear.c;
    int shear_alone = shears & (largest <= tension);
    int tension_alone = tears & ((1 + f) * by_tension.a - (1 - f) * by_tension.c <= y->cohesion);
    tl_returned to;
    to.a = shear_alone ? by_shear.a : tension_alone ? by_tension.a : by_both.a;
    to.b = shear_alone ? by_shear.b : tension_alone ? by_tension.b : by_both.b;
    to.c = shear_alone ? by_shear.c : tension_alone ? by_tension.c : by_both.c;
    to.mark = shear_alone ? by_shear.mark : tension_alone ? by_tension.mark : by_both.mark;
    int yields = shears | tears;
    to.a = yields ? to.a : s1;
    to.b = yields ? to.b : s2;
    to.c = yields ? to.c : s3;
    to.mark = yields ? to.mark : 0;
    return to;
}

/* ---------------------------------------------------------------- parameters ------------- */

/* Parameters of a rock that yields so. Put it first into the struct of parameters of a solid, so that the rows of
 * TL_PARAMS_MOHR_COULOMB fit. */
typedef struct tl_mohr_coulomb_params {
    double young, poisson, bulk, shear;
    double cohesion, friction, dilation, tension;
    tl_points cohesion_table, friction_table, dilation_table, tension_table;
    double table_extent;
} tl_mohr_coulomb_params;

/* `strength`: what a factor of safety does to the second numbers of its rows. */
#define TL_PARAM_TABLE(owner, member, unit, strength, ...)                                                             \
    TL_PARAM(TL_PARAM_POINTS, owner, member, unit, __VA_ARGS__, .flags = TL_PARAM_OPTIONAL | TL_PARAM_FLAT | (strength))

#define TL_PARAMS_MOHR_COULOMB                                                                                         \
    TL_PARAMS_ELASTIC(tl_mohr_coulomb_params),                                                                         \
        TL_PARAM(TL_PARAM_REAL, tl_mohr_coulomb_params, cohesion, "Pa", "cohesion, where no table gives it",           \
                 .flags = TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),                           \
        TL_PARAM_ANGLE(tl_mohr_coulomb_params, friction, TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH_ANGLE,                  \
                       "angle of friction, where no table gives it"),                                                  \
        TL_PARAM_ANGLE(tl_mohr_coulomb_params, dilation, TL_PARAM_STRENGTH_ANGLE,                                      \
                       "angle of dilation, at most that of friction"),                                                 \
        TL_PARAM(TL_PARAM_REAL, tl_mohr_coulomb_params, tension, "Pa",                                                 \
                 "tensile strength; no more than cohesion / tan(friction), which it is when left out",                 \
                 .flags = TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),                           \
        TL_PARAM_TABLE(tl_mohr_coulomb_params, cohesion_table, "Pa", TL_PARAM_STRENGTH,                                \
                       "cohesion over plastic shear: rows {plastic shear, cohesion}, straight between them"),          \
        TL_PARAM_TABLE(tl_mohr_coulomb_params, friction_table, "deg", TL_PARAM_STRENGTH_ANGLE,                         \
                       "friction over plastic shear"),                                                                 \
        TL_PARAM_TABLE(tl_mohr_coulomb_params, dilation_table, "deg", TL_PARAM_STRENGTH_ANGLE,                         \
                       "dilation over plastic shear"),                                                                 \
        TL_PARAM_TABLE(tl_mohr_coulomb_params, tension_table, "Pa", TL_PARAM_STRENGTH,                                 \
                       "tensile strength over plastic tension"),                                                       \
        TL_PARAM_POSITIVE_OR_NONE(tl_mohr_coulomb_params, table_extent, "m",                                           \
                                  "extent of zones that the tables are for: in zones twice as large plastic strain "   \
                                  "counts twice, so that a crack takes the same energy; left out: tables hold for "    \
                                  "zones of any size")

/* States: the measures over which tables go. */
#define TL_STATES_MOHR_COULOMB                                                                                         \
    TL_STATE(TL_STATE_SCALAR, "plastic_shear", "",                                                                     \
             "sum of sqrt(sum of squares / 2) of the principal deviatoric plastic strains of the steps"),              \
        TL_STATE(TL_STATE_SCALAR, "plastic_tension", "",                                                               \
                 "sum of the largest principal plastic strains of steps at the tensile strength")
enum { TL_AT_PLASTIC_SHEAR, TL_AT_PLASTIC_TENSION, TL_MOHR_COULOMB_STATES };

/* Such a rock, as its solid keeps it. */
typedef struct tl_rock {
    tl_isotropic elastic;
    tl_mohr_coulomb peak; /* without tables */
    double per_extent;    /* 1/m: by what an extent is multiplied; 0: 1 stands in its place */
    int tables;           /* whether there are any */
    tl_mohr_coulomb_params given;
} tl_rock;

/* The tensile strength, at most that of the apex. `cohesion`: 2 c cos phi; NaN: nothing given. */
TL_IN_LOOP double tl_tension_within(double tension, double cohesion, double friction)
{
    double apex = friction > 0 ? cohesion / (2 * (friction > 0 ? friction : 1)) : INFINITY;
    return tension < apex ? tension : apex;
}

/* From the angles, deg, and strengths, Pa. A dilation above the friction counts as that. */
static inline tl_mohr_coulomb tl_mohr_coulomb_of(double cohesion, double friction, double dilation, double tension)
{
    double sine = tl_sin_degrees(friction), flow = tl_sin_degrees(dilation);
    tl_mohr_coulomb y;
    y.friction = sine;
    y.dilation = flow < sine ? flow : sine;
    y.cohesion = 2 * cohesion * tl_cos_degrees(friction);
    y.tension = tl_tension_within(tension, y.cohesion, sine);
    return y;
}

static inline tl_status tl_rock_of(const tl_mohr_coulomb_params *p, tl_rock *out, tl_report *report)
{
    memset(out, 0, sizeof *out);
    out->given = *p;
    tl_status status = tl_isotropic_of(p->young, p->poisson, p->bulk, p->shear, &out->elastic, report);
    if (status == TL_OK && isnan(p->cohesion) && p->cohesion_table.count == 0)
        status = tl_refuse(report, "give cohesion or cohesion_table");
    if (status == TL_OK && isnan(p->friction) && p->friction_table.count == 0)
        status = tl_refuse(report, "give friction or friction_table");
    if (status == TL_OK)
        status = tl_table_check("cohesion_table", p->cohesion_table, 0, INFINITY, report);
    if (status == TL_OK)
        status = tl_table_check("friction_table", p->friction_table, 0, 90, report);
    if (status == TL_OK)
        status = tl_table_check("dilation_table", p->dilation_table, 0, 90, report);
    if (status == TL_OK)
        status = tl_table_check("tension_table", p->tension_table, 0, INFINITY, report);
    out->tables =
        p->cohesion_table.count + p->friction_table.count + p->dilation_table.count + p->tension_table.count > 0;
    out->per_extent = isnan(p->table_extent) ? 0 : 1 / p->table_extent;
    if (status == TL_OK && !out->tables)
        out->peak = tl_mohr_coulomb_of(p->cohesion, p->friction, p->dilation, p->tension);
    return status;
}

/* ---------------------------------------------------------------- a group ---------------- */

/* Strengths of the zones of a group. */
typedef struct tl_strength_lanes {
    tl_lanes friction, dilation, cohesion, tension;
} tl_strength_lanes;

TL_IN_LOOP void tl_table_or(tl_points table, double otherwise, const tl_lanes x, tl_lanes value)
{
    if (table.count > 0)
        tl_table_at(table, x, value);
    else
        TL_EACH_LANE(i)
    value[i] = otherwise;
}

/* Of tables, by the plastic strains at the beginning of the step. */
TL_IN_LOOP void tl_strength_of_tables(const tl_rock *rock, const tl_lanes plastic_shear, const tl_lanes plastic_tension,
                                      tl_strength_lanes *y)
{
    const tl_mohr_coulomb_params *p = &rock->given;
    tl_table_or(p->cohesion_table, p->cohesion, plastic_shear, y->cohesion);
    tl_table_or(p->friction_table, p->friction, plastic_shear, y->friction);
    tl_table_or(p->dilation_table, p->dilation, plastic_shear, y->dilation);
    tl_table_or(p->tension_table, p->tension, plastic_tension, y->tension);
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double tangent = tl_lane_tan(y->friction[i] * TL_DEGREE), flow = tl_lane_tan(y->dilation[i] * TL_DEGREE);
        flow = flow < tangent ? flow : tangent;
        double cosine = 1 / sqrt(1 + tangent * tangent);
        y->friction[i] = tangent * cosine;
        y->dilation[i] = flow / sqrt(1 + flow * flow);
        y->cohesion[i] = 2 * y->cohesion[i] * cosine;
        y->tension[i] = tl_tension_within(y->tension[i], y->cohesion[i], y->friction[i]);
    }
}

TL_IN_LOOP void tl_strength_at(const tl_rock *rock, const tl_solid_batch *batch, uint32_t begin, tl_strength_lanes *y)
{
    if (rock->tables) {
        tl_strength_of_tables(rock, batch->state[TL_AT_PLASTIC_SHEAR] + begin,
                              batch->state[TL_AT_PLASTIC_TENSION] + begin, y);
        return;
    }
    TL_EACH_LANE(i)
    {
        y->friction[i] = rock->peak.friction;
        y->dilation[i] = rock->peak.dilation;
        y->cohesion[i] = rock->peak.cohesion;
        y->tension[i] = rock->peak.tension;
    }
}

/* Whether a zone may yield, 1 or 0, by a bound of f and s1 in the mean stress p and J2: the deviator of (1 + sin phi,
 * 0, sin phi - 1) has the length sqrt(2 + 2 sin^2 phi / 3), and s1 <= p + sqrt(4 J2 / 3). Gives whether any may. */
TL_IN_LOOP int tl_may_yield(const tl_lanes6 s, const tl_strength_lanes *y, tl_lanes may)
{
    double any = 0;
    TL_EACH_LANE(i)
    {
        double p = (s[0][i] + s[1][i] + s[2][i]) / 3, xx = s[0][i] - p, yy = s[1][i] - p, zz = s[2][i] - p;
        double shear = s[3][i] * s[3][i] + s[4][i] * s[4][i] + s[5][i] * s[5][i];
        double twice = xx * xx + yy * yy + zz * zz + 2 * shear, f = y->friction[i]; /* 2 J2 */
        double most = 2 * f * p + sqrt(twice * (2 + 2. / 3 * f * f));
        double highest = p + sqrt(2. / 3 * twice);
        int stays = (most <= y->cohesion[i]) & (highest <= y->tension[i]);
        may[i] = stays ? 0 : 1;
        any += may[i];
    }
    return any > 0;
}

/* The stresses of a group brought back to the surface. What has been taken off the principal stresses is the plastic
 * strain of the step: its measures `shear` and `tension` are added up. */
TL_IN_LOOP void tl_group_return(const tl_isotropic *elastic, const tl_strength_lanes *y, const tl_lanes may,
                                const tl_lanes6 s, tl_lanes6 after, tl_lanes shear, tl_lanes tension, tl_lanes mark)
{
    const double by_shear = 0.5 / elastic->shear, by_bulk = 1 / (3 * elastic->bulk);
    /* without TL_EACH_ALONE, which would have the compiler keep the directions of all lanes in memory */
    TL_EACH_LANE(i)
    {
        tl_principal p = tl_principal_of(s[0][i], s[1][i], s[2][i], s[3][i], s[4][i], s[5][i]);
        const tl_mohr_coulomb strength = {y->friction[i], y->dilation[i], y->cohesion[i], y->tension[i]};
        tl_returned to = tl_mohr_coulomb_return(elastic, &strength, p.s[0], p.s[1], p.s[2]);
        double marked = may[i] > 0 ? to.mark : 0;
        double a = p.s[0] - to.a, b = p.s[1] - to.b, c = p.s[2] - to.c;
        a = marked > 0 ? a : 0;
        b = marked > 0 ? b : 0;
        c = marked > 0 ? c : 0;
        double mean = (a + b + c) / 3;
        double squares = (a - mean) * (a - mean) + (b - mean) * (b - mean) + (c - mean) * (c - mean);
        double torn = (a - mean) * by_shear + mean * by_bulk;
        shear[i] = sqrt(0.5 * squares) * by_shear;
        torn = torn > 0 ? torn : 0;
        tension[i] = marked >= (double)TL_ZONE_TENSION ? torn : 0;
        mark[i] = marked;
        after[0][i] = s[0][i] - tl_principal_part(&p, a, b, c, 0, 0);
        after[1][i] = s[1][i] - tl_principal_part(&p, a, b, c, 1, 1);
        after[2][i] = s[2][i] - tl_principal_part(&p, a, b, c, 2, 2);
        after[3][i] = s[3][i] - tl_principal_part(&p, a, b, c, 0, 1);
        after[4][i] = s[4][i] - tl_principal_part(&p, a, b, c, 1, 2);
        after[5][i] = s[5][i] - tl_principal_part(&p, a, b, c, 2, 0);
    }
}

/* Adds the measures of a step to the states. */
TL_IN_LOOP void tl_rock_wear(const tl_rock *rock, const tl_solid_batch *batch, uint32_t begin, const tl_lanes shear,
                             const tl_lanes tension)
{
    double *plastic_shear = batch->state[TL_AT_PLASTIC_SHEAR] + begin;
    double *plastic_tension = batch->state[TL_AT_PLASTIC_TENSION] + begin;
    TL_EACH_LANE(i)
    {
        double by = rock->per_extent > 0 ? batch->extent[begin + i] * rock->per_extent : 1;
        plastic_shear[i] += shear[i] * by;
        plastic_tension[i] += tension[i] * by;
    }
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#endif
