/* jointset.c - generator "jointset": a set of nearly parallel planes, or discs, placed symmetrically about
 * a point, that cut the visible blocks.
 *
 * The planes are numbered from the lowest to the highest along the mean upward normal n. An odd number
 * has its middle plane through the origin, an even one its middle gap about it. Plane j passes through
 * origin + offset_j n, about which its disc lies, with its own attitude:
 *
 *     dip = mean + deviation u1,  dip direction = mean + deviation u2
 *     gap between two planes = spacing + spacing_dev u3
 *
 * u is uniform in [-1, 1), or normal with standard deviation 1 cut off at NORMAL_LIMIT; a normal gap is cut
 * off, on both sides alike, so that it stays positive. By "fisher" the pole of a plane is distributed
 * about the mean pole with the concentration fisher_k. Gaps go by `spacing_distribution`, with
 * u uniform in [0, 1) and z normal:
 *
 *     exponential: gap = -spacing ln(1 - u),   standard deviation: spacing
 *     lognormal:   gap = spacing exp(s z - s^2 / 2),   s^2 = ln(1 + (spacing_dev / spacing)^2)
 *
 * Normal: Box and Muller's transform of two uniform numbers, drawn again while it falls beyond the limit (at 3 standard
 * deviations that is one in 370). Fisher (Proc. R. Soc. Lond. A 217 (1953) 295-305): with density proportional to
 * exp(k cos t) on the sphere,
 *
 *     1 - cos t = -ln(1 - u (1 - exp(-2 k))) / k,   azimuth = 360 deg v,   u, v uniform in [0, 1).
 *
 * With `poles` each plane has the attitude of one that was measured. The mean pole is theirs (talus/poles.h).
 *
 * A gap belongs to the plane on its far side from the middle; the middle gap of an even set to the
 * plane above. Draws are keyed by model seed, set and plane number (Hart, Cundall and Lemos, Int. J.
 * Rock Mech. Min. Sci. 25 (1988) 117-125, section on model generation, for the six parameters). */
#include <talus/kit.h>
#include <talus/poles.h>
#include <talus/version.h>
#include <talus/vmath.h>

/* Normal deviations end here, in standard deviations, so that a rare draw cannot turn a plane over. */
#define NORMAL_LIMIT 3.0

/* After so many draws beyond the limit the number is taken as the mean: with limit >= 1 that has a chance of 1e-32. */
#define MOST_ATTEMPTS 64

/* Lognormal gaps end at so many standard deviations of their logarithm, which leaves mean and deviation within 1e-4 up
 * to a deviation of the mean. */
#define LOGNORMAL_LIMIT 6.0

/* The largest deviation of lognormal gaps over their mean. */
#define MOST_RATIO 10.0

enum { UNIFORM, NORMAL, FISHER };
static const char *const distributions[] = {"uniform", "normal", "fisher", NULL};

enum { GAPS_SAME, GAPS_UNIFORM, GAPS_NORMAL, GAPS_EXPONENTIAL, GAPS_LOGNORMAL };
static const char *const spacing_distributions[] = {"same", "uniform", "normal", "exponential", "lognormal", NULL};

