/* draws.c - random numbers of realisations by keys, and the interval of Clopper and Pearson.
 *
 * The stratum of a row in a Latin hypercube of n rows is a permutation of [0, n) that a key chooses: a Feistel network
 * of ROUNDS rounds on the least even number of bits 2 b with 4^b >= n. Results beyond n are permuted again until they
 * are below, at most 4 times on average (Black and Rogaway, "Ciphers with arbitrary finite domains", 2002).
 *
 * Ends of the interval are quantiles of the beta distribution. For k hits of n, with the tail a = (1 - level) / 2:
 *
 *     low = p with I_p(k, n - k + 1) = a,   high = p with I_p(k + 1, n - k) = 1 - a
 *
 * I is the regularised incomplete beta function, by Lentz's continued fraction (DLMF 8.17.22). */
#include "base/random.h"

#include <talus/draws.h>
#include <talus/elementary.h>

/* Constant: rounds after which no relation between neighbouring rows is left. */
#define ROUNDS 6
/* Constant: halvings that leave no digit of a probability. */
#define HALVINGS 60
/* Constant: argument from which Stirling's series with five terms has all digits. */
#define STIRLING_FROM 12.0
/* Limit: terms of the continued fraction; it needs some sqrt(n). */
#define MOST_TERMS 100000
/* Tolerance: change of the continued fraction by a term, relative, that rounding is as large as. Test:
 * unit/test_draws. */
#define LAST_TERM 1e-15

/* ---------------------------------------------------------------- draws ------------------ */

static uint64_t key_of_name(const tl_draw *draw)
{
    return tl_key(tl_key_text(tl_key(0, draw->seed), draw->name), draw->part);
}

uint64_t tl_draw_key(const tl_draw *draw)
{
    return tl_key(key_of_name(draw), draw->row);
}

/* Bits of each half. */
static unsigned half_bits(uint64_t count)
{
    unsigned bits = 1;
    while (bits < 32 && (uint64_t)1 << (2 * bits) < count)
        bits++;
    return bits;
}

/* Where the keyed permutation of [0, count) puts x. */
static uint64_t permute(uint64_t key, uint64_t count, uint64_t x)
{
    const unsigned bits = half_bits(count);
    const uint64_t mask = ((uint64_t)1 << bits) - 1;
    do {
        uint64_t left = x >> bits, right = x & mask;
        for (uint64_t round = 0; round < ROUNDS; round++) {
            const uint64_t next = left ^ (tl_key(tl_key(key, round), right) & mask);
            left = right;
            right = next;
        }
        x = left << bits | right;
    } while (x >= count);
    return x;
}

double tl_draw_uniform(const tl_draw *draw)
{
    /* the middle of one of 2^53 intervals, so that neither 0 nor 1 comes */
    const double most = 1 - 0x1p-53;
    double u = fmin(tl_uniform(tl_draw_key(draw)) + 0x1p-54, most);
    if (draw->latin == 0)
        return u;
    const uint64_t stratum = permute(key_of_name(draw), draw->latin, (draw->row - 1) % draw->latin);
    return fmin(((double)stratum + u) / (double)draw->latin, most);
}

/* ---------------------------------------------------------------- intervals -------------- */

/* The logarithm of the gamma function, x >= 1: Stirling's series, from where it has all digits, and back by
 * ln gamma(x) = ln gamma(x + 1) - ln x. */
static double log_gamma(double x)
{
    double product = 1;
    for (; x < STIRLING_FROM; x++)
        product *= x;
    const double z = 1 / (x * x);
    const double series = 1. / 12 - z * (1. / 360 - z * (1. / 1260 - z * (1. / 1680 - z * (1. / 1188))));
    const double half_log_two_pi = 0.9189385332046727;
    return (x - 0.5) * tl_lane_log(x) - x + half_log_two_pi + series / x - tl_lane_log(product);
}

/* The continued fraction of the incomplete beta function, x < (a + 1) / (a + b + 2). */
static double beta_fraction(double a, double b, double x)
{
    const double tiny = 1e-300;
    double c = 1, d = 1 - (a + b) * x / (a + 1);
    d = 1 / (fabs(d) < tiny ? tiny : d);
    double sum = d;
    for (int i = 1; i < MOST_TERMS; i++) {
        double change = 1;
        for (int odd = 0; odd < 2; odd++) {
            const double m = i, top = odd ? -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
                                          : m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
            d = 1 + top * d;
            d = 1 / (fabs(d) < tiny ? tiny : d);
            c = 1 + top / c;
            c = fabs(c) < tiny ? tiny : c;
            change *= c * d;
        }
        sum *= change;
        if (fabs(change - 1) < LAST_TERM)
            break;
    }
    return sum;
}

/* I_x(a, b), a, b >= 1, `log_beta` = ln(gamma(a) gamma(b) / gamma(a + b)). */
static double beta_below(double a, double b, double log_beta, double x)
{
    if (x <= 0 || x >= 1)
        return x <= 0 ? 0 : 1;
    const double front = tl_lane_exp(a * tl_lane_log(x) + b * tl_log1p(-x) - log_beta);
    if (x < (a + 1) / (a + b + 2))
        return front * beta_fraction(a, b, x) / a;
    return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

static double beta_quantile(double a, double b, double share)
{
    const double log_beta = log_gamma(a) + log_gamma(b) - log_gamma(a + b);
    double low = 0, high = 1;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);
        if (beta_below(a, b, log_beta, middle) < share)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

void tl_binomial_interval(uint64_t hits, uint64_t count, double level, double *low, double *high)
{
    const double k = (double)hits, n = (double)count, tail = 0.5 * (1 - level);
    *low = hits == 0 ? 0 : beta_quantile(k, n - k + 1, tail);
    *high = hits == count ? 1 : beta_quantile(k + 1, n - k, 1 - tail);
}
