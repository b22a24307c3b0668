/* talus/distributions.h - distributions of joints and strengths: values for a number u that is uniform in (0, 1).
 *
 * Every value is the quantile of its distribution at u. So evenly spread u give evenly spread values (Latin hypercube),
 * and a range cuts a distribution off without a draw that is thrown away:
 *
 *     x = Q(F(min) + u (F(max) - F(min)))
 *
 * The same bits everywhere: only functions of talus/elementary.h. */
#ifndef TALUS_DISTRIBUTIONS_H
#define TALUS_DISTRIBUTIONS_H

#include <stdbool.h>
#include <talus/elementary.h>
#include <talus/types.h>
#include <talus/vmath.h>

/* Limit: the least probability of a range that may cut off a distribution: one draw in a thousand falls into it. */
#define TL_LEAST_SHARE 1e-3
/* Constant: terms of the continued fraction of the normal tail beyond 3 standard deviations; 60 give all digits. */
#define TL_TAIL_TERMS 80

/* ---------------------------------------------------------------- normal ----------------- */

/* 1 / sqrt(2 pi) exp(-x^2 / 2) */
static inline double tl_normal_density(double x)
{
    return 0.3989422804014327 * tl_lane_exp(-0.5 * x * x);
}

/* The probability that a normal number of mean 0 and deviation 1 is below x, within 1e-13 of itself and of 1 less it.
 * Up to 3 it is 1/2 + density (x + x^3 / 3 + x^5 / (3 5) + ...), beyond that Laplace's continued fraction. */
static inline double tl_normal_below(double x)
{
    const double size = fabs(x);
    if (!(size < 37))
        return x > 0 ? 1 : x < 0 ? 0 : x;
    if (size < 3) {
        double term = x, sum = x;
        for (int k = 3; k < 200 && fabs(term) > 1e-18 * fabs(sum); k += 2) {
            term *= x * x / k;
            sum += term;
        }
        return 0.5 + tl_normal_density(x) * sum;
    }
    double rest = size;
    for (int k = TL_TAIL_TERMS; k > 0; k--)
        rest = size + k / rest;
    const double tail = tl_normal_density(x) / rest;
    return x < 0 ? tail : 1 - tail;
}

/* The x with tl_normal_below(x) = u, 0 < u < 1. It begins with formula 26.2.23 of Abramowitz and Stegun, whose error is
 * 4.5e-4, and makes three steps of Halley's method. */
