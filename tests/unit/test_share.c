/* test_share.c - the share of a patch in what two blocks press with: all of it where it has the energy of the field, none where it is a
 * sliver of next to nothing, and between them with its gradient. */
#include "check.h"

#include "narrow/flush.h"
#include "narrow/share.h"

#include <math.h>
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

/* Sums of springs at four corners, whose overlaps go with x at the rates given. A corner that is open has none. */
static tl_field_sums corners_at(double first, double x)
{
    const double overlap[4] = {0.12, 0.09, 0.05, first}, rate[4] = {0.3, -0.2, 0.1, 0.5};
    tl_field_sums out = {.energy = 0};
    for (int k = 0; k < 4; k++) {
        const double area = 0.2 + 0.03 * k, o = overlap[k] + rate[k] * x;
        if (!(o > 0))
            continue;
        out.energy += 0.25 * area * o * o;
        out.volume += area * o;
        out.powers[0].whole += area * o * o * o / 12;
        out.force.x -= 0.5 * area * o * rate[k];
        out.swept.x -= area * rate[k];
        out.powers[0].force.x -= 0.25 * area * o * o * rate[k];
    }
    return out;
}

static tl_patch_share corner_share_at(double first, double shift, double x)
{
    const tl_field_sums patch = corners_at(first, x);
    tl_field_sums field = patch;
    field.energy *= 1.2;
    field.force.x *= 1.2;
    return tl_patch_share_of(&up, &down, true, shift, &patch, &field);
}

TEST(of_springs_at_corners_it_has_no_kink_where_one_parts)
{
    const double h = 1e-7;
    for (double shift = 0; shift < 0.02; shift += 0.008) {
        tl_patch_share closed = corner_share_at(1e-9, shift, 0), open = corner_share_at(-1e-9, shift, 0);
        CHECK(closed.share > 0 && closed.share < 1 && fabs(closed.push.x) > 0.1);
        CHECK_NEAR(closed.push.x, open.push.x, 1e-6);
        for (double first = -0.02; first < 0.05; first += 0.02) {
            double more = corner_share_at(first, shift, h).share, less = corner_share_at(first, shift, -h).share;
            CHECK_NEAR(corner_share_at(first, shift, 0).push.x, (more - less) / (2 * h), 1e-5);
        }
    }
}

TEST(of_an_even_overlap_corners_count_as_a_patch_does)
{
    const double area = 0.7, o = 0.12, depth = o / sqrt(area);
    const tl_field_sums patch = {
        .energy = 0.25 * area * o * o, .volume = area * o, .powers = {{.whole = area * o * o * o / 12}}};
    const double t = (depth - TL_CORNERS_DEPTH) / (TL_CORNERS_FIELD_DEPTH - TL_CORNERS_DEPTH);
    tl_patch_share s = tl_patch_share_of(&up, &down, true, 0, &patch, &patch);
    CHECK_NEAR(s.share, 1 - t * t * (3 - 2 * t), 1e-12);
}

TEST_MAIN(RUN(a_patch_that_is_the_field_is_all_of_it), RUN(a_sliver_is_none),
          RUN(between_them_the_gradient_is_that_of_the_share),
          RUN(of_springs_at_corners_it_has_no_kink_where_one_parts),
          RUN(of_an_even_overlap_corners_count_as_a_patch_does))