typedef struct params {
    const char *joint;
    double dip, dip_dev, dip_direction, dip_direction_dev, spacing, spacing_dev;
    int64_t number;
    tl_vec3 origin;
    double persistence;
    int32_t distribution;
    double fisher_k, radius;
    int32_t spacing_distribution;
    const char *poles;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, joint, "", "name of the joint set", .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, params, dip, "deg", "mean dip below horizontal", .flags = TL_PARAM_OPTIONAL, .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_dev, "deg", "deviation of the dip: largest, or standard when normal", .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction, "deg", "mean dip direction, clockwise from north (+y)",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = 360),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction_dev, "deg", "deviation of the dip direction", .min = 0, .max = 180),
    TL_PARAM_POSITIVE(params, spacing, "m", "mean distance between planes"),
    TL_PARAM_NOT_NEGATIVE(params, spacing_dev, "m",
                          "deviation of the spacing; less than the spacing, unless lognormal"),
    TL_PARAM(TL_PARAM_INT, params, number, "", "number of planes", .def = {1}, .min = 1, .max = 1e4),
    TL_PARAM(TL_PARAM_VEC3, params, origin, "m", "point the planes lie symmetrically about", .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_REAL, params, persistence, "", "probability that a block in a plane's path is cut", .def = {1},
             .min = 0, .max = 1),
    TL_PARAM(TL_PARAM_ENUM, params, distribution, "",
             "of the deviations: uniform within them, normal with them as standard deviations, or "
             "fisher about the mean pole",
             .def = {UNIFORM}, .choices = distributions),
    TL_PARAM(TL_PARAM_REAL, params, fisher_k, "", "concentration of the poles by fisher",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .min = 0, .max = 1e9),
    TL_PARAM_POSITIVE_OR_NONE(params, radius, "m",
                              "of discs in the place of planes: a block is in a disc's path when the disc meets its "
                              "section"),
    TL_PARAM(TL_PARAM_ENUM, params, spacing_distribution, "",
             "of the gaps: uniform within spacing_dev, normal, exponential with the mean spacing, or lognormal; same: "
             "as distribution, uniform with fisher",
             .def = {GAPS_SAME}, .choices = spacing_distributions),
    TL_PARAM(TL_PARAM_STRING, params, poles, "",
             "table of measured planes with the columns dip and dip_direction, in the place of dip and dip_direction",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_FILE),
};

/* Where the draws of one call are found: planes of an earlier call of the same set come first. */
typedef struct draws {
    const tl_host *host;
    uint32_t joint, first;
    tl_poles poles; /* count 0: attitudes are drawn about the mean */
} draws;

/* The quantities a plane draws. */
enum { DRAW_DIP, DRAW_DIRECTION, DRAW_GAP, DRAW_KINDS };

static double draw_one(const draws *d, int64_t index, uint32_t draw)
{
    return d->host->random(d->host, d->joint, d->first + index, draw);
}

/* Uniform in [-1, 1) for plane `index` (from 0) of this call. */
static double draw_even(const draws *d, int64_t index, uint32_t kind)
{
    return 2 * draw_one(d, index, kind) - 1;
}

/* Normal with mean 0 and standard deviation 1, cut off at +-limit; limit >= 1. */
static double draw_normal(const draws *d, int64_t index, uint32_t kind, double limit)
{
    for (uint32_t attempt = 0; attempt < MOST_ATTEMPTS; attempt++) {
        uint32_t draw = kind + 2 * DRAW_KINDS * attempt;
        double u = draw_one(d, index, draw), v = draw_one(d, index, draw + DRAW_KINDS);
        /* 1 - u is in (0, 1], so the logarithm is finite */
        double z = sqrt(-2 * tl_log1p(-u)) * tl_cos_degrees(360 * v);
        if (fabs(z) < limit)
            return z;
    }
    return 0;
}

/* The pole of plane `index`: distributed after Fisher about the unit vector `mean`, concentration k > 0. */
static tl_vec3 draw_fisher(const draws *d, int64_t index, tl_vec3 mean, double k)
{
    double u = draw_one(d, index, DRAW_DIP), azimuth = 360 * draw_one(d, index, DRAW_DIRECTION);
    double drop = fmin(-tl_log1p(u * tl_expm1(-2 * k)) / k, 2);
    double sine = sqrt(drop * (2 - drop));
    tl_vec3 e = tl_v3_perpendicular(mean), f = tl_v3_cross(mean, e);
    tl_vec3 side = tl_v3_madd(tl_v3_scale(tl_cos_degrees(azimuth), e), tl_sin_degrees(azimuth), f);
    return tl_v3_unit(tl_v3_madd(tl_v3_scale(1 - drop, mean), sine, side));
}

/* Deviation of a plane's dip or dip direction, in units of the one given. */
static double deviation(const draws *d, const params *p, int64_t index, uint32_t kind)
{
    return p->distribution == NORMAL ? draw_normal(d, index, kind, NORMAL_LIMIT) : draw_even(d, index, kind);
}

