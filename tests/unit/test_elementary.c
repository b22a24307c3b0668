/* test_elementary.c - talus/elementary.h: errors against long double, special values, and the bits themselves,
 * which must be the same from every compiler and on every machine. */
#include "check.h"

#include <float.h>
#include <stdbool.h>
#include <stdint.h>
#include <talus/elementary.h>
#include <talus/plugin.h>
#include <talus/vmath.h>

#define CASES 300000

/* The bits of CASES results of each function, summed up; obtained once. Any other number means that some machine or
 * compiler computes something else. */
#define BITS UINT64_C(0x8a4dbe3fc21aa5f1)

/* The same of the functions for loops over columns. */
#define LANE_BITS UINT64_C(0xc8ac5e79ad11bdc8)

static uint64_t seed, bits;

static uint64_t mix(uint64_t z)
{
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* Uniform in [0, 1). */
static double uniform(void)
{
    return (double)(mix(seed += 0x9e3779b97f4a7c15u) >> 11) * 0x1p-53;
}

/* Of both signs, of sizes from 2^low to 2^high. */
static double spread(int low, int high)
{
    double x = 1 + uniform(); /* one draw after the other: compilers choose the order within an expression */
    x = ldexp(x, low + (int)(uniform() * (high - low)));
    return uniform() < 0.5 ? -x : x;
}

/* |got - exact| in units in the last place of the result. */
static double ulps(double got, long double exact)
{
    double size = fabs((double)exact);
    if (size < DBL_MIN)
        size = DBL_MIN;
    int e;
    (void)frexp(size, &e);
    return (double)(fabsl((long double)got - exact) / ldexpl(1, e - 53));
}

static void note(double x)
{
    uint64_t word;
    memcpy(&word, &x, sizeof word);
    bits = mix(bits ^ word);
}

typedef struct function {
    const char *name;
    double (*ours)(double x, double y);
    long double (*exact)(long double x, long double y);
    double bound; /* ulp, as elementary.h states it */
    double (*x)(void), (*y)(void);
} function;

#define OF_ONE(name)                                                                                                   \
    static double our_##name(double x, double y)                                                                       \
    {                                                                                                                  \
        (void)y;                                                                                                       \
        return tl_##name(x);                                                                                           \
    }                                                                                                                  \
    static long double exact_##name(long double x, long double y)                                                      \
    {                                                                                                                  \
        (void)y;                                                                                                       \
        return name##l(x);                                                                                             \
    }
/* Of tl_lane_NAME. */
#define OF_LANE(name)                                                                                                  \
    static double our_lane_##name(double x, double y)                                                                  \
    {                                                                                                                  \
        (void)y;                                                                                                       \
        return tl_lane_##name(x);                                                                                      \
    }                                                                                                                  \
    static long double exact_lane_##name(long double x, long double y)                                                 \
    {                                                                                                                  \
        (void)y;                                                                                                       \
        return name##l(x);                                                                                             \
    }
OF_ONE(sin)
OF_ONE(cos)
OF_ONE(tan)
OF_ONE(asin)
OF_ONE(log1p)
OF_ONE(expm1)
OF_ONE(cbrt)

static double angle(void)
{
    return spread(-30, 20);
}

static double half_turn(void)
{
    return 2 * uniform() - 1;
}

static double any(void)
{
    return spread(-60, 60);
}

static double above_minus_one(void)
{
    double x = uniform() < 0.5 ? spread(-60, 0) : spread(-2, 60);
    return x > -1 ? x : -1 + uniform();
}

static double exponent(void)
{
    return spread(-60, 9);
}

OF_LANE(exp)
OF_LANE(log)
OF_LANE(log1p)
OF_LANE(asinh)
OF_LANE(tan)

static double positive(void)
{
    return fabs(spread(-1000, 1000));
}

static double near_one(void)
{
    return 0.5 + uniform();
}

static double acute(void)
{
    return uniform() < 0.5 ? fabs(spread(-60, 0)) : 1.5707 * uniform();
}

static double in_exp(void)
{
    return uniform() < 0.5 ? spread(-60, 0) : 708 * (2 * uniform() - 1);
}

static double in_asinh(void)
{
    return spread(-60, 490);
}

static const function lane_functions[] = {
    {"lane exp", our_lane_exp, exact_lane_exp, 1, in_exp, half_turn},
    {"lane log", our_lane_log, exact_lane_log, 1, positive, half_turn},
    {"lane log, 1", our_lane_log, exact_lane_log, 1, near_one, half_turn},
    {"lane log1p", our_lane_log1p, exact_lane_log1p, 1.5, above_minus_one, half_turn},
    {"lane asinh", our_lane_asinh, exact_lane_asinh, 2, in_asinh, half_turn},
    {"lane tan", our_lane_tan, exact_lane_tan, 2.5, acute, half_turn},
};

static const function functions[] = {
    {"sin", our_sin, exact_sin, 0.85, angle, half_turn},
    {"cos", our_cos, exact_cos, 0.85, angle, half_turn},
    {"tan", our_tan, exact_tan, 1, angle, half_turn},
    {"asin", our_asin, exact_asin, 1.3, half_turn, half_turn},
    {"atan2", tl_atan2, atan2l, 0.9, any, any},
    {"atan2, near", tl_atan2, atan2l, 0.9, half_turn, half_turn},
    {"log1p", our_log1p, exact_log1p, 1, above_minus_one, half_turn},
    {"expm1", our_expm1, exact_expm1, 1.1, exponent, half_turn},
    {"cbrt", our_cbrt, exact_cbrt, 0.51, any, half_turn},
};

static void check_errors(const function *g)
{
    double worst = 0, at = 0;
    for (int i = 0; i < CASES; i++) {
        double x = g->x(), y = g->y(), got = g->ours(x, y);
        note(got);
        double error = ulps(got, g->exact(x, y));
        if (!(error <= worst)) {
            worst = error;
            at = x;
        }
    }
    /* where long double is no longer than double, the reference itself is off by its own error */
    double bound = g->bound + (LDBL_MANT_DIG > DBL_MANT_DIG ? 0 : 1);
    printf("%-12s %.3f ulp, at %.17g\n", g->name, worst, at);
    CHECK(worst <= bound);
}

TEST(errors_are_within_their_bounds)
{
    for (size_t f = 0; f < sizeof functions / sizeof *functions; f++)
        check_errors(&functions[f]);
}

TEST(bits_are_the_same_everywhere)
{
    printf("bits 0x%016llx\n", (unsigned long long)bits);
    CHECK(bits == BITS);
}

TEST(lanes)
{
    bits = 0;
    for (size_t f = 0; f < sizeof lane_functions / sizeof *lane_functions; f++)
        check_errors(&lane_functions[f]);
    printf("bits 0x%016llx\n", (unsigned long long)bits);
    CHECK(bits == LANE_BITS);
    CHECK(tl_lane_exp(0) == 1 && tl_lane_log(1) == 0 && tl_lane_tan(0) == 0 && tl_lane_asinh(0) == 0);
    CHECK(tl_lane_exp(-1e9) == tl_lane_exp(-708) && tl_lane_exp(1e9) == tl_lane_exp(709));
    CHECK(isnan(tl_lane_exp(NAN)) && isnan(tl_lane_log(NAN)) && isnan(tl_lane_tan(NAN)));
    CHECK(isnan(tl_lane_log1p(NAN)) && isnan(tl_lane_asinh(NAN)) && isnan(tl_lane_log(INFINITY)));
}

enum { COLUMN = 4096 };

/* Vectors of whatever width give the bits of numbers one by one. */
TL_VECTORIZED static void fill_columns(const double *restrict x, double (*restrict out)[COLUMN])
{
#pragma omp simd
    for (int i = 0; i < COLUMN; i++) {
        out[0][i] = tl_lane_exp(x[i]);
        out[1][i] = tl_lane_log(1e-3 + fabs(x[i]));
        out[2][i] = tl_lane_log1p(fabs(x[i]));
        out[3][i] = tl_lane_asinh(x[i]);
        out[4][i] = tl_lane_tan(fabs(x[i]) * (1. / 512));
    }
}

TEST(columns_have_the_bits_of_numbers)
{
    static double x[COLUMN], out[5][COLUMN];
    for (int i = 0; i < COLUMN; i++)
        x[i] = 700 * (2 * uniform() - 1);
    fill_columns(x, out);
    for (int i = 0; i < COLUMN; i++) {
        volatile double one = x[i];
        CHECK(out[0][i] == tl_lane_exp(one) && out[1][i] == tl_lane_log(1e-3 + fabs(one)));
        CHECK(out[2][i] == tl_lane_log1p(fabs(one)) && out[3][i] == tl_lane_asinh(one));
        CHECK(out[4][i] == tl_lane_tan(fabs(one) * (1. / 512)));
    }
}

/* Equal, and of the same sign where both are zero. */
static bool same(double a, double b)
{
    return (isnan(a) && isnan(b)) || (a == b && !signbit(a) == !signbit(b));
}

TEST(special_values)
{
    CHECK(same(tl_sin(-0.0), -0.0) && same(tl_tan(-0.0), -0.0) && same(tl_cos(-0.0), 1));
    CHECK(isnan(tl_sin(INFINITY)) && isnan(tl_cos(-INFINITY)) && isnan(tl_tan(NAN)));
    static const double end[] = {-INFINITY, -3, -0.0, 0.0, 3, INFINITY};
    for (size_t i = 0; i < 6; i++)
        for (size_t k = 0; k < 6; k++)
            CHECK(same(tl_atan2(end[i], end[k]), (double)atan2l(end[i], end[k])));
    CHECK(isnan(tl_atan2(NAN, 1)) && isnan(tl_atan2(1, NAN)));
    CHECK(same(tl_atan2(1e-320, 1e308), 0) && tl_atan2(1e308, 1e-320) == TL_PI / 2);
    CHECK(ulps(tl_atan2(5e-324, 1e-323), atan2l(1, 2)) < 1);
    CHECK(isnan(tl_asin(1.01)) && tl_asin(1) == TL_PI / 2 && tl_asin(-1) == -TL_PI / 2);
    CHECK(same(tl_log1p(-1), -INFINITY) && isnan(tl_log1p(-1.5)) && same(tl_log1p(-0.0), -0.0));
    CHECK(same(tl_log1p(INFINITY), INFINITY) && same(tl_log1p(1e-320), 1e-320));
    CHECK(same(tl_expm1(-INFINITY), -1) && same(tl_expm1(1e4), INFINITY) && isnan(tl_expm1(NAN)));
    CHECK(same(tl_expm1(-0.0), -0.0) && same(tl_expm1(-100), -1));
    CHECK(same(tl_cbrt(-0.0), -0.0) && same(tl_cbrt(-INFINITY), -INFINITY) && isnan(tl_cbrt(NAN)));
    for (int i = -300; i <= 300; i++)
        CHECK(tl_cbrt((double)i * i * i) == i);
}

/* Beyond TL_TURNS_EXACT the argument counts modulo 2 pi rounded: still a point of the circle. */
TEST(many_turns)
{
    for (int i = 0; i < 1000; i++) {
        double x = spread(20, 1000), s = tl_sin(x), c = tl_cos(x);
        CHECK(fabs(s * s + c * c - 1) < 1e-15);
    }
}

TEST(degrees)
{
    CHECK(tl_sin_degrees(180) == 0 && tl_cos_degrees(90) == 0);
    CHECK(fabs(tl_cos_degrees(60) - 0.5) < 2e-16);
    CHECK(isnan(tl_sin_degrees(INFINITY)) && isnan(tl_cos_degrees(NAN)));
}

int main(void)
{
    RUN(errors_are_within_their_bounds);
    RUN(bits_are_the_same_everywhere);
    RUN(lanes);
    RUN(columns_have_the_bits_of_numbers);
    RUN(special_values);
    RUN(many_turns);
    RUN(degrees);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
