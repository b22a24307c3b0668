/* hull_properties.c - hulls of seeded random points against volumes found in other ways, and the
 * properties every hull has. */
#include "check.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

static uint64_t seed = 77;
static tl_error error;

static double uniform(double low, double high)
{
    return low + (high - low) * check_random(&seed);
}

static tl_vec3 direction(void)
{
    for (;;) {
        tl_vec3 v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        double n = tl_v3_norm(v);
        if (n > 0.1 && n <= 1)
            return tl_v3_unit(v);
    }
}

static tl_mat3 random_rotation(void)
{
    tl_quat q = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
    return tl_q_matrix(tl_q_unit(q));
}

static void shuffle(tl_vec3 *points, size_t count)
{
    for (size_t i = count - 1; i > 0; i--) {
        size_t j = (size_t)(check_random(&seed) * (double)(i + 1));
        tl_vec3 swap = points[i];
        points[i] = points[j];
        points[j] = swap;
    }
}

/* Hull of the hull's vertices: the same vertices, faces and planes to the bit. */
static int is_its_own_hull(const tl_poly *p)
{
    tl_poly *q = NULL;
    if (tl_poly_hull(p->vertex, p->vertex_count, TL_HULL_OF_CORNERS, &q, &error))
        return 0;
    int same = q->vertex_count == p->vertex_count && q->face_count == p->face_count && q->edge_count == p->edge_count &&
               !memcmp(p->vertex, q->vertex, p->vertex_count * sizeof *p->vertex) &&
               !memcmp(p->loop, q->loop, 2 * p->edge_count * sizeof *p->loop) &&
               !memcmp(p->start, q->start, (p->face_count + 1) * sizeof *p->start) &&
               !memcmp(p->plane, q->plane, p->face_count * sizeof *p->plane);
    tl_poly_free(q);
    return same;
}

/* A hull of all these points, checked; NULL when it could not be made. */
static tl_poly *checked_hull(const tl_vec3 *points, size_t count, double tolerance)
{
    tl_poly *p = NULL;
    if (!CHECK_INT(tl_poly_hull(points, count, TL_HULL_OF_CORNERS, &p, &error), TL_OK) ||
        !CHECK_INT(tl_poly_check(p, tolerance, &error), TL_OK)) {
        printf("    %zu points: %s\n", count, error.text);
        return p;
    }
    CHECK(is_its_own_hull(p));
    for (size_t i = 0; i < count; i++)
        CHECK(tl_poly_contains(p, points[i], tolerance * p->size));
    return p;
}

/* The volume of the hull of points in general position: every three of them with all others on one
 * side span a face. `gap` is the least distance of another point from a face's plane. */
static double brute_force_volume(const tl_vec3 *x, int count, int *faces, double *gap)
{
    double six = 0;
    *faces = 0;
    *gap = INFINITY;
    tl_vec3 middle = {0, 0, 0};
    for (int i = 0; i < count; i++)
        middle = tl_v3_madd(middle, 1.0 / count, x[i]);
    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++)
            for (int k = j + 1; k < count; k++) {
                tl_vec3 n = tl_v3_cross(tl_v3_sub(x[j], x[i]), tl_v3_sub(x[k], x[i]));
                int over = 0, under = 0;
                double least = INFINITY;
                for (int m = 0; m < count; m++)
                    if (m != i && m != j && m != k) {
                        double height = tl_v3_dot(n, tl_v3_sub(x[m], x[i]));
                        over += height > 0;
                        under += height < 0;
                        least = fmin(least, fabs(height));
                    }
                if (over && under)
                    continue;
                six += fabs(tl_v3_dot(n, tl_v3_sub(x[i], middle)));
                ++*faces;
                *gap = fmin(*gap, least / tl_v3_norm(n));
            }
    return six / 6;
}