static int32_t gaps_of(const params *p)
{
    if (p->spacing_distribution != GAPS_SAME)
        return p->spacing_distribution;
    return p->distribution == NORMAL ? GAPS_NORMAL : GAPS_UNIFORM;
}

/* What deviations of gaps are counted in, m. */
static double gap_unit(const params *p)
{
    return gaps_of(p) >= GAPS_EXPONENTIAL ? p->spacing : p->spacing_dev;
}

/* By how many units a gap is wider than the spacing. */
static double gap_deviation(const draws *d, const params *p, int64_t index)
{
    switch (gaps_of(p)) {
    case GAPS_NORMAL: return draw_normal(d, index, DRAW_GAP, fmin(NORMAL_LIMIT, p->spacing / p->spacing_dev));
    case GAPS_EXPONENTIAL: return -tl_log1p(-draw_one(d, index, DRAW_GAP)) - 1;
    case GAPS_LOGNORMAL: {
        const double ratio = p->spacing_dev / p->spacing, s2 = tl_log1p(ratio * ratio);
        return tl_expm1(sqrt(s2) * draw_normal(d, index, DRAW_GAP, LOGNORMAL_LIMIT) - 0.5 * s2);
    }
    default: return draw_even(d, index, DRAW_GAP);
    }
}

/* Distance of plane `index` from the origin along the mean normal. The mean part is a product, so a set
 * without deviation is placed without accumulated rounding. */
static double offset_of(const draws *d, const params *p, int64_t index)
{
    int64_t n = p->number, middle = n / 2;
    double mean = ((double)index - 0.5 * (double)(n - 1)) * p->spacing;
    const double unit = gap_unit(p);
    if (!(unit > 0))
        return mean;
    double sum = n % 2 == 0 ? 0.5 * gap_deviation(d, p, middle) : 0;
    int64_t low = n % 2 == 0 ? middle - 1 : middle;
    for (int64_t i = middle + 1; i <= index; i++)
        sum += gap_deviation(d, p, i);
    for (int64_t i = low - 1; i >= index; i--)
        sum += gap_deviation(d, p, i);
    return index >= middle ? mean + unit * sum : mean - unit * sum;
}

static tl_vec3 normal_of(const draws *d, const params *p, tl_vec3 mean, int64_t index)
{
    if (d->poles.count > 0)
        return tl_poles_pick(&d->poles, draw_one(d, index, DRAW_DIP));
    if (p->distribution == FISHER)
        return draw_fisher(d, index, mean, p->fisher_k);
    double dip = p->dip + p->dip_dev * deviation(d, p, index, DRAW_DIP);
    double direction = p->dip_direction + p->dip_direction_dev * deviation(d, p, index, DRAW_DIRECTION);
    return tl_plane_normal(dip, direction);
}

static tl_status cut_plane(const draws *d, const params *p, tl_vec3 mean, int64_t index, size_t *met)
{
    tl_tag tag = {d->joint, d->first + (uint32_t)index};
    tl_vec3 point = tl_v3_madd(p->origin, offset_of(d, p, index), mean);
    double radius = p->radius > 0 ? p->radius : INFINITY;
    size_t blocks = 0;
    tl_status status =
        d->host->cut_disc(d->host, normal_of(d, p, mean, index), point, radius, tag, p->persistence, &blocks);
    *met += blocks;
    return status;
}

static tl_status check_gaps(const tl_host *host, const params *p)
{
    const int32_t gaps = gaps_of(p);
    if (gaps == GAPS_EXPONENTIAL && p->spacing_dev > 0)
        return host->fail(
            host, TL_E_ARGUMENT,
            "spacing_dev = %g m does not go with spacing_distribution = 'exponential', whose deviation is "
            "the spacing: leave it out",
            p->spacing_dev);
    if (gaps == GAPS_LOGNORMAL && !(p->spacing_dev > 0 && p->spacing_dev <= MOST_RATIO * p->spacing))
        return host->fail(host, TL_E_ARGUMENT,
                          "spacing_distribution = 'lognormal' needs spacing_dev, the standard deviation of the gaps, "
                          "> 0 and <= %g times spacing = %g m: it is %g m",
                          MOST_RATIO, p->spacing, p->spacing_dev);
    if (gaps <= GAPS_NORMAL && !(p->spacing_dev < p->spacing))
        return host->fail(host, TL_E_ARGUMENT, "spacing_dev = %g m must be < spacing = %g m", p->spacing_dev,
                          p->spacing);
    return TL_OK;
}

