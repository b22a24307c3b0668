/* test_facing.c - normals of points and of crossing edges. */
#include "check.h"
#include "contact/facing.h"

#define DEGREE (TL_PI / 180)

/* Roundings of a dozen products. */
#define ROUNDINGS 1e-15

/* Every normal of two tilted faces is a unit vector, and that along the faces' own where a point leans fully. */
TEST(points_lean_to_unit_normals)
{
    for (double tilt = 0; tilt < 15.01; tilt += 0.25) {
        double half = 0.5 * tilt * DEGREE;
        tl_vec3 na = {sin(half), 0, cos(half)}, nb = {sin(half), 0, -cos(half)};
        tl_facing to = tl_facing_patch(na, nb, tl_v3(0, 0, 1), 0);
        CHECK_NEAR(tl_v3_norm(to.n), 1, ROUNDINGS);
        tl_vec3 across = tl_v3_cross(to.mean, to.lean);
        for (double face = -1; face <= 1; face += 0.125)
            for (double edge = -2; edge <= 2; edge += 0.25) {
                tl_vec3 n = tl_leaning(to.mean, to.lean, across, to.mean2, to.l2, face, edge);
                CHECK_NEAR(tl_v3_norm(n), 1, 2 * ROUNDINGS);
            }
        tl_vec3 up = tl_leaning(to.mean, to.lean, across, to.mean2, to.l2, 1, 0);
        tl_vec3 down = tl_leaning(to.mean, to.lean, across, to.mean2, to.l2, -1, 0);
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(up, na)), 0, 2 * ROUNDINGS);
        CHECK_NEAR(tl_v3_norm(tl_v3_add(down, nb)), 0, 2 * ROUNDINGS);
    }
    CHECK(tl_unit_scale(0) == 1);
}

/* Perpendicular to both edges however they cross, on the side asked for. */
TEST(crossing_edges_have_a_normal)
{
    tl_vec3 a = {3, 0.5, -1}, aside = tl_v3_unit(tl_v3_cross(a, tl_v3(0.2, 1, 0.7)));
    for (double angle = 1.5; angle > 1e-9; angle *= 0.3)
        for (int sign = -1; sign <= 1; sign += 2) {
            tl_vec3 b = tl_v3_add(tl_v3_scale(0.2 * cos(angle), a), tl_v3_scale(sin(angle), aside));
            tl_vec3 side = tl_v3_scale(sign, tl_v3_cross(a, aside));
            tl_vec3 n = tl_facing_edges(a, b, side);
            CHECK_NEAR(tl_v3_norm(n), 1, ROUNDINGS);
            CHECK_NEAR(tl_v3_dot(n, tl_v3_unit(a)), 0, ROUNDINGS);
            CHECK_NEAR(tl_v3_dot(n, tl_v3_unit(b)), 0, ROUNDINGS);
            CHECK(tl_v3_dot(n, side) > 0);
        }
}

TEST(parallel_edges_take_the_side)
{
    tl_vec3 a = {1, 2, 3}, side = {0, 0.6, 0.8};
    tl_vec3 n = tl_facing_edges(a, tl_v3_scale(-2, a), side);
    CHECK(n.x == side.x && n.y == side.y && n.z == side.z);
}

TEST_MAIN(RUN(points_lean_to_unit_normals), RUN(crossing_edges_have_a_normal),
          RUN(parallel_edges_take_the_side))