TEST(points_on_an_ellipsoid)
{
    tl_vec3 x[24];
    int used = 0;
    for (int i = 0; i < 1500; i++) {
        int n = 4 + (int)(check_random(&seed) * 21), faces;
        tl_vec3 axes = {uniform(0.3, 3), uniform(0.3, 3), uniform(0.3, 3)};
        tl_vec3 shift = {uniform(-9, 9), uniform(-9, 9), uniform(-9, 9)};
        for (int k = 0; k < n; k++) {
            tl_vec3 d = direction();
            x[k] = tl_v3_add(shift, tl_v3(axes.x * d.x, axes.y * d.y, axes.z * d.z));
        }
        double gap, volume = brute_force_volume(x, n, &faces, &gap);
        /* Four points may happen to be nearly flat, which makes them one face or no block: one that misses the plane of
         * three by g misses a plane fitted to all of them by g/4 or more. */
        if (gap < 4 * 0.5 * TL_POLY_BENT * 2 * tl_v3_norm(axes))
            continue;
        used++;
        tl_poly *p = checked_hull(x, (size_t)n, 1e-13);
        CHECK_INT(p->vertex_count, n);
        CHECK_INT(p->face_count, faces);
        CHECK_NEAR(tl_poly_mass(p).volume, volume, 1e-12 * p->size * p->size * p->size);
        tl_poly_free(p);
    }
    CHECK(used > 1000);
}

/* Rotated bricks with points on their faces and edges, anywhere: still six quadrilaterals. */
TEST(rotated_bricks)
{
    tl_vec3 x[27];
    for (int i = 0; i < 3000; i++) {
        tl_vec3 side = {uniform(0.2, 4), uniform(0.2, 4), uniform(0.2, 4)};
        double far = i % 2 ? 1e6 : 1;
        tl_vec3 at = {far * uniform(-1, 1), far * uniform(-1, 1), far * uniform(-1, 1)};
        tl_mat3 r = random_rotation();
        size_t n = 0;
        for (int k = 0; k < 27; k++) {
            int corner = k % 3 != 1 && k / 3 % 3 != 1 && k / 9 != 1;
            if (k == 13 || (!corner && check_random(&seed) < 0.5))
                continue;
            tl_vec3 local = {0.5 * (k % 3) * side.x, 0.5 * (k / 3 % 3) * side.y, 0.5 * (k / 9) * side.z};
            x[n++] = tl_v3_add(at, tl_m3_mul(&r, local));
        }
        shuffle(x, n);
        tl_poly *p = checked_hull(x, n, 2 * TL_POLY_ON);
        CHECK_INT(p->vertex_count, 8);
        CHECK_INT(p->face_count, 6);
        double volume = side.x * side.y * side.z, surface = 6 * p->size * p->size;
        CHECK_NEAR(tl_poly_mass(p).volume, volume, 1e-14 * volume + 2e-16 * far * surface);
        tl_poly_free(p);
    }
}

/* Frusta over points on a circle in random places: many points of one plane, on one circle. */
TEST(rotated_drums)
{
    tl_vec3 x[128];
    for (int i = 0; i < 600; i++) {
        int n = 3 + (int)(check_random(&seed) * 62);
        double radius = uniform(0.5, 2), taper = i % 2 ? uniform(0.3, 1) : 1;
        double height = uniform(0.2, 3), angle = 0, area2 = 0;
        tl_mat3 r = random_rotation();
        double step[64], sum = 0;
        for (int k = 0; k < n; k++)
            sum += step[k] = uniform(0.3, 1);
        for (int k = 0; k < n; k++) {
            tl_vec3 d = {cos(angle), sin(angle), 0};
            x[2 * k] = tl_m3_mul(&r, tl_v3_scale(radius, d));
            x[2 * k + 1] = tl_m3_mul(&r, tl_v3_madd(tl_v3(0, 0, height), taper * radius, d));
            angle += 2 * TL_PI * step[k] / sum;
            area2 += radius * radius * sin(2 * TL_PI * step[k] / sum);
        }
        shuffle(x, 2 * (size_t)n);
        tl_poly *p = checked_hull(x, 2 * (size_t)n, 1e-13);
        CHECK_INT(p->vertex_count, 2 * n);
        CHECK_INT(p->face_count, n + 2);
        double volume = height * 0.5 * area2 * (1 + taper + taper * taper) / 3;
        CHECK_REL(tl_poly_mass(p).volume, volume, 1e-13);
        tl_poly_free(p);
    }
}

/* Points of a coarse lattice, so that nearly all are coplanar or collinear with others. Points
 * inside are refused by name; without them the hull stands, and moving every point by noise of any
 * size leaves a sound hull or a refusal. */
