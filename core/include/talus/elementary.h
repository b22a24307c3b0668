/* talus/elementary.h - sines, arc tangents, logarithms, exponentials and roots that give the same bits everywhere.
 *
 * Those of the C library differ in their last bit between versions of the library and between processors with
 * and without FMA. The functions here use only +, -, *, /, sqrt, fma, floor, fmod and frexp, which IEEE 754 and C
 * define to the bit, in one fixed order. Build with -ffp-contract=off.
 *
 * Each function reduces its argument to a small interval, sums the Taylor series there, and carries the
 * rounding of its largest term along. Each function states its largest error in units in the last
 * place (ulp), which tests/unit/test_elementary.c measures against long double.
 *
 * The functions tl_lane_* are for loops over columns: they have no branch, no call and no fma, so that compilers make
 * vectors of them, and each says which arguments it takes.
 *
 * Limits: a sine, cosine or tangent of more than TL_TURNS_EXACT rad takes its argument modulo the double
 * nearest to 2 pi. Not-a-number and infinite arguments give what C's functions give; errno is not set. */
#ifndef TALUS_ELEMENTARY_H
#define TALUS_ELEMENTARY_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Largest argument, rad, that is reduced without error: products of its quarter turns with 33 bits of pi/2 are
 * exact below it. */
#define TL_TURNS_EXACT 0x1p20

/* Arguments below which sine, tangent, log(1 + x) and exp(x) - 1 are the argument itself, zeros with their sign. */
#define TL_LINEAR 0x1p-54

/* A number as a sum: `lo` is below half a unit in the last place of `hi`. */
typedef struct tl_sum2 {
    double hi, lo;
} tl_sum2;

/* a + b without error, |a| >= |b|. */
static inline tl_sum2 tl_sum2_of(double a, double b)
{
    double s = a + b;
    return (tl_sum2){s, (a - s) + b};
}

/* ---------------------------------------------------------------- sine, cosine, tangent -- */

/* Taylor series of (sin x - x) / x^3 and of (cos x - 1 + x^2 / 2) / x^4, z = x^2. */
static inline double tl_sine_series(double z)
{
    double high = -1. / 39916800 + z * (1. / 6227020800 + z * (-1. / 1307674368000 + z * (1. / 355687428096000)));
    return -1. / 6 + z * (1. / 120 + z * (-1. / 5040 + z * (1. / 362880 + z * high)));
}

static inline double tl_cosine_series(double z)
{
    double high = -1. / 87178291200 + z * (1. / 20922789888000 - z * (1. / 6402373705728000.));
    return 1. / 24 + z * (-1. / 720 + z * (1. / 40320 + z * (-1. / 3628800 + z * (1. / 479001600 + z * high))));
}

/* sin(x.hi + x.lo), |x| <= pi/4 and a little. */
static inline tl_sum2 tl_sine_of(tl_sum2 x)
{
    double z = x.hi * x.hi;
    return tl_sum2_of(x.hi, x.hi * z * tl_sine_series(z) + x.lo * (1 - 0.5 * z));
}

/* cos(x.hi + x.lo), |x| <= pi/4 and a little. */
static inline tl_sum2 tl_cosine_of(tl_sum2 x)
{
    double z = x.hi * x.hi, half = 0.5 * z, half_lo = 0.5 * fma(x.hi, x.hi, -z);
    tl_sum2 c = tl_sum2_of(1, -half);
    return tl_sum2_of(c.hi, c.lo + (z * z * tl_cosine_series(z) - half_lo - x.hi * x.lo));
}

/* x less a whole number of quarter turns, the remainder of that number by 4 in `quarter`. */
static inline tl_sum2 tl_quarter_turns(double x, int *quarter)
{
    *quarter = 0;
    if (fabs(x) <= 0x1.921fb54442d18p-1) /* pi/4 */
        return (tl_sum2){x, 0};
    if (fabs(x) > TL_TURNS_EXACT)
        x = fmod(x, 0x1.921fb54442d18p+2); /* 2 pi */
    double k = floor(x * 0x1.45f306dc9c883p-1 + 0.5);
    /* pi/2 in three parts; products of k with the first two are exact */
    double a = x - k * 0x1.921fb544p+0, b = k * 0x1.0b4611a6p-34, c = k * 0x1.3198a2e037073p-69;
    double d = a - b, back = a - d; /* the rounding of d, whichever of a and b is larger */
    double e = ((a - (d + back)) + (back - b)) - c;
    *quarter = (int)k & 3;
    return tl_sum2_of(d, e);
}