static inline double tl_normal_quantile(double u)
{
    const double tail = fmin(u, 1 - u);
    if (!(tail > 0))
        return u <= 0 ? -INFINITY : u >= 1 ? INFINITY : u;
    const double t = sqrt(-2 * tl_lane_log(tail));
    double x = (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
    for (int i = 0; i < 3; i++) {
        const double off = (tl_normal_below(x) - tail) / tl_normal_density(x);
        x -= off / (1 + 0.5 * x * off);
    }
    return u < 0.5 ? x : -x;
}

/* u within a range whose ends have the probabilities `low` and `high`. */
static inline double tl_within(double u, double low, double high)
{
    return low + u * (high - low);
}

/* ---------------------------------------------------------------- lognormal -------------- */

/* The logarithm of a lognormal number is normal, with this mean and deviation. */
typedef struct tl_lognormal {
    double mean, dev;
} tl_lognormal;

/* Of the number's own mean > 0 and standard deviation >= 0: s^2 = ln(1 + (dev / mean)^2), ln(mean) - s^2 / 2. */
static inline tl_lognormal tl_lognormal_of(double mean, double dev)
{
    const double ratio = dev / mean, s2 = tl_log1p(ratio * ratio);
    return (tl_lognormal){tl_lane_log(mean) - 0.5 * s2, sqrt(s2)};
}

/* The probability of a value below x. */
static inline double tl_lognormal_below(tl_lognormal d, double x)
{
    return x > 0 ? tl_normal_below((tl_lane_log(fmin(x, 1e300)) - d.mean) / d.dev) : 0;
}

static inline double tl_lognormal_quantile(tl_lognormal d, double u)
{
    return tl_lane_exp(d.mean + d.dev * tl_normal_quantile(u));
}

/* The mean of x^k, k >= 0, of the numbers between min >= 0 and max, which hold a share > 0 of all. */
static inline double tl_lognormal_moment(tl_lognormal d, double min, double max, double k)
{
    const tl_lognormal weighted = {d.mean + k * d.dev * d.dev, d.dev};
    const double all = tl_lane_exp(k * d.mean + 0.5 * k * k * d.dev * d.dev);
    if (!(d.dev > 0))
        return all;
    return all * (tl_lognormal_below(weighted, max) - tl_lognormal_below(weighted, min)) /
           (tl_lognormal_below(d, max) - tl_lognormal_below(d, min));
}

/* ---------------------------------------------------------------- others ----------------- */

/* min <= mode <= max, min < max. */
static inline double tl_triangular_quantile(double min, double mode, double max, double u)
{
    const double span = max - min;
    if (u * span < mode - min)
        return min + sqrt(u * span * (mode - min));
    return max - sqrt((1 - u) * span * (max - mode));
}

/* Density proportional to x^-(1 + exponent) on [min, max], exponent > 0, 0 < min <= max. */
static inline double tl_power_law_quantile(double exponent, double min, double max, double u)
{
    const double share = -tl_expm1(-exponent * tl_lane_log(max / min));
    return fmin(min * tl_lane_exp(-tl_log1p(-u * share) / exponent), max);
}

/* The mean of x^power by the same density:
 *
 *     a / (j - a) (max^(j - a) - min^(j - a)) / (min^-a - max^-a),   for j = a: a ln(max / min) / (min^-a - max^-a) */
static inline double tl_power_law_moment(double exponent, double min, double max, double power)
{
    const double log_ratio = tl_lane_log(max / min), j = power - exponent;
    const double scale = tl_lane_exp(power * tl_lane_log(min));
    if (!(log_ratio > 0))
        return scale;
    const double part = fabs(j * log_ratio) < 1e-12 ? log_ratio : tl_expm1(j * log_ratio) / j;
    return scale * exponent * part / -tl_expm1(-exponent * log_ratio);
}

/* ---------------------------------------------------------------- directions ------------- */

/* A direction about `mean`, of unit length, after Fisher with the concentration k > 0: u, v in (0, 1). See
 * Proc. R. Soc. Lond. A 217 (1953) 295-305; t is the angle from the mean:
 *
 *     1 - cos t = -ln(1 - u (1 - exp(-2 k))) / k,   azimuth = 360 deg v */
static inline tl_vec3 tl_fisher_direction(tl_vec3 mean, double k, double u, double v)
{
    const double drop = fmin(-tl_log1p(u * tl_expm1(-2 * k)) / k, 2), sine = sqrt(drop * (2 - drop));
    const tl_vec3 e = tl_v3_perpendicular(mean), f = tl_v3_cross(mean, e);
    const tl_vec3 side = tl_v3_madd(tl_v3_scale(tl_cos_degrees(360 * v), e), tl_sin_degrees(360 * v), f);
    return tl_v3_unit(tl_v3_madd(tl_v3_scale(1 - drop, mean), sine, side));
}

/* Dip in [0, 90] and dip direction in [0, 360), degrees, of the plane with a normal, whose sign means nothing. */
static inline void tl_plane_attitude(tl_vec3 normal, double *dip, double *dip_direction)
{
    const double degree = 57.29577951308232;
    const tl_vec3 up = normal.z < 0 ? tl_v3_neg(normal) : normal;
    const double across = sqrt(up.x * up.x + up.y * up.y);
    double direction = across > 0 ? degree * tl_atan2(up.x, up.y) : 0;
    direction = direction < 0 ? direction + 360 : direction;
    *dip = degree * tl_atan2(across, up.z);
    *dip_direction = direction < 360 ? direction : 0;
}

#endif
