/* test_measure.c - volumes, centroids and inertia tensors against exact values, and the other
 * measures against what can be seen by eye. */
#include "check.h"
#include "data/mass_cases.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

/* The sums have about a hundred terms of alternating sign. */
#define MASS_TOLERANCE 1e-13

static tl_poly *hull_of(const tl_vec3 *points, size_t count)
{
    tl_error error = {0};
    tl_poly *p = NULL;
    if (!CHECK_INT(tl_poly_hull(points, count, TL_HULL_OF_CORNERS, &p, &error), TL_OK)) {
        printf("    %s\n", error.text);
        exit(1);
    }
    return p;
}

static tl_poly *unit_box(void)
{
    tl_error error;
    tl_poly *p = NULL;
    if (!CHECK_INT(tl_poly_box(tl_v3(0, 0, 0), tl_v3(1, 2, 3), &p, &error), TL_OK))
        exit(1);
    return p;
}

static void check_tensor(tl_sym3 a, tl_sym3 b, double tolerance)
{
    CHECK_NEAR(a.xx, b.xx, tolerance);
    CHECK_NEAR(a.yy, b.yy, tolerance);
    CHECK_NEAR(a.zz, b.zz, tolerance);
    CHECK_NEAR(a.xy, b.xy, tolerance);
    CHECK_NEAR(a.yz, b.yz, tolerance);
    CHECK_NEAR(a.zx, b.zx, tolerance);
}

TEST(mass_of_exact_cases)
{
    for (size_t i = 0; i < sizeof mass_cases / sizeof *mass_cases; i++) {
        const mass_case *m = &mass_cases[i];
        tl_poly *p = hull_of(m->vertex, m->vertices);
        CHECK_INT(p->vertex_count, m->vertices);
        CHECK_INT(p->edge_count, m->edges);
        CHECK_INT(p->face_count, m->faces);
        tl_mass mass = tl_poly_mass(p);
        double trace = m->inertia.xx + m->inertia.yy + m->inertia.zz;
        CHECK_REL(mass.volume, m->volume, MASS_TOLERANCE);
        CHECK_NEAR(mass.centroid.x, m->centroid.x, MASS_TOLERANCE * p->size);
        CHECK_NEAR(mass.centroid.y, m->centroid.y, MASS_TOLERANCE * p->size);
        CHECK_NEAR(mass.centroid.z, m->centroid.z, MASS_TOLERANCE * p->size);
        check_tensor(mass.inertia, m->inertia, MASS_TOLERANCE * trace);
        tl_vec3 moments;
        tl_quat axes;
        tl_principal_axes(mass.inertia, &moments, &axes);
        CHECK_REL(moments.x, m->principal[0], MASS_TOLERANCE);
        CHECK_REL(moments.y, m->principal[1], MASS_TOLERANCE);
        CHECK_REL(moments.z, m->principal[2], MASS_TOLERANCE);
        double radius = 0;
        for (uint32_t v = 0; v < p->vertex_count; v++)
            radius += tl_v3_norm(tl_v3_sub(p->vertex[v], mass.centroid));
        CHECK_REL(radius / p->vertex_count, m->mean_radius, MASS_TOLERANCE);
        tl_poly_free(p);
    }
}

/* Inertia is about the centroid, so a translation by a power of two far larger than the body, which
 * leaves these coordinates exact, changes nothing but the centroid. */
TEST(mass_far_from_zero)
{
    const double far = 1048576;
    for (size_t i = 0; i < sizeof mass_cases / sizeof *mass_cases; i++) {
        const mass_case *m = &mass_cases[i];
        tl_poly *p = hull_of(m->vertex, m->vertices), *q = NULL;
        tl_error error;
        CHECK_INT(tl_poly_transformed(p, NULL, tl_v3(far, -far, far), &q, &error), TL_OK);
        tl_mass here = tl_poly_mass(p), there = tl_poly_mass(q);
        CHECK_NEAR(there.volume, here.volume, 0);
        check_tensor(there.inertia, here.inertia, 0);
        CHECK_NEAR(there.centroid.x, here.centroid.x + far, 1e-15 * far);
        tl_poly_free(p);
        tl_poly_free(q);
    }
}

/* Products of inertia carry the minus sign of the tensor: turning the body turns the tensor. */
/* A skew needle of integer corners: the edges have determinant n n - (n + 1)(n - 1) = 1, of products that
 * do not fit into a double. */