/* sin(x + quarter pi/2), within 0.85 ulp. */
static inline double tl_sin_turned(double x, int quarter)
{
    if (!isfinite(x))
        return x - x;
    int own;
    tl_sum2 r = tl_quarter_turns(x, &own);
    switch ((own + quarter) & 3) {
    case 0: return tl_sine_of(r).hi;
    case 1: return tl_cosine_of(r).hi;
    case 2: return -tl_sine_of(r).hi;
    default: return -tl_cosine_of(r).hi;
    }
}

static inline double tl_sin(double x)
{
    return fabs(x) < TL_LINEAR ? x : tl_sin_turned(x, 0);
}

static inline double tl_cos(double x)
{
    return tl_sin_turned(x, 1);
}

/* a / b, of sums. */
static inline double tl_sum2_ratio(tl_sum2 a, tl_sum2 b)
{
    double q = a.hi / b.hi;
    return q + ((fma(-q, b.hi, a.hi) + a.lo) - q * b.lo) / b.hi;
}

/* Within 1 ulp. */
static inline double tl_tan(double x)
{
    if (!isfinite(x) || fabs(x) < TL_LINEAR)
        return isfinite(x) ? x : x - x;
    int quarter;
    tl_sum2 r = tl_quarter_turns(x, &quarter);
    tl_sum2 s = tl_sine_of(r), c = tl_cosine_of(r);
    return quarter & 1 ? -tl_sum2_ratio(c, s) : tl_sum2_ratio(s, c);
}

/* ---------------------------------------------------------------- arc tangent, arc sine -- */

/* atan(y / x) for 0 <= y <= x, x > 0 and neither near the ends of the range: atan(k/8) + atan t, with t the tangent of
 * the rest, |t| <= 1/16. */
