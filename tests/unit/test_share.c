/* test_share.c - the share of a patch in what two blocks press with: all of it where it has the energy of the field, none where it is a
 * sliver of next to nothing, and between them with its gradient. */
#include "check.h"

#include "narrow/press.h"

#include <talus/vmath.h>

static const tl_vec3 up = {0, 0, 1}, down = {0, 0, -1};

/* Sums of an overlap o over an area that grow with x at the rates given: minus the gradients are along x. */
static tl_field_sums sums_at(double area, double by_area, double overlap, double by_overlap, double x)
{
    double a = area + by_area * x, o = overlap + by_overlap * x;
    return (tl_field_sums){
        .energy = 0.25 * a * o * o,
        .volume = a * o,
        .force = {-0.25 * (by_area * o * o + 2 * a * o * by_overlap), 0, 0},
        .swept = {-(by_area * o + a * by_overlap), 0, 0},
    };
}

static tl_patch_share share_at(double part, double overlap, double x)
{
    const tl_field_sums patch = sums_at(1, 0.7, overlap, 0.3 * overlap, x);
    const tl_field_sums field = sums_at(1 / part, 0.2 / part, overlap, -0.4 * overlap, x);
    return tl_patch_share_of(&up, &down, false, 0, &patch, &field);
}

TEST(a_patch_that_is_the_field_is_all_of_it)
{
    for (double part = 0.6; part < 3; part += 0.3) {
        tl_patch_share s = share_at(part, 1e-3, 0);
        CHECK(s.share == 1 && tl_v3_norm(s.push) == 0);
    }
}

TEST(a_sliver_is_none)
{
    for (double part = 0.09; part > 1e-13; part *= 0.1) {
        tl_patch_share s = share_at(part, 6e-3, 0);
        CHECK(s.share == 0 && tl_v3_norm(s.push) == 0);
    }
}

TEST(between_them_the_gradient_is_that_of_the_share)
{
    const double h = 1e-6;
    for (double part = 0.12; part < 0.5; part += 0.05)
        for (double overlap = 1e-3; overlap < 0.01; overlap += 2e-3) {
            tl_patch_share s = share_at(part, overlap, 0);
            double more = share_at(part, overlap, h).share, less = share_at(part, overlap, -h).share;
            CHECK(s.share > 0 && s.share < 1);
            CHECK_NEAR(s.push.x, (more - less) / (2 * h), 1e-7);
        }
}

TEST_MAIN(RUN(a_patch_that_is_the_field_is_all_of_it), RUN(a_sliver_is_none),
          RUN(between_them_the_gradient_is_that_of_the_share))