TEST(volume_of_a_needle_keeps_all_digits)
{
    const double n = 1073741824;
    const tl_vec3 edge[3] = {{n, n + 1, 0}, {n - 1, n, 0}, {0, 0, 1}};
    tl_poly *box = unit_box();
    uint32_t start[7];
    for (int f = 0; f < 7; f++)
        start[f] = box->start[f];
    for (int far = 0; far < 2; far++) {
        tl_vec3 x[8];
        for (int i = 0; i < 8; i++) {
            x[i] = tl_v3(far * 1e12, 0, far * -1e12);
            for (int k = 0; k < 3; k++)
                x[i] = i >> k & 1 ? tl_v3_add(x[i], edge[k]) : x[i];
        }
        tl_poly *p;
        tl_error error;
        if (!CHECK_INT(tl_poly_make(x, 8, box->plane, NULL, start, box->loop, 6, &p, &error), TL_OK))
            continue;
        CHECK_NEAR(tl_poly_mass(p).volume, 1, 1e-15);
        tl_poly_free(p);
    }
    tl_poly_free(box);
}

TEST(inertia_turns_with_the_body)
{
    tl_quat turn = tl_q_unit((tl_quat){0.7, 0.3, -0.5, 0.2});
    tl_mat3 r = tl_q_matrix(turn);
    tl_poly *p = hull_of(mass_cases[3].vertex, mass_cases[3].vertices), *q = NULL;
    tl_error error;
    CHECK_INT(tl_poly_transformed(p, &r, tl_v3(1, 2, 3), &q, &error), TL_OK);
    tl_mass before = tl_poly_mass(p), after = tl_poly_mass(q);
    const tl_vec3 probes[2] = {{1, 2, 3}, {-2, 1, 0.5}};
    for (int i = 0; i < 2; i++) {
        tl_vec3 want = tl_m3_mul(&r, tl_s3_mul(before.inertia, probes[i]));
        tl_vec3 have = tl_s3_mul(after.inertia, tl_m3_mul(&r, probes[i]));
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(want, have)), 0, 1e-13 * tl_v3_norm(want));
    }
    tl_poly_free(p);
    tl_poly_free(q);
}

TEST(faces_and_edges)
{
    tl_poly *p = unit_box();
    static const double area[6] = {6, 6, 3, 3, 2, 2};
    static const tl_vec3 centre[6] = {{0, 1, 1.5}, {1, 1, 1.5}, {0.5, 0, 1.5}, {0.5, 2, 1.5}, {0.5, 1, 0}, {0.5, 1, 3}};
    for (uint32_t f = 0; f < 6; f++) {
        CHECK_NEAR(tl_poly_face_area(p, f), area[f], 0);
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(tl_poly_face_centroid(p, f), centre[f])), 0, 1e-15);
    }
    CHECK_NEAR(tl_poly_shortest_edge(p), 1, 0);
    CHECK_NEAR(p->size, sqrt(14.0), 1e-15);
    tl_bounds bounds = tl_poly_bounds(p);
    CHECK(bounds.min.x == 0 && bounds.min.y == 0 && bounds.min.z == 0);
    CHECK(bounds.max.x == 1 && bounds.max.y == 2 && bounds.max.z == 3);
    tl_poly_free(p);
}

/* The area centroid of a pentagon is not the mean of its vertices. */
TEST(centroid_of_a_face_is_that_of_its_area)
{
    const tl_vec3 points[10] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 3, 0}, {0, 2, 0},
                                {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {1, 3, 1}, {0, 2, 1}};
    tl_poly *p = hull_of(points, 10);
    for (uint32_t f = 0; f < p->face_count; f++) {
        if (fabs(p->plane[f].normal.z) < 0.5)
            continue;
        tl_vec3 c = tl_poly_face_centroid(p, f);
        /* A square of 4 at height 1 and a triangle of 1 at height 7/3. */
        CHECK_NEAR(tl_poly_face_area(p, f), 5, 1e-15);
        CHECK_NEAR(c.x, 1, 1e-15);
        CHECK_NEAR(c.y, (4 * 1 + 7.0 / 3) / 5, 1e-15);
    }
    tl_poly_free(p);
}

TEST(contains_up_to_the_tolerance)
{
    tl_poly *p = unit_box();
    CHECK(tl_poly_contains(p, tl_v3(0.5, 1, 1), 0));
    CHECK(tl_poly_contains(p, tl_v3(1, 2, 3), 0));
    CHECK(tl_poly_contains(p, tl_v3(0.5, 1, 3.01), 0.011));
    CHECK(!tl_poly_contains(p, tl_v3(0.5, 1, 3.01), 0.009));
    CHECK(!tl_poly_contains(p, tl_v3(0.5, 1, 2.99), -0.011));
    CHECK(!tl_poly_contains(p, tl_v3(NAN, 1, 1), 1));
    tl_poly_free(p);
}

TEST_MAIN(RUN(mass_of_exact_cases), RUN(mass_far_from_zero), RUN(volume_of_a_needle_keeps_all_digits),
          RUN(inertia_turns_with_the_body), RUN(faces_and_edges), RUN(centroid_of_a_face_is_that_of_its_area),
          RUN(contains_up_to_the_tolerance))