static inline tl_sum2 tl_arc_of(double y, double x)
{
    static const tl_sum2 table[9] = {{0, 0},
                                     {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                     {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                     {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                     {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                     {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                     {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                     {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
    int k = (int)(y / x * 8 + 0.5);
    double g = 0.125 * k;
    /* t = (y - g x) / (x + g y), numerator and denominator as sums */
    double gx = g * x, gy = g * y;
    tl_sum2 above = {y - gx, -fma(g, x, -gx)}, below = tl_sum2_of(x, gy);
    below.lo += fma(g, y, -gy);
    double t = above.hi / below.hi;
    double rest = ((fma(-t, below.hi, above.hi) + above.lo) - t * below.lo) / below.hi;
    double z = t * t;
    double p =
        z * (-1. / 3 + z * (1. / 5 + z * (-1. / 7 + z * (1. / 9 + z * (-1. / 11 + z * (1. / 13 + z * (-1. / 15)))))));
    if (k == 0)
        return tl_sum2_of(t, t * p + rest);
    tl_sum2 sum = tl_sum2_of(table[k].hi, t);
    return tl_sum2_of(sum.hi, sum.lo + (table[k].lo + rest + t * p));
}

/* The angle of the vector (x, y) from the x axis, in [-pi, pi], within 0.9 ulp. */
static inline double tl_atan2(double y, double x)
{
    if (isnan(x) || isnan(y))
        return x + y;
    double ax = fabs(x), ay = fabs(y);
    if (isinf(ax) || isinf(ay)) { /* the same direction with finite components */
        ax = isinf(ax) ? 1 : 0;
        ay = isinf(ay) ? 1 : 0;
    }
    double large = ax > ay ? ax : ay, small = ax > ay ? ay : ax;
    int exponent;
    (void)frexp(large, &exponent); /* brings the larger to [1/2, 1): no overflow below */
    large = ldexp(large, -exponent);
    small = ldexp(small, -exponent);
    tl_sum2 angle = large > 0 ? tl_arc_of(small, large) : (tl_sum2){0, 0};
    if (ay > ax)
        angle = tl_sum2_of(0x1.921fb54442d18p+0, -angle.hi + (0x1.1a62633145c07p-54 - angle.lo)); /* pi/2 - angle */
    double out = angle.hi + angle.lo;
    if (signbit(x))
        out = 0x1.921fb54442d18p+1 - (angle.hi - (0x1.1a62633145c07p-53 - angle.lo));
    return copysign(out, y);
}

/* Within 1.3 ulp; not a number beyond [-1, 1]. */
static inline double tl_asin(double x)
{
    return tl_atan2(x, sqrt((1 - x) * (1 + x)));
}

/* ---------------------------------------------------------------- logarithm, exponential - */

/* log(1 + f) = 2 artanh s = f - s (f - r), s = f / (2 + f), z = s^2: r. */
static inline double tl_log_series(double z)
{
    double high = 2. / 11 + z * (2. / 13 + z * (2. / 15 + z * (2. / 17 + z * (2. / 19 + z * (2. / 21)))));
    return z * (2. / 3 + z * (2. / 5 + z * (2. / 7 + z * (2. / 9 + z * high))));
}

/* The Taylor series of (exp r - 1 - r - r^2 / 2) / r^3. */
static inline double tl_exp_series(double r)
{
    double high = 1. / 39916800 + r * (1. / 479001600 + r * (1. / 6227020800 + r * (1. / 87178291200.)));
    high = 1. / 40320 + r * (1. / 362880 + r * (1. / 3628800 + r * high));
    return 1. / 6 + r * (1. / 24 + r * (1. / 120 + r * (1. / 720 + r * (1. / 5040 + r * high))));
}

/* log(1 + x), within 1 ulp. */
static inline double tl_log1p(double x)
{
    if (!(x > -1))
        return x == -1 ? -INFINITY : NAN;
    if (isinf(x) || fabs(x) < TL_LINEAR)
        return x;
    double w = 1 + x, lost = x > 1 ? 1 - (w - x) : x - (w - 1);
    int e;
    double m = frexp(w, &e);
    if (m < 0x1.6a09e667f3bcdp-1) { /* sqrt(1/2): m is in [0.71, 1.41) */
        m *= 2;
        e--;
    }
    double f = e == 0 ? x : m - 1, s = f / (2 + f), z = s * s;
    if (e == 0)
        lost = 0;
    double r = tl_log_series(z);
    /* log 2 in two parts; the product of e with the first is exact */
    return e * 0x1.62e42feep-1 + (f - (s * (f - r) - (e * 0x1.a39ef35793c76p-33 + lost / w)));
}

/* exp(x) - 1, within 1.1 ulp. */
static inline double tl_expm1(double x)
{
    if (x > 710)
        return INFINITY;
    if (isnan(x) || fabs(x) < TL_LINEAR)
        return x;
    if (x < -56) /* 2^-53 away from it is 1 ulp */
        return -1;
    double n = fabs(x) < 0x1.62e42fefa39efp-2 ? 0 : floor(x * 0x1.71547652b82fep+0 + 0.5);
    double high = x - n * 0x1.62e42feep-1, low = n * 0x1.a39ef35793c76p-33;
    double r = high - low, e = (high - r) - low;
    double p = tl_exp_series(r);
    tl_sum2 q = tl_sum2_of(r, r * r * (0.5 + r * p) + e * (1 + r));
    if (n == 0)
        return q.hi;
    if (n > 56)
        return ldexp(1 + q.hi, (int)n);
    double scale = ldexp(1, (int)n);
    tl_sum2 sum = tl_sum2_of(scale - 1, scale * q.hi);
    return sum.hi + (sum.lo + scale * q.lo);
}

/* ---------------------------------------------------------------- root ------------------- */

/* The cube root, within 0.51 ulp; exact of whole cubes. */
static inline double tl_cbrt(double x)
{
    if (x == 0 || !isfinite(x))
        return x + x;
    int e;
    double m = frexp(fabs(x), &e); /* |x| = m 2^e */
    int third = e >= 0 ? (e + 2) / 3 : -(-e / 3);
    m = ldexp(m, e - 3 * third); /* in [1/8, 1) */
    double y = 0.4 + 0.62 * m;   /* within 0.1; Newton's steps square the relative error */
    for (int i = 0; i < 5; i++)
        y -= (y * y * y - m) / (3 * y * y);
    /* the last step from an exact remainder */
    double y2 = y * y, y3 = y2 * y;
    double over = (y3 - m) + (fma(y2, y, -y3) + fma(y, y, -y2) * y);
    y -= over / (3 * y2);
    return copysign(ldexp(y, third), x);
}

/* ---------------------------------------------------------------- in loops over columns -- */

static inline uint64_t tl_bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double tl_of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* exp(x), within 1 ulp. Arguments beyond [-708, 709] count as the nearer of the two. */
static inline double tl_lane_exp(double x)
{
    x = x < -708 ? -708 : x;
    x = x > 709 ? 709 : x;
    /* adding 1.5 2^52 rounds to a whole number, which is then in the last bits */
    double k = x * 0x1.71547652b82fep+0 + 0x1.8p52, n = k - 0x1.8p52;
    double scale = tl_of_bits((tl_bits_of(k) + 1023) << 52);
    double high = x - n * 0x1.62e42feep-1, low = n * 0x1.a39ef35793c76p-33;
    double r = high - low, e = (high - r) - low;
    double p = tl_exp_series(r);
    double s = 1 + r, lost = (1 - s) + r;
    return scale * (s + (lost + (e + r * r * (0.5 + r * p))));
}

/* log x, within 1 ulp, for positive normal x; NaN of an infinite x. */
static inline double tl_lane_log(double x)
{
    /* x = m 2^e with m in [sqrt(1/2), sqrt 2) */
    uint64_t bits = tl_bits_of(x);
    uint64_t k = (bits - 0x3fe6a09e667f3bcdu + ((uint64_t)1024 << 52)) >> 52; /* e + 1024 */
    double e = tl_of_bits(k | 0x4330000000000000u) - (0x1p52 + 1024);
    double f = tl_of_bits(bits - (k << 52) + ((uint64_t)1024 << 52)) - 1;
    double s = f / (2 + f), z = s * s;
    double r = tl_log_series(z);
    double log = e * 0x1.62e42feep-1 + (f - (s * (f - r) - e * 0x1.a39ef35793c76p-33));
    return log + (x - x); /* not-a-number stays one */
}

/* log(1 + x), within 1.5 ulp, for -1 < x < 1e300. */
static inline double tl_lane_log1p(double x)
{
    double w = 1 + x, lost = x > 1 ? 1 - (w - x) : x - (w - 1);
    return tl_lane_log(w) + lost / w;
}

/* arsinh x, within 2 ulp, for |x| < 1e150. */
static inline double tl_lane_asinh(double x)
{
    double a = x < 0 ? -x : x, a2 = a * a;
    double y = tl_lane_log1p(a + a2 / (1 + sqrt(1 + a2)));
    return x < 0 ? -y : y;
}

/* tan x, within 2.5 ulp, for 0 <= x < pi/2 and no nearer to pi/2 than 1e-8. */
static inline double tl_lane_tan(double x)
{
    /* of more than pi/4 the cotangent of what is left to pi/2 */
    double rest = 0x1.921fb54442d18p+0 - x, rest_lo = 0x1.1a62633145c07p-54;
    const double quarter = 0x1.921fb54442d18p-1;
    double y = x > quarter ? rest : x, lo = x > quarter ? rest_lo : 0;
    double z = y * y;
    double s = tl_sine_series(z), c = tl_cosine_series(z);
    double half = 0.5 * z, one = 1 - half;
    double sine = y + (y * z * s + lo * one);
    double cosine = one + (((1 - one) - half) + (z * z * c - y * lo));
    return (x > quarter ? cosine : sine) / (x > quarter ? sine : cosine);
}

#endif
