/* test_draws.c - draws by keys: strata of a Latin hypercube, quantiles and functions of distributions against each other, and
 * the interval of Clopper and Pearson against published quantiles of the beta distribution. */
#include "check.h"

#include <talus/distributions.h>
#include <talus/draws.h>

static double draw(uint64_t seed, uint64_t row, const char *name, uint64_t latin)
{
    const tl_draw d = {.seed = seed, .row = row, .name = name, .latin = latin};
    return tl_draw_uniform(&d);
}

TEST(draws_hang_on_their_key_only)
{
    double mean = 0, square = 0, product = 0;
    const int count = 20000;
    for (int i = 1; i <= count; i++) {
        double u = draw(1, (uint64_t)i, "friction", 0), v = draw(1, (uint64_t)i, "cohesion", 0);
        CHECK(u > 0 && u < 1);
        CHECK(u == draw(1, (uint64_t)i, "friction", 0) && u != v && u != draw(2, (uint64_t)i, "friction", 0));
        mean += u / count;
        square += (u - 0.5) * (u - 0.5) / count;
        product += (u - 0.5) * (v - 0.5) / count;
    }
    /* four standard errors: of the mean 0.0020, of the variance 0.0005, of the covariance 0.0006 */
    CHECK_NEAR(mean, 0.5, 0.0082);
    CHECK_NEAR(square, 1. / 12, 0.0022);
    CHECK_NEAR(product, 0, 0.0024);
}

TEST(each_stratum_has_one_row)
{
    static unsigned char seen[5000];
    for (uint64_t n = 1; n <= 5000; n = 3 * n + 1) {
        memset(seen, 0, sizeof seen);
        size_t neighbours = 0, before = 0;
        for (uint64_t row = 1; row <= n; row++) {
            size_t stratum = (size_t)(draw(7, row, "x", n) * (double)n);
            CHECK(stratum < n && !seen[stratum]++);
            neighbours += row > 1 && (stratum == before + 1 || before == stratum + 1);
            before = stratum;
        }
        if (n > 1000)
            CHECK(neighbours < 12); /* 2 are expected, of independent places */
    }
}

TEST(quantiles_invert_the_functions)
{
    /* from tables of the normal distribution */
    CHECK_REL(tl_normal_below(-1.6666666666666667), 0.04779035227281353, 1e-13);
    CHECK_REL(tl_normal_below(-8), 6.220960574271785e-16, 1e-13);
    CHECK_REL(tl_normal_quantile(0.975), 1.959963984540054, 1e-14);
    CHECK_REL(tl_normal_quantile(1e-12), -7.034483825301131, 1e-13);
    for (double u = 1e-9; u < 1; u = u < 0.01 ? 3 * u : u + 0.01) {
        CHECK_REL(tl_normal_below(tl_normal_quantile(u)), u, 1e-12);
        tl_lognormal d = tl_lognormal_of(1.5e4, 5e3);
        CHECK_REL(tl_lognormal_below(d, tl_lognormal_quantile(d, u)), u, 1e-11);
        double r = tl_power_law_quantile(2.5, 1, 20, u);
        CHECK_REL((1 - pow(r, -2.5)) / (1 - pow(20, -2.5)), u, 1e-6);
        double x = tl_triangular_quantile(1, 2, 5, u);
        CHECK_NEAR(x < 2 ? (x - 1) * (x - 1) / 4 : 1 - (5 - x) * (5 - x) / 12, u, 1e-14);
    }
    CHECK(isinf(tl_normal_quantile(0)) && isinf(tl_normal_quantile(1)));
    /* the power law's moments: closed forms, a = j among them */
    CHECK_REL(tl_power_law_moment(2.5, 1, 20, 1), 1.64895456048, 1e-11);
    CHECK_REL(tl_power_law_moment(2.5, 1, 20, 2), 3.88413731001, 1e-11);
    CHECK_REL(tl_power_law_moment(2, 1, 10, 2), 4.65168705655, 1e-11);
    CHECK_REL(tl_power_law_moment(3, 0.5, 50, 2), 0.742500742501, 1e-11);
    CHECK_REL(tl_power_law_moment(3, 2, 2, 2), 4.0, 1e-15);
}

TEST(directions_give_their_attitude)
{
    for (double dip = 0; dip <= 90; dip += 7.5)
        for (double direction = 0; direction < 360; direction += 22.5) {
            double d, dd;
            tl_plane_attitude(tl_plane_normal(dip, direction), &d, &dd);
            CHECK_NEAR(d, dip, 1e-13);
            CHECK(dip == 0 || fabs(dd - direction) < 1e-11 || dip == 90);
            /* around the mean, at the angle that the law gives: 1 - cos t = -ln(1 - u (1 - exp(-2 k))) / k */
            tl_vec3 n = tl_plane_normal(dip, direction), v = tl_fisher_direction(n, 20, 0.5, direction / 360);
            CHECK_NEAR(tl_v3_dot(n, v), cos(15.128563802 * 3.141592653589793 / 180), 1e-10);
        }
}

TEST(intervals_are_those_of_clopper_and_pearson)
{
    /* scipy.stats.beta.ppf */
    static const double cases[][4] = {{0, 100, 0, 0.0362166926452},
                                      {3, 200, 0.00310410762155, 0.0432082819177},
                                      {50, 1000, 0.0373353976047, 0.0653904879155},
                                      {120, 10000, 0.00995893343186, 0.0143321689906}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double low, high;
        uint64_t hits = (uint64_t)cases[i][0], count = (uint64_t)cases[i][1];
        tl_binomial_interval(hits, count, 0.95, &low, &high);
        CHECK_NEAR(low, cases[i][2], 1e-12);
        CHECK_NEAR(high, cases[i][3], 1e-12);
        double from, to; /* of what does not hit */
        tl_binomial_interval(count - hits, count, 0.95, &from, &to);
        CHECK_NEAR(from, 1 - high, 1e-12);
        CHECK_NEAR(to, 1 - low, 1e-12);
    }
    double low, high;
    tl_binomial_interval(0, 0, 0.95, &low, &high);
    CHECK(low == 0 && high == 1);
    /* one trial: a hit has the probability p itself */
    tl_binomial_interval(1, 1, 0.95, &low, &high);
    CHECK_NEAR(low, 0.025, 1e-14);
    tl_binomial_interval(500000, 1000000, 0.95, &low, &high);
    CHECK_NEAR(high - low, 2 * 1.96 * 0.0005, 2e-6);
}

TEST_MAIN(RUN(draws_hang_on_their_key_only), RUN(each_stratum_has_one_row), RUN(quantiles_invert_the_functions),
          RUN(directions_give_their_attitude), RUN(intervals_are_those_of_clopper_and_pearson))
