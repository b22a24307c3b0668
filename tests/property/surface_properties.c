/* surface_properties.c - the polygons on which two blocks press each other, of random pairs: their area, middle and pressure are
 * those that the kernel integrates over the field, and a patch has the area of its contact points. */
#include "contact_scene.h"
#include "narrow/field.h"
#include "narrow/patch.h"
#include "narrow/surface.h"

/* Sums over polygons. */
typedef struct sums {
    double area, pressure;
    tl_vec3 first;
} sums;

static double depth_in(const tl_poly *a, tl_vec3 x)
{
    double depth = INFINITY;
    for (uint32_t f = 0; f < a->face_count; f++)
        depth = fmin(depth, a->plane[f].offset - tl_v3_dot(a->plane[f].normal, x));
    return depth;
}

/* Depths are linear over a polygon, so a triangle has the mean of its corners. */
static sums sums_of(const tl_surface *s, const tl_poly *a)
{
    sums out = {0};
    const tl_vec3 *x = s->corner;
    for (size_t p = 0; p < s->polygons; x += s->size[p++])
        for (size_t i = 1; i + 1 < s->size[p]; i++) {
            double area = 0.5 * tl_v3_norm(tl_v3_cross(tl_v3_sub(x[i], x[0]), tl_v3_sub(x[i + 1], x[0])));
            tl_vec3 sum = tl_v3_add(x[0], tl_v3_add(x[i], x[i + 1]));
            out.area += area;
            out.first = tl_v3_madd(out.first, area / 3, sum);
            out.pressure += area / 3 * (depth_in(a, x[0]) + depth_in(a, x[i]) + depth_in(a, x[i + 1]));
        }
    return out;
}

static void free_surface(tl_surface *surface)
{
    free(surface->corner);
    free(surface->size);
    *surface = (tl_surface){0};
}

static void integrate(const tl_pair_view *view, tl_field_sums *out)
{
    static double number[4][512];
    static tl_field_scratch scratch;
    tl_field_faces faces = {.a = view->a->face_count, .b = view->b->face_count};
    for (int k = 0; k < 3; k++)
        faces.n[k] = number[k];
    faces.c = number[3];
    for (uint32_t i = 0; i < faces.a + faces.b; i++) {
        bool of_b = i >= faces.a;
        uint32_t f = of_b ? i - faces.a : i;
        tl_vec3 n = of_b ? view->normal_b[f] : view->a->plane[f].normal;
        number[0][i] = n.x;
        number[1][i] = n.y;
        number[2][i] = n.z;
        number[3][i] = of_b ? view->b->plane[f].offset + tl_v3_dot(n, view->shift) : view->a->plane[f].offset;
    }
    CHECK(tl_field_integrate(&(const tl_field_faces *){&faces}, &out, 1, &scratch));
}

static tl_poly *random_shape(uint64_t *seed)
{
    double size = scene_between(seed, 0.3, 2);
    if (check_random(seed) < 0.4)
        return scene_box_shape(size, size * scene_between(seed, 0.2, 1), size);
    if (check_random(seed) < 0.5)
        return scene_drum(3 + (size_t)(8 * check_random(seed)), size, size, 0.1);
    return scene_random_hull(seed, 4 + (size_t)(12 * check_random(seed)),
                             tl_v3(size, size * scene_between(seed, 0.3, 1), size));
}

TEST(field_polygons_are_those_that_are_integrated)
{
    int cases = 0;
    double worst = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(3000); k++) {
        uint64_t seed = k;
        static scene_pair pair;
        pair = scene_pair_of(random_shape(&seed), random_shape(&seed), scene_any_turn(&seed),
                             tl_v3_scale(scene_between(&seed, 0.1, 1.5), scene_direction(&seed)));
        const tl_pair_view *view = scene_place(&pair);
        tl_region region;
        tl_surface surface = {0};
        tl_field_sums field;
        CHECK(tl_region_find(view, 0, &pair.scratch, &region));
        CHECK(tl_surface_add_field(&(tl_press_query){.view = view, .region = &region}, &surface));
        sums found = sums_of(&surface, view->a);
        integrate(view, &field);
        double size = view->size;
        if (field.extent > 1e-6 * size * size) {
            double off =
                fmax(fabs(found.area - field.extent) / (size * size),
                     fmax(fabs(found.pressure - field.pressure), tl_v3_norm(tl_v3_sub(found.first, field.first))) /
                         (size * size * size));
            worst = fmax(worst, off);
            cases++;
            if (!CHECK(off < 1e-10))
                printf("  seed %d: %zu polygons, area %.12g for %.12g\n", (int)k, surface.polygons, found.area,
                       field.extent);
        } else {
            CHECK(found.area < 1e-5 * size * size);
        }
        free_surface(&surface);
        scene_pair_free(&pair);
    }
    printf("  %d cases, off by %.1e at the most\n", cases, worst);
    CHECK(cases > check_least(2000));
}

TEST(a_patch_has_the_area_of_its_points)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(3000); k++) {
        uint64_t seed = k + 40000;
        static scene_pair pair;
        double tilt = scene_between(&seed, -4, -2.6), z = scene_between(&seed, -1e-3, 1e-3);
        tl_quat turn =
            tl_q_mul(scene_turn(tl_v3(1, 0, 0), pow(10, tilt)), scene_turn(tl_v3(0, 0, 1), scene_between(&seed, 0, 6)));
        tl_vec3 shift = tl_v3(scene_between(&seed, -1, 1), scene_between(&seed, -1, 1), 1 + z);
        pair = scene_pair_of(scene_box_shape(1, 1.3, 1), scene_drum(5, 0.7, 1, 0.2), turn, shift);
        const tl_pair_view *view = scene_place(&pair);
        uint32_t fa = 0, fb = 0;
        for (uint32_t f = 0; f < view->a->face_count; f++)
            fa = view->a->plane[f].normal.z > view->a->plane[fa].normal.z ? f : fa;
        for (uint32_t f = 0; f < view->b->face_count; f++)
            fb = view->normal_b[f].z < view->normal_b[fb].z ? f : fb;
        tl_touch_rule rule = {.reach = INFINITY};
        double area = tl_patch_lay(view, fa, fb, &rule, &pair.scratch);
        tl_surface surface = {0};
        CHECK(tl_surface_add_patch(view, fa, fb, &surface));
        sums found = sums_of(&surface, view->a);
        cases += area > 0;
        /* the points' area is that on the faces, this one lies between them */
        if (!CHECK(fabs(found.area - area) < 1e-5))
            printf("  seed %d: area %.12g for %.12g\n", (int)k, found.area, area);
        CHECK(surface.polygons <= 1);
        double above = 0;
        for (size_t i = 0; i < surface.corners; i++) {
            tl_vec3 x = surface.corner[i];
            double gap_b = tl_v3_dot(view->normal_b[fb], x) - view->b->plane[fb].offset -
                           tl_v3_dot(view->normal_b[fb], view->shift);
            double gap_a = tl_v3_dot(view->a->plane[fa].normal, x) - view->a->plane[fa].offset;
            above = fmax(above, fabs(gap_a - gap_b));
        }
        CHECK(above < 1e-5); /* halfway between the faces */
        free_surface(&surface);
        scene_pair_free(&pair);
    }
    printf("  %d patches\n", cases);
    CHECK(cases > check_least(1500));
}

TEST_MAIN(RUN(field_polygons_are_those_that_are_integrated), RUN(a_patch_has_the_area_of_its_points))
