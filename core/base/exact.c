/* exact.c - sums that do not depend on the order of what is added.
 *
 * A number x is rounded to a multiple of a unit u by x + M, with M = 1.5 2^52 u: doubles of that size are multiples
 * of u. Their bits, as integers, differ by one per unit. So the sum of the bits of x + M, less those of M each time, is
 * the sum of the multiples. What is left, x - ((x + M) - M), is exact, and less than a unit. It is rounded to multiples
 * of the next unit likewise.
 *
 * Windows are pairs of units. The coarse unit of each is the fine one of the next. A number x belongs to a window when
 * x + M stays between 2^52 and 2^53 units: x is then at most half of the next coarse unit. In higher windows it is
 * rounded to 0 first, and goes on unchanged. So what it adds to a unit is the same in all windows that have it. */
#include "base/exact.h"

#include "base/inline.h"

#include <math.h>
#include <string.h>
#include <talus/plugin.h>

/* Constant: bits between the units of a window, and of the exponent of the lowest fine unit. */
#define SPACING 52
#define LOWEST (-1000)
/* Limit: the last window, whose numbers are below 2^975. */
#define LAST_WINDOW 36
/* Limit: numbers, multiples of up to 2^51 units each, that are added before their sum is taken apart. */
#define MOST_AT_ONCE 2048

/* Two vectors a pass: half of what counting costs. */
#if defined(__GNUC__) && !defined(__clang__)
#define TL_UNROLLED _Pragma("GCC unroll 2")
#else
#define TL_UNROLLED
#endif

typedef struct units {
    double coarse, fine; /* M */
} units;

/* 2^exponent, of a double that is neither denormal nor infinite. */
static double power_of_two(int exponent)
{
    uint64_t bits = (uint64_t)(exponent + 1023) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power;
}

/* Exponent of the fine unit of a window. */
static int fine_of(int window)
{
    return LOWEST + SPACING * window;
}

static units units_of(int window)
{
    const int fine = fine_of(window), coarse = fine + SPACING;
    return (units){1.5 * power_of_two(52 + coarse), 1.5 * power_of_two(52 + fine)};
}

TL_INLINE uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Sums of the bits of both roundings. False when a number does not belong to the window. */
TL_INLINE bool add_bits(const units *u, const double *restrict number, size_t count, uint64_t sum[2])
{
    const double coarse = u->coarse, fine = u->fine;
    const uint64_t coarse_bits = bits_of(coarse);
    uint64_t first = 0, second = 0, beyond = 0;
    TL_UNROLLED
    for (size_t i = 0; i < count; i++) {
        const double rounded = number[i] + coarse, left = number[i] - (rounded - coarse);
        first += bits_of(rounded);
        second += bits_of(left + fine);
        beyond |= bits_of(rounded) ^ coarse_bits; /* sign and exponent */
    }
    sum[0] = first - count * coarse_bits;
    sum[1] = second - count * bits_of(fine);
    return beyond >> 52 == 0;
}

/* Adds a sum of multiples, which fits an int64_t. */
static void add_multiples(tl_exact *sum, int level, uint64_t multiples)
{
    int64_t signed_sum;
    memcpy(&signed_sum, &multiples, sizeof signed_sum);
    sum->high[level] += signed_sum >> 32;
    sum->low[level] += (int64_t)(multiples & UINT32_MAX);
}

/* Goes on in the same or in a higher window. */
static void raise_window(tl_exact *sum, int window)
{
    if (window == sum->window)
        return;
    const bool next = window == sum->window + 1;
    sum->high[1] = next ? sum->high[0] : 0;
    sum->low[1] = next ? sum->low[0] : 0;
    sum->high[0] = sum->low[0] = 0;
    sum->window = window;
}

/* The lowest window to which a number may belong, by its exponent as it is stored; beyond the last: none may. It is
 * less than 2^(exponent - 1022), and less than 2^51 coarse units belong to a window. */
TL_INLINE int window_from(int32_t exponent)
{
    const int above = exponent - 1022 - (fine_of(0) + 2 * SPACING - 1);
    return above <= 0 ? 0 : (above + SPACING - 1) / SPACING;
}

