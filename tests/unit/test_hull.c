/* test_hull.c - hulls of points: merged faces, exact planes, what is refused and in which words. */
#include "check.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

static tl_error error;

static tl_poly *hull_of(const tl_vec3 *points, size_t count)
{
    tl_poly *p = NULL;
    if (!CHECK_INT(tl_poly_hull(points, count, TL_HULL_OF_CORNERS, &p, &error), TL_OK)) {
        printf("    %s\n", error.text);
        exit(1);
    }
    return p;
}

static void expect_refusal(const tl_vec3 *points, size_t count, const char *sentence)
{
    tl_poly *p = (tl_poly *)&error;
    error = (tl_error){0};
    CHECK_INT(tl_poly_hull(points, count, TL_HULL_OF_CORNERS, &p, &error), TL_E_GEOMETRY);
    CHECK_CONTAINS(error.text, sentence);
    CHECK(p == NULL);
}

static void expect_counts(const tl_poly *p, uint32_t vertices, uint32_t edges, uint32_t faces)
{
    CHECK_INT(p->vertex_count, vertices);
    CHECK_INT(p->edge_count, edges);
    CHECK_INT(p->face_count, faces);
}

/* Corner i of the unit cube in an order that follows no pattern. */
static tl_vec3 corner(int i)
{
    static const int order[8] = {5, 2, 7, 0, 3, 6, 1, 4};
    int k = order[i];
    return tl_v3(k & 1, (k >> 1) & 1, (k >> 2) & 1);
}

static void cube(tl_vec3 points[8])
{
    for (int i = 0; i < 8; i++)
        points[i] = corner(i);
}

TEST(cube_has_six_exact_faces)
{
    tl_vec3 points[8];
    cube(points);
    /* Coordinates that are no binary fractions. */
    for (int i = 0; i < 8; i++)
        points[i] = tl_v3(0.1 + 0.7 * points[i].x, -0.3 + 1.1 * points[i].y, 0.9 * points[i].z);
    tl_poly *p = hull_of(points, 8);
    expect_counts(p, 8, 12, 6);
    CHECK_INT(tl_poly_check(p, 0, &error), TL_OK);
    for (uint32_t f = 0; f < 6; f++) {
        tl_vec3 n = p->plane[f].normal;
        CHECK_INT(tl_poly_face_size(p, f), 4);
        CHECK_INT((n.x != 0) + (n.y != 0) + (n.z != 0), 1);
        CHECK(fabs(n.x + n.y + n.z) == 1);
    }
    for (uint32_t v = 0; v < 8; v++)
        CHECK(memcmp(&p->vertex[v], &points[v], sizeof points[v]) == 0);
    tl_poly_free(p);
}

/* Middles of edges and faces lie on the hull without being corners. */
TEST(points_on_faces_and_edges_are_left_out)
{
    tl_vec3 points[27];
    size_t count = 0;
    for (int i = 0; i < 27; i++)
        if (i != 13)
            points[count++] = tl_v3(0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9));
    tl_poly *p = hull_of(points, count);
    expect_counts(p, 8, 12, 6);
    CHECK_INT(tl_poly_check(p, 0, &error), TL_OK);
    tl_poly_free(p);
}

TEST(repeated_vertices_count_once)
{
    tl_vec3 points[24];
    cube(points);
    for (int i = 0; i < 8; i++) {
        points[8 + i] = points[i];
        points[16 + i] = tl_v3_madd(points[i], 1e-10, tl_v3(1, -2, 3));
    }
    tl_poly *p = hull_of(points, 24);
    expect_counts(p, 8, 12, 6);
    tl_poly_free(p);
}

/* Below the tolerance faces stay whole, above it they break into what the points say. */
TEST(noise_on_the_corners)
{
    uint64_t seed = 3;
    for (int i = 0; i < 2000; i++) {
        double noise = pow(10, -14 + 8 * check_random(&seed));
        tl_vec3 points[8];
        cube(points);
        for (int k = 0; k < 8; k++)
            points[k] =
                tl_v3_add(points[k], tl_v3(noise * (check_random(&seed) - 0.5), noise * (check_random(&seed) - 0.5),
                                           noise * (check_random(&seed) - 0.5)));
        tl_poly *p = hull_of(points, 8);
        CHECK_INT(p->vertex_count, 8);
        if (noise < 5e-7)
            CHECK_INT(p->face_count, 6);
        CHECK_INT(tl_poly_check(p, 2 * TL_POLY_FLAT, &error), TL_OK);
        CHECK_NEAR(tl_poly_mass(p).volume, 1, 6 * noise + 1e-15);
        tl_poly_free(p);
    }
}

/* A prism of regular polygons: sides + 2 faces, volume n/2 sin(2 pi/n) h. */
TEST(drums)
{
    static tl_vec3 points[1000];
    static const int sizes[7] = {3, 4, 6, 17, 64, 200, 500};
    for (int i = 0; i < 7; i++) {
        int n = sizes[i];
        for (int k = 0; k < n; k++) {
            double angle = 2 * TL_PI * k / n + 0.1;
            points[2 * k] = tl_v3(cos(angle), sin(angle), -0.25);
            points[2 * k + 1] = tl_v3(cos(angle), sin(angle), 0.5);
        }
        tl_poly *p = hull_of(points, 2 * (size_t)n);
        expect_counts(p, 2 * (uint32_t)n, 3 * (uint32_t)n, (uint32_t)n + 2);
        CHECK_INT(tl_poly_check(p, 1e-14, &error), TL_OK);
        CHECK_REL(tl_poly_mass(p).volume, 0.5 * n * sin(2 * TL_PI / n) * 0.75, 1e-13);
        tl_poly_free(p);
    }
}

