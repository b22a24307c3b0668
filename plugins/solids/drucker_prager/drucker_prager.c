/* drucker_prager.c - solid "drucker_prager": elastic to a cone about the mean stress, with a tension cut-off.
 *
 *     f = sqrt(J2) + q p - k <= 0,  p <= T,  g = sqrt(J2) + q_psi p,  p the mean stress, positive in tension
 *     q = 6 sin phi / (sqrt 3 (3 - sin phi)),  k = 6 c cos phi / (sqrt 3 (3 - sin phi))    meridian "outer"
 *
 * "outer" has the strength of Mohr-Coulomb in compression along one axis; "inner", with 3 + sin phi, that in extension.
 * The return is exact: along the flow to the cone, along the mean stress to the cut-off, or to the circle in which they
 * meet. */
#include <talus/solid_returns.h>
#include <talus/version.h>

enum { OUTER, INNER };

typedef struct params {
    double young, poisson, bulk, shear;
    double cohesion, friction, dilation, tension;
    int32_t meridian;
} params;

static const char *const meridians[] = {"outer", "inner", NULL};

static const tl_param param_table[] = {
    TL_PARAMS_ELASTIC(params),
    TL_PARAM(TL_PARAM_REAL, params, cohesion, "Pa", "cohesion", .flags = TL_PARAM_REQUIRED | TL_PARAM_STRENGTH,
             .min = 0, .max = INFINITY),
    TL_PARAM_ANGLE(params, friction, TL_PARAM_REQUIRED | TL_PARAM_STRENGTH_ANGLE, "angle of friction"),
    TL_PARAM_ANGLE(params, dilation, TL_PARAM_STRENGTH_ANGLE, "angle of dilation, at most that of friction"),
    TL_PARAM(TL_PARAM_REAL, params, tension, "Pa",
             "largest mean stress; no more than that of the apex, which it is when left out",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_ENUM, params, meridian, "",
             "where cone and Mohr-Coulomb meet: in compression (outer) or extension (inner)", .choices = meridians),
};

typedef struct cone {
    tl_isotropic elastic;
    double slope, flow;       /* q, q_psi */
    double cohesion, tension; /* k, T, Pa */
} cone;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    cone c;
    tl_status status = tl_isotropic_of(p->young, p->poisson, p->bulk, p->shear, &c.elastic, report);
    if (status != TL_OK)
        return status;
    const double side = p->meridian == OUTER ? -1 : 1, root = sqrt(3);
    const double sine = tl_sin_degrees(p->friction), flow = tl_sin_degrees(fmin(p->dilation, p->friction));
    c.slope = 6 * sine / (root * (3 + side * sine));
    c.flow = 6 * flow / (root * (3 + side * flow));
    c.cohesion = 6 * p->cohesion * tl_cos_degrees(p->friction) / (root * (3 + side * sine));
    double apex = c.slope > 0 ? c.cohesion / c.slope : INFINITY;
    c.tension = p->tension < apex ? p->tension : apex;
    return tl_keep(&c, sizeof c, self, report);
}

/* The stresses of a group brought back. */
TL_IN_LOOP void bring_back(const cone *c, const tl_lanes6 s, tl_lanes6 after, tl_lanes mark)
{
    const double slope = c->slope, cohesion = c->cohesion, tension = c->tension, flow = c->flow;
    const double bulk = c->elastic.bulk, shear = c->elastic.shear, both = shear + bulk * slope * flow;
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double p = (s[0][i] + s[1][i] + s[2][i]) / 3, xx = s[0][i] - p, yy = s[1][i] - p, zz = s[2][i] - p;
        double squares = s[3][i] * s[3][i] + s[4][i] * s[4][i] + s[5][i] * s[5][i];
        double size = sqrt(0.5 * (xx * xx + yy * yy + zz * zz) + squares);
        double over = size + slope * p - cohesion, rounding = TL_YIELD_ROUNDING * (size + fabs(p) + cohesion);
        int shears = over > rounding, tears = p - tension > rounding;
        double length = over / both, at = p - bulk * flow * length;
        int shear_alone = shears & (at <= tension), tension_alone = tears & (size + slope * tension <= cohesion);
        double to = shear_alone ? size - shear * length : tension_alone ? size : cohesion - slope * tension;
        double mean = shear_alone ? at : tension;
        int yields = shears | tears;
        /* the cone's radius at the apex may be a rounding below 0 */
        double kept = yields ? (to > 0 ? to : 0) / (size > 0 ? size : 1) : 1, off = yields ? p - mean : 0;
        double marked = shear_alone ? TL_ZONE_SHEAR : tension_alone ? TL_ZONE_TENSION : TL_ZONE_SHEAR | TL_ZONE_TENSION;
        mark[i] = yields ? marked : 0;
        double lost = 1 - kept;
        after[0][i] = s[0][i] - (lost * xx + off);
        after[1][i] = s[1][i] - (lost * yy + off);
        after[2][i] = s[2][i] - (lost * zz + off);
        after[3][i] = s[3][i] - lost * s[3][i];
        after[4][i] = s[4][i] - lost * s[4][i];
        after[5][i] = s[5][i] - lost * s[5][i];
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const cone *c = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LANES) {
        tl_lanes6 trial, after;
        tl_lanes mark;
        tl_solid_trial(batch, begin, &c->elastic, trial);
        bring_back(c, (const tl_lanes *)trial, after, mark);
        tl_isotropic_put(batch, begin, &c->elastic, (const tl_lanes *)trial, (const tl_lanes *)after, mark);
    }
    return TL_OK;
}

TL_VECTORIZED static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                                 double *stored)
{
    (void)state;
    tl_isotropic_energies(&((const cone *)self)->elastic, count, stress, stored);
}

TL_SOLID_MODULI(cone);

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind =
    TL_KIND(TL_KIND_SOLID, ops, .name = "drucker_prager",
            .doc = "Drucker-Prager's cone with a cut-off of the mean stress.", TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.solid_drucker_prager", .version = TALUS_VERSION,
                .doc = "Solid that yields by Drucker and Prager.", .licence = "BSD-3-Clause");