/* That of the first number that is not 0. */
TL_INLINE int first_window(const double *number, size_t count)
{
    size_t i = 0;
    while (i + 1 < count && number[i] == 0)
        i++;
    const int window = window_from((int32_t)(bits_of(number[i]) >> 52 & 0x7ff));
    return window <= LAST_WINDOW ? window : 0;
}

/* The lowest window to which the largest of some numbers may belong. */
TL_INLINE int window_of(const double *number, size_t count)
{
    int32_t largest = 0; /* of the upper halves, without sign: exponents first */
    for (size_t i = 0; i < count; i++) {
        const int32_t upper = (int32_t)(bits_of(number[i]) >> 32 & INT32_MAX);
        largest = upper > largest ? upper : largest;
    }
    return window_from(largest >> 20);
}

/* Adds numbers of which one may not belong to the sum's window: the sum goes on in one that has them all. */
TL_INLINE void add_beyond(tl_exact *sum, const double *number, size_t count)
{
    uint64_t multiples[2];
    for (int window = window_of(number, count); window <= LAST_WINDOW; window++) {
        window = window > sum->window ? window : sum->window;
        const units u = units_of(window);
        if (!add_bits(&u, number, count, multiples))
            continue;
        raise_window(sum, window);
        add_multiples(sum, 0, multiples[0]);
        add_multiples(sum, 1, multiples[1]);
        return;
    }
    sum->endless = true;
}

TL_VECTORIZED static void add_each(tl_exact *sums, size_t sum_count, const double *number, size_t stride, size_t count)
{
    for (size_t k = 0; k < sum_count; k++)
        for (size_t begin = 0; begin < count; begin += MOST_AT_ONCE) {
            const size_t some = count - begin < MOST_AT_ONCE ? count - begin : MOST_AT_ONCE;
            const double *at = number + k * stride + begin;
            if (sums[k].window == 0)
                raise_window(&sums[k], first_window(at, some));
            const units u = units_of(sums[k].window);
            uint64_t multiples[2];
            if (!add_bits(&u, at, some, multiples)) {
                add_beyond(&sums[k], at, some);
                continue;
            }
            add_multiples(&sums[k], 0, multiples[0]);
            add_multiples(&sums[k], 1, multiples[1]);
        }
}

void tl_exact_add_each(tl_exact *sums, size_t sum_count, const double *number, size_t stride, size_t count)
{
    add_each(sums, sum_count, number, stride, count);
}

void tl_exact_add(tl_exact *sum, const double *number, size_t count)
{
    add_each(sum, 1, number, 0, count);
}

void tl_exact_merge(tl_exact *sum, const tl_exact *other)
{
    raise_window(sum, other->window > sum->window ? other->window : sum->window);
    const int lower = sum->window - other->window; /* what the other has below the fine unit is left out */
    for (int level = 0; lower + level < 2; level++) {
        sum->high[lower + level] += other->high[level];
        sum->low[lower + level] += other->low[level];
    }
    sum->endless = sum->endless || other->endless;
}

double tl_exact_value(const tl_exact *sum)
{
    if (sum->endless)
        return NAN;
    if (sum->window == 0 && sum->high[0] == 0 && sum->low[0] == 0 && sum->high[1] == 0 && sum->low[1] == 0)
        return 0;
    int64_t high[2], low[2];
    for (int level = 0; level < 2; level++) {
        high[level] = sum->high[level] + (sum->low[level] >> 32);
        low[level] = sum->low[level] & UINT32_MAX;
    }
    /* of the fine multiples all but the rest within half a coarse unit are coarse ones */
    const int64_t carried = (high[1] + ((int64_t)1 << (SPACING - 33))) >> (SPACING - 32);
    const int64_t rest = (high[1] - carried * ((int64_t)1 << (SPACING - 32))) * ((int64_t)1 << 32) + low[1];
    low[0] += carried;
    high[0] += low[0] >> 32;
    low[0] &= UINT32_MAX;
    const double fine = power_of_two(fine_of(sum->window)), whole = (double)high[0] * 0x1p32 + (double)low[0];
    return whole * (fine * power_of_two(SPACING)) + (double)rest * fine;
}

double tl_addends_sum(tl_addends *a)
{
    tl_exact_add(&a->sum, a->number, a->count);
    a->count = 0;
    return tl_exact_value(&a->sum);
}