TEST(tetrahedron)
{
    const tl_vec3 points[4] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    tl_poly *p = hull_of(points, 4);
    expect_counts(p, 4, 6, 4);
    CHECK_INT(tl_poly_check(p, 1e-15, &error), TL_OK);
    CHECK_REL(tl_poly_mass(p).volume, 1.0 / 6, 1e-15);
    tl_poly_free(p);
}

/* A plate of 1 / 80 of its side, in the coordinates of a map. */
TEST(thin_plate_far_from_zero)
{
    tl_vec3 points[8];
    cube(points);
    for (int i = 0; i < 8; i++)
        points[i] = tl_v3(1e6 + 10 * points[i].x, -1e6 + 10 * points[i].y, 1e6 + 0.125 * points[i].z);
    tl_poly *p = hull_of(points, 8);
    expect_counts(p, 8, 12, 6);
    CHECK_NEAR(tl_poly_mass(p).volume, 12.5, 1e-13);
    tl_poly_free(p);
}

TEST(point_inside_is_named)
{
    tl_vec3 points[10];
    cube(points);
    points[8] = tl_v3(0.5, 0.5, 0.21);
    expect_refusal(points, 9,
                   "vertex 9 lies 0.21 inside the hull of the others; a block must be convex: leave "
                   "it out or make two blocks of it");
    /* Wherever it stands in the list. */
    tl_vec3 swap = points[2];
    points[2] = points[8];
    points[8] = swap;
    expect_refusal(points, 9, "vertex 3 lies 0.21 inside");
    points[9] = tl_v3(0.5, 0.5, 0.5);
    points[2] = tl_v3(0.5, 0.5, 0);
    expect_refusal(points, 10, "vertex 10 lies 0.5 inside");
}

TEST(flat_and_degenerate_points_are_refused)
{
    tl_vec3 p[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    expect_refusal(p, 3, "3 vertices do not make a block");
    expect_refusal(p, 0, "0 vertices do not make a block");
    expect_refusal(p, 4, "the 4 vertices lie in one plane (thickness 0): a block needs a volume");
    p[2].z = 1e-6;
    expect_refusal(p, 4, "the 4 vertices lie in one plane (thickness ");
    for (int i = 0; i < 4; i++)
        p[i] = tl_v3(i, 2 * i, 3 * i);
    expect_refusal(p, 4, "lie in one plane (thickness 0)");
    for (int i = 0; i < 4; i++)
        p[i] = tl_v3(7, 8, 9);
    expect_refusal(p, 4, "the 4 vertices are one and the same point");
    cube(p);
    for (int i = 0; i < 8; i++)
        p[i].z *= 1e-6;
    /* Measured from a plane through three far corners, so up to twice the least thickness. */
    expect_refusal(p, 8, "the 8 vertices lie in one plane (thickness 2e-06)");
}

TEST(numbers_that_cannot_be_computed_with_are_refused)
{
    tl_vec3 p[8];
    cube(p);
    p[4].y = NAN;
    expect_refusal(p, 8, "the y coordinate of vertex 5 is ");
    p[4].y = 0;
    p[6].z = -INFINITY;
    expect_refusal(p, 8, "the z coordinate of vertex 7 is -inf: it must be a finite number");
    for (int i = 0; i < 8; i++)
        p[i] = tl_v3_scale(1e200, corner(i));
    expect_refusal(p, 8, "use other units");
    for (int i = 0; i < 8; i++)
        p[i] = tl_v3_scale(1e-200, corner(i));
    expect_refusal(p, 8, "use other units");
    expect_refusal(p, TL_POLY_MAX_VERTICES + 1, "4097 vertices: one block can have 4096 at most");
}

/* Points spread over a sphere make twice as many triangles: that limit is met first. */
TEST(many_vertices)
{
    static tl_vec3 points[TL_POLY_MAX_VERTICES];
    for (uint32_t count = 1024; count <= 4096; count *= 4) {
        /* A spiral from pole to pole; of many points some faces at the poles are flat. */
        for (uint32_t i = 0; i < count; i++) {
            double z = 1 - (2 * i + 1.0) / count, r = sqrt(1 - z * z), angle = 2.4 * i;
            points[i] = tl_v3(r * cos(angle), r * sin(angle), z);
        }
        if (count == 4096) {
            expect_refusal(points, count, "the 4096 vertices make 8170 faces: one block can have 4096");
            break;
        }
        tl_poly *p = hull_of(points, count);
        /* half way to the poles some pairs of triangles lie in one plane */
        CHECK_INT(p->vertex_count, count);
        CHECK(p->face_count > 2 * count - 20 && p->face_count <= 2 * count - 4);
        CHECK_INT(tl_poly_check(p, TL_POLY_BENT, &error), TL_OK);
        CHECK_NEAR(tl_poly_mass(p).volume, 4 * TL_PI / 3, 0.03);
        tl_poly_free(p);
    }
}

TEST_MAIN(RUN(cube_has_six_exact_faces), RUN(points_on_faces_and_edges_are_left_out), RUN(repeated_vertices_count_once),
          RUN(noise_on_the_corners), RUN(drums), RUN(tetrahedron), RUN(many_vertices), RUN(thin_plate_far_from_zero),
          RUN(point_inside_is_named), RUN(flat_and_degenerate_points_are_refused),
          RUN(numbers_that_cannot_be_computed_with_are_refused))