static tl_status check_attitudes(const tl_host *host, const params *p)
{
    if (!p->poles && (isnan(p->dip) || isnan(p->dip_direction)))
        return host->fail(host, TL_E_ARGUMENT, "'%s' is missing: give dip and dip_direction, or poles",
                          isnan(p->dip) ? "dip" : "dip_direction");
    const char *const surplus = !isnan(p->dip)              ? "dip"
                                : !isnan(p->dip_direction)  ? "dip_direction"
                                : p->dip_dev > 0            ? "dip_dev"
                                : p->dip_direction_dev > 0  ? "dip_direction_dev"
                                : p->distribution == FISHER ? "distribution"
                                                            : NULL;
    if (p->poles && surplus)
        return host->fail(host, TL_E_ARGUMENT, "%s does not go with poles, which give the attitudes: leave it out",
                          surplus);
    return TL_OK;
}

/* What the ranges of single parameters cannot tell. */
static tl_status check(const tl_host *host, const params *p)
{
    tl_status status = check_attitudes(host, p);
    if (status == TL_OK)
        status = check_gaps(host, p);
    if (status != TL_OK)
        return status;
    if (p->distribution == FISHER && !(p->fisher_k > 0))
        return host->fail(host, TL_E_ARGUMENT,
                          "distribution = 'fisher' needs fisher_k, the concentration of the poles "
                          "(> 0; a large one means little scatter)");
    if (p->distribution == FISHER && (p->dip_dev > 0 || p->dip_direction_dev > 0))
        return host->fail(host, TL_E_ARGUMENT,
                          "%s = %g deg does not go with distribution = 'fisher', whose scatter is "
                          "fisher_k: leave it out",
                          p->dip_dev > 0 ? "dip_dev" : "dip_direction_dev",
                          p->dip_dev > 0 ? p->dip_dev : p->dip_direction_dev);
    if (p->distribution != FISHER && p->fisher_k > 0)
        return host->fail(host, TL_E_ARGUMENT, "fisher_k = %g goes with distribution = 'fisher' only", p->fisher_k);
    return TL_OK;
}

static tl_status cut_planes(draws *d, const params *p)
{
    const tl_host *host = d->host;
    tl_status status = TL_OK;
    d->first = host->next_plane(host, d->joint);
    for (int64_t i = 1; i < p->number; i++)
        host->next_plane(host, d->joint);
    const tl_vec3 mean = d->poles.count > 0 ? tl_poles_mean_of(d->poles.normal, d->poles.weight, d->poles.count).mean
                                            : tl_plane_normal(p->dip, p->dip_direction);
    size_t met = 0;
    for (int64_t i = 0; i < p->number && status == TL_OK; i++) {
        status = cut_plane(d, p, mean, i, &met);
        if (status == TL_OK)
            status = host->progress(host, (double)(i + 1) / (double)p->number);
    }
    if (status == TL_OK && met == 0)
        host->log(host, "joint set '%s': none of its %lld plane%s meets a visible block", p->joint,
                  (long long)p->number, p->number == 1 ? "" : "s");
    return status;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    draws d = {.host = host};
    tl_status status = check(host, p);
    if (status == TL_OK && p->poles)
        status = tl_poles_read(host, p->poles, &d.poles);
    if (status == TL_OK)
        status = host->joint(host, p->joint, &d.joint);
    if (status == TL_OK)
        status = cut_planes(&d, p);
    tl_poles_free(&d.poles);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(generate, .name = "jointset",
                                              .doc = "Cuts the visible blocks by a set of nearly parallel planes.",
                                              TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.jointset", .version = TALUS_VERSION, .doc = "Joint set generator.",
          .licence = "BSD-3-Clause");
