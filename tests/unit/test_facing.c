/* test_facing.c - facets in the present place: the normal and the overlap of a patch, and directions across a normal. */
#include "check.h"
#include "contact/facing.h"

#define DEGREE (TL_PI / 180)

/* Roundings of a dozen products. */
#define ROUNDINGS 1e-15

static tl_vec3 some_direction(uint64_t *seed)
{
    for (;;) {
        tl_vec3 v = {2 * check_random(seed) - 1, 2 * check_random(seed) - 1, 2 * check_random(seed) - 1};
        if (tl_v3_norm(v) > 0.1 && tl_v3_norm(v) < 1)
            return tl_v3_unit(v);
    }
}

/* Whatever the tilt of two faces, the normal of their patch is a unit vector half-way between theirs. */
TEST(a_patch_has_the_bisector_for_its_normal)
{
    for (double tilt = 0; tilt < 175; tilt += 0.25) {
        double half = 0.5 * tilt * DEGREE;
        tl_vec3 na = {sin(half), 0, cos(half)}, nb = {sin(half), 0, -cos(half)};
        tl_facing to = tl_facing_patch(na, nb, tl_v3(0, 0, 1), 0, 0.5);
        CHECK_NEAR(tl_v3_norm(to.n), 1, ROUNDINGS);
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(to.n, tl_v3(0, 0, 1))), 0, ROUNDINGS);
    }
}

/* The overlap of a point is what it lies under both faces together: of a point on A's face that under B's, of one on B's
 * that under A's. */
TEST(the_overlap_of_a_point_is_what_it_lies_under_both_faces)
{
    uint64_t seed = 3;
    for (int i = 0; i < 1000; i++) {
        tl_vec3 na = some_direction(&seed), aside = tl_v3_scale(0.05, some_direction(&seed));
        tl_vec3 nb = tl_v3_unit(tl_v3_sub(aside, na)), d = some_direction(&seed);
        double ca = check_random(&seed), cb = check_random(&seed); /* B's about its own centroid */
        tl_facing to = tl_facing_patch(na, nb, d, ca + cb, 0.5);
        tl_vec3 x = some_direction(&seed);
        double under_a = ca - tl_v3_dot(na, x), under_b = cb - tl_v3_dot(nb, tl_v3_sub(x, d));
        CHECK_NEAR(to.offset - tl_v3_dot(to.plane, x), under_a + under_b, 4 * ROUNDINGS);
    }
}

/* The overlap of a field contact is the same everywhere. */
TEST(a_field_contact_has_one_overlap)
{
    tl_vec3 n = {0.6, 0, 0.8};
    tl_facing to = tl_facing_field(n, 0.25);
    CHECK(to.n.x == n.x && to.n.y == n.y && to.n.z == n.z);
    CHECK_NEAR(to.offset - tl_v3_dot(to.plane, tl_v3(3, -4, 5)), 0.25, 0);
}

/* A unit vector across any normal, those along the axes and next to them too. */
TEST(there_is_a_direction_across_every_normal)
{
    uint64_t seed = 4;
    for (int i = 0; i < 10000; i++) {
        tl_vec3 n = some_direction(&seed);
        if (i % 4 == 0) {
            double z = i % 8 ? 1 : -1, off = pow(10, -17 * check_random(&seed));
            n = tl_v3_unit(tl_v3_madd(tl_v3(0, 0, z), off, n));
        }
        tl_vec3 aside = tl_facing_aside(n);
        CHECK_NEAR(tl_v3_dot(aside, n), 0, 2 * ROUNDINGS);
        CHECK_NEAR(tl_v3_norm(aside), 1, 2 * ROUNDINGS);
    }
    for (int z = -1; z <= 1; z += 2)
        CHECK(tl_v3_dot(tl_facing_aside(tl_v3(0, 0, z)), tl_v3(0, 0, z)) == 0);
}

TEST_MAIN(RUN(a_patch_has_the_bisector_for_its_normal), RUN(the_overlap_of_a_point_is_what_it_lies_under_both_faces),
          RUN(a_field_contact_has_one_overlap), RUN(there_is_a_direction_across_every_normal))