TEST(lattice_points)
{
    int made = 0, named = 0;
    for (int i = 0; i < 4000; i++) {
        tl_vec3 x[40];
        size_t n = 4 + (size_t)(check_random(&seed) * 30);
        double noise = i % 2 ? pow(10, uniform(-14, -5)) : 0;
        for (size_t k = 0; k < n; k++)
            x[k] = tl_v3(floor(uniform(0, 4)) + noise * uniform(-1, 1), floor(uniform(0, 4)) + noise * uniform(-1, 1),
                         floor(uniform(0, 4)) + noise * uniform(-1, 1));
        tl_poly *p = NULL;
        size_t vertex = 0;
        while (tl_poly_hull(x, n, TL_HULL_OF_CORNERS, &p, &error)) {
            CHECK(p == NULL);
            const char *at = strstr(error.text, "vertex ");
            if (!at || !strstr(error.text, "inside the hull"))
                break;
            vertex = (size_t)strtoul(at + 7, NULL, 10);
            if (!CHECK(vertex >= 1 && vertex <= n))
                break;
            x[vertex - 1] = x[--n];
            named++;
        }
        if (!p) {
            CHECK_CONTAINS(error.text, n < 4 ? "vertices do not make a block" : "vertices");
            continue;
        }
        made++;
        double slack = noise > 0 ? TL_POLY_BENT : TL_POLY_ON;
        CHECK_INT(tl_poly_check(p, slack, &error), TL_OK);
        for (size_t k = 0; k < n; k++)
            CHECK(tl_poly_contains(p, x[k], slack * p->size));
        /* The volume of a lattice polyhedron is a multiple of 1 / 6. */
        double six = 6 * tl_poly_mass(p).volume;
        if (noise == 0)
            CHECK_NEAR(six, floor(six + 0.5), 1e-12);
        tl_poly_free(p);
    }
    CHECK(made > 3000 && named > 1000);
}

/* Boxes, wedges and tetrahedra, thick or thin, with points strewn along their edges and diagonals,
 * some of them 1e-8 from a corner, and noise about as large as the tolerance: the worst input for
 * merging. Either the set is too flat, or what comes out is sound; small faces of such noise have
 * ill-defined planes, which sets the tolerance. */
TEST(noise_as_large_as_the_tolerance)
{
    int made = 0, flat = 0;
    for (int i = 0; i < 20000; i++) {
        tl_vec3 base[8], x[40];
        size_t corners = i % 3 == 0 ? 8 : i % 3 == 1 ? 6 : 4;
        double thickness = pow(10, uniform(-4, 0)), noise = pow(10, uniform(-13, -6));
        for (size_t k = 0; k < corners; k++) {
            double u = (double)(k & 1), v = (double)(k >> 1 & 1);
            if (corners == 8)
                base[k] = tl_v3(u, v, thickness * (double)(k >> 2));
            else if (corners == 6)
                base[k] = k < 4 ? tl_v3(u, v, 0) : tl_v3(0, u, thickness);
            else
                base[k] = tl_v3(uniform(-1, 1), uniform(-1, 1), thickness * uniform(-1, 1));
        }
        size_t n = corners + (size_t)uniform(0, 30);
        tl_mat3 r = random_rotation();
        for (size_t k = 0; k < n; k++) {
            tl_vec3 a = base[k < corners ? k : (size_t)uniform(0, (double)corners)];
            tl_vec3 b = k < corners ? a : base[(size_t)uniform(0, (double)corners)];
            double along = check_random(&seed) < 0.3 ? uniform(0, 1e-8) : uniform(0, 1);
            tl_vec3 jitter = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            x[k] = tl_m3_mul(&r, tl_v3_madd(tl_v3_madd(a, along, tl_v3_sub(b, a)), noise, jitter));
        }
        tl_poly *p = NULL;
        while (tl_poly_hull(x, n, TL_HULL_OF_CORNERS, &p, &error)) {
            const char *at = strstr(error.text, "vertex ");
            if (!at || !strstr(error.text, "inside the hull"))
                break;
            x[strtoul(at + 7, NULL, 10) - 1] = x[n - 1];
            n--;
        }
        if (!p) {
            CHECK_CONTAINS(error.text, "lie in one plane");
            flat++;
            continue;
        }
        made++;
        CHECK_INT(tl_poly_check(p, 4 * TL_POLY_FLAT, &error), TL_OK);
        for (size_t k = 0; k < n; k++)
            CHECK(tl_poly_contains(p, x[k], 2 * TL_POLY_FLAT * p->size));
        tl_poly_free(p);
    }
    CHECK(made > 15000 && flat < 1000);
}

TEST_MAIN(RUN(points_on_an_ellipsoid), RUN(rotated_bricks), RUN(rotated_drums), RUN(lattice_points),
          RUN(noise_as_large_as_the_tolerance))
