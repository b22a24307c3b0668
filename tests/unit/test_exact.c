/* Sums do not depend on the order of the numbers, on how they are divided, nor on what was added in between, and they
 * are as true as a sum in twice the digits. */
#include "base/exact.h"
#include "check.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST 3000
#define CASES 2000

static uint64_t seed = 1;

static uint64_t draw(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return seed >> 20;
}

static double unit(void)
{
    return (double)(draw() % 1000003) / 1000003;
}

/* Numbers of a case: of one size or of many, of one sign or of both, some zeros, some at the borders of windows. */
static size_t fill(double *number)
{
    const size_t count = 1 + draw() % (draw() % 3 ? 70 : MOST);
    const int spread = (int)(draw() % 4 ? draw() % 20 : draw() % 600), about = (int)(draw() % 600) - 300;
    const bool both = draw() % 2, borders = draw() % 8 == 0;
    for (size_t i = 0; i < count; i++) {
        double x = ldexp(1 + unit(), about + (spread ? (int)(draw() % (unsigned)spread) - spread / 2 : 0));
        if (borders)
            x = ldexp(1, 52 * (int)(draw() % 4) + 38 + (int)(draw() % 3)) *
                (1 + (double)((int)(draw() % 3) - 1) * DBL_EPSILON);
        number[i] = draw() % 10 == 0 ? 0 : both && draw() % 2 ? -x : x;
    }
    return count;
}

/* The sum in parts of chance sizes, each added to one of three sums, which are merged in the end. */
static double sum_in_parts(const double *number, size_t count)
{
    tl_exact sum[3] = {{{0}, {0}, 0, false}};
    for (size_t at = 0; at < count;) {
        size_t some = 1 + draw() % 40;
        some = some < count - at ? some : count - at;
        tl_exact_add(&sum[draw() % 3], number + at, some);
        at += some;
    }
    tl_exact_merge(&sum[1], &sum[2]);
    tl_exact_merge(&sum[0], &sum[1]);
    return tl_exact_value(&sum[0]);
}

static double sum_one_by_one(const double *number, size_t count)
{
    tl_addends a = {.count = 0};
    for (size_t i = 0; i < count; i++)
        tl_addends_put(&a, number[i]);
    return tl_addends_sum(&a);
}

static void shuffle(double *number, size_t count)
{
    for (size_t i = count; i > 1; i--) {
        size_t k = draw() % i;
        double x = number[i - 1];
        number[i - 1] = number[k];
        number[k] = x;
    }
}

static bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* By twice the digits: the error is at most half a fine unit for each number, beside rounding of the result. */
static bool is_true(const double *number, size_t count, double sum)
{
    double most = 0, high = 0, low = 0;
    for (size_t i = 0; i < count; i++) {
        const double s = high + number[i], b = s - high;
        low += (high - (s - b)) + (number[i] - b);
        high = s;
        most = fmax(most, fabs(number[i]));
    }
    const double exact = high + low, error = fabs(sum - high - low);
    return error <= (double)count * most * DBL_EPSILON * 1.01 + fabs(exact) * DBL_EPSILON;
}

TEST(sums_do_not_depend_on_order_or_parts)
{
    static double number[MOST];
    for (int k = 0; k < CASES; k++) {
        const size_t count = fill(number);
        tl_exact whole = {{0}, {0}, 0, false};
        tl_exact_add(&whole, number, count);
        const double sum = tl_exact_value(&whole);
        CHECK(is_true(number, count, sum));
        CHECK(same_bits(sum_in_parts(number, count), sum));
        shuffle(number, count);
        CHECK(same_bits(sum_in_parts(number, count), sum));
        CHECK(same_bits(sum_one_by_one(number, count), sum));
    }
}

TEST(numbers_of_few_digits_add_exactly)
{
    static const double number[] = {12.5, -0.375, 1e6, 1024.0625, -1e6};
    tl_exact sum = {{0}, {0}, 0, false};
    tl_exact_add(&sum, number, sizeof number / sizeof *number);
    CHECK(tl_exact_value(&sum) == 12.5 - 0.375 + 1024.0625);
    for (int k = 0; k < CASES; k++) { /* one number: to its last bit */
        const double x = ldexp(unit() - 0.5, (int)(draw() % 1600) - 800);
        tl_exact one = {{0}, {0}, 0, false};
        tl_exact_add(&one, &x, 1);
        CHECK(fabs(tl_exact_value(&one) - x) <= DBL_EPSILON * fabs(x));
    }
}

TEST(what_cancels_is_zero)
{
    static double number[MOST];
    for (int k = 0; k < CASES; k++) {
        const size_t count = fill(number) / 2;
        for (size_t i = 0; i < count; i++)
            number[count + i] = -number[i];
        shuffle(number, 2 * count);
        CHECK(sum_in_parts(number, 2 * count) == 0);
    }
}

TEST(a_number_that_is_not_finite_is_told)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, DBL_MAX};
    for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
        const double number[] = {1, 2, odd[k], 3};
        CHECK(isnan(sum_in_parts(number, 4)));
    }
    const double tiny[] = {DBL_MIN, -DBL_MIN / 4, DBL_TRUE_MIN};
    CHECK(fabs(sum_in_parts(tiny, 3)) < 1e-300);
    CHECK(sum_in_parts(tiny, 0) == 0);
}

TEST(large_counts_are_held)
{
    static double number[5000];
    for (size_t i = 0; i < 5000; i++)
        number[i] = ldexp(1, 49) - 1;
    tl_exact sum = {{0}, {0}, 0, false};
    for (int k = 0; k < 2000; k++)
        tl_exact_add(&sum, number, 5000);
    CHECK(tl_exact_value(&sum) == 1e7 * (ldexp(1, 49) - 1));
}

TEST_MAIN(RUN(sums_do_not_depend_on_order_or_parts), RUN(numbers_of_few_digits_add_exactly), RUN(what_cancels_is_zero),
          RUN(a_number_that_is_not_finite_is_told), RUN(large_counts_are_held))
