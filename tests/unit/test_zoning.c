/* test_zoning.c - zones of boxes: their number and shape, sizes that vary, what is refused; clusters. */
#include "check.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/zone_clusters.h"
#include "geometry/zoning.h"

#include <talus/vmath.h>

static tl_error error;
static tl_zone_scratch *scratch;

static tl_poly *box_of(double x, double y, double z)
{
    tl_poly *p = NULL;
    CHECK_INT(tl_poly_box(tl_v3(0, 0, 0), tl_v3(x, y, z), &p, &error), TL_OK);
    return p;
}

static tl_zone_mesh zones_of(const tl_poly *p, const tl_shape_zoning *zoning)
{
    tl_zone_mesh m;
    if (!CHECK_INT(tl_zoning_make(p, zoning, scratch, &m, &error), TL_OK)) {
        printf("    %s\n", error.text);
        exit(1);
    }
    return m;
}

static bool same(const tl_zone_mesh *a, const tl_zone_mesh *b)
{
    return a->point_count == b->point_count && a->zone_count == b->zone_count &&
           a->triangle_count == b->triangle_count && !memcmp(a->point, b->point, a->point_count * sizeof *a->point) &&
           !memcmp(a->zone, b->zone, a->zone_count * sizeof *a->zone) &&
           !memcmp(a->beside, b->beside, a->zone_count * sizeof *a->beside) &&
           !memcmp(a->triangle, b->triangle, a->triangle_count * sizeof *a->triangle);
}

/* Zones larger than the block: its corners and its centroid. */
TEST(corners_and_centroid)
{
    tl_poly *cube = box_of(1, 1, 1);
    tl_zone_mesh m = zones_of(cube, &(tl_shape_zoning){.edge = 3});
    CHECK_INT(m.point_count, 9);
    CHECK_INT(m.zone_count, 12);
    CHECK_INT(m.triangle_count, 12);
    CHECK_INT(m.face_end, 8);
    CHECK_NEAR(tl_v3_norm(tl_v3_sub(m.point[8], tl_v3(0.5, 0.5, 0.5))), 0, 1e-15);
    CHECK_NEAR(m.volume, 1, 1e-15);
    tl_zone_mesh_free(&m);
    tl_poly_free(cube);
}

/* Points are numbered from corners to inside, and lie where they should. */
TEST(points_in_their_order)
{
    tl_poly *box = box_of(3, 2, 1);
    tl_zone_mesh m = zones_of(box, &(tl_shape_zoning){.edge = 0.3});
    CHECK_INT(m.corner_end, 8);
    /* 10, 7 and 3 parts of an edge */
    CHECK_INT(m.edge_end, 8 + 4 * (9 + 6 + 2));
    for (uint32_t i = 0; i < m.point_count; i++) {
        const tl_vec3 x = m.point[i];
        const int on = (x.x == 0 || x.x == 3) + (x.y == 0 || x.y == 2) + (x.z == 0 || x.z == 1);
        CHECK_INT(on, i < m.corner_end ? 3 : i < m.edge_end ? 2 : i < m.face_end ? 1 : 0);
    }
    tl_zone_mesh_free(&m);
    tl_poly_free(box);
}

/* The least altitudes, over the wanted edge, that repair reaches. */
TEST(shapes_of_zones)
{
    static const struct {
        double x, y, z, edge, share;
    } cases[] = {{1, 1, 1, 0.34, 0.39},  {1, 1, 1, 0.2, 0.39},   {1, 1, 1, 0.1, 0.39},   {1, 1, 1, 0.05, 0.39},
                 {20, 20, 1, 1, 0.29},   {20, 20, 1, 0.5, 0.38}, {20, 20, 1, 0.7, 0.38}, {20, 1, 1, 0.3, 0.35},
                 {2, 1, 0.7, 0.3, 0.39}, {3, 2, 1, 0.2, 0.39}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        tl_poly *box = box_of(cases[i].x, cases[i].y, cases[i].z);
        tl_zone_mesh m = zones_of(box, &(tl_shape_zoning){.edge = cases[i].edge});
        CHECK(m.least_share > cases[i].share);
        CHECK_NEAR(m.least_altitude, m.least_share * cases[i].edge, 1e-12);
        const double volume = cases[i].x * cases[i].y * cases[i].z;
        CHECK_REL(m.volume, volume, 1e-13);
        const double area = 2 * (cases[i].x * (cases[i].y + cases[i].z) + cases[i].y * cases[i].z);
        const double expected = tl_zoning_expected(volume, area, cases[i].edge);
        CHECK(m.zone_count < 1.2 * expected && m.zone_count > 0.4 * expected);
        tl_zone_mesh_free(&m);
        tl_poly_free(box);
    }
}

/* What the scratch has done before changes nothing. */
TEST(the_same_with_any_scratch)
{
    tl_poly *box = box_of(2, 1, 1), *other = box_of(5, 4, 3);
    tl_zone_mesh used = zones_of(other, &(tl_shape_zoning){.edge = 0.4}),
                 again = zones_of(box, &(tl_shape_zoning){.edge = 0.2});
    tl_zone_scratch_free(scratch);
    scratch = tl_zone_scratch_create();
    tl_zone_mesh m = zones_of(box, &(tl_shape_zoning){.edge = 0.2});
    CHECK(same(&m, &again));
    tl_zone_mesh_free(&m);
    tl_zone_mesh_free(&again);
    tl_zone_mesh_free(&used);
    tl_poly_free(box);
    tl_poly_free(other);
}

/* Points on faces stay, unless these are free; then they move along them. */
TEST(free_faces)
{
    const uint8_t all_free[6] = {1, 1, 1, 1, 1, 1};
    tl_poly *slab = box_of(20, 20, 1);
    tl_zone_mesh held = zones_of(slab, &(tl_shape_zoning){.edge = 1});
    tl_zone_mesh loose = zones_of(slab, &(tl_shape_zoning){.edge = 1, .face_free = all_free});
    uint32_t moved = 0;
    CHECK_INT(held.face_end, loose.face_end);
    for (uint32_t i = 0; i < held.face_end; i++)
        moved += memcmp(&held.point[i], &loose.point[i], sizeof *held.point) != 0;
    CHECK(moved > 0);
    CHECK(loose.least_share > held.least_share);
    for (uint32_t i = 0; i < loose.triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const tl_plane *plane = &slab->plane[loose.triangle[i].face];
            CHECK_NEAR(tl_v3_dot(plane->normal, loose.point[loose.triangle[i].corner[k]]), plane->offset, 1e-13);
        }
    tl_zone_mesh_free(&held);
    tl_zone_mesh_free(&loose);
    tl_poly_free(slab);
}

/* Fine at one corner and coarse far from it. */
static double graded(const void *user, tl_vec3 place)
{
    return *(const double *)user + 0.25 * tl_v3_norm(place);
}

TEST(sizes_that_vary)
{
    const double finest = 0.05;
    tl_poly *box = box_of(4, 3, 2);
    tl_zone_mesh m = zones_of(box, &(tl_shape_zoning){.size = graded, .user = &finest});
    CHECK_REL(m.volume, 24.0, 1e-13);
    CHECK(m.least_share > 0.2);
    /* mean edges of zones follow the wanted ones */
    double share = 0;
    for (uint32_t z = 0; z < m.zone_count; z++) {
        double length = 0, wanted = 0;
        for (int i = 0; i < 4; i++) {
            wanted += 0.25 * graded(&finest, m.point[m.zone[z][i]]);
            for (int k = i + 1; k < 4; k++)
                length += tl_v3_norm(tl_v3_sub(m.point[m.zone[z][i]], m.point[m.zone[z][k]])) / 6;
        }
        CHECK(length > 0.35 * wanted && length < 2.5 * wanted);
        share += length / wanted;
    }
    CHECK_NEAR(share / m.zone_count, 1.1, 0.25);
    tl_zone_mesh_free(&m);
    tl_poly_free(box);
}

static double nowhere(const void *user, tl_vec3 place)
{
    (void)user;
    return place.x > 0.5 ? -1 : 1;
}

TEST(what_is_refused)
{
    tl_poly *box = box_of(1, 1, 1);
    tl_zone_mesh m;
    static const double none[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        CHECK_INT(tl_zoning_make(box, &(tl_shape_zoning){.edge = none[i]}, scratch, &m, &error), TL_E_ARGUMENT);
        CHECK_CONTAINS(error.text, "it must be positive");
        CHECK(m.point == NULL && m.zone_count == 0);
    }
    CHECK_INT(tl_zoning_make(box, &(tl_shape_zoning){.size = nowhere}, scratch, &m, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "the wanted edge of zones is -1 at (1, 0, 0)");
    CHECK_INT(tl_zoning_make(box, &(tl_shape_zoning){.edge = 1e-7}, scratch, &m, &error), TL_E_ARGUMENT);
    CHECK_CONTAINS(error.text, "would have 1e+07 zones");
    tl_poly_free(box);
}

/* Every zone is in one cluster; all but a few have six to ten, and each hangs together. */
TEST(clusters)
{
    tl_poly *box = box_of(3, 2, 1);
    tl_zone_mesh m = zones_of(box, &(tl_shape_zoning){.edge = 0.2});
    tl_zone_clusters c;
    CHECK_INT(
        tl_zone_clusters_make((const uint32_t(*)[4])m.zone, (const uint32_t(*)[4])m.beside, m.zone_count, &c, &error),
        TL_OK);
    uint32_t *of = malloc(m.zone_count * sizeof *of), small = 0, corners = 0;
    memset(of, 0xff, m.zone_count * sizeof *of);
    CHECK_INT(c.start[c.count], m.zone_count);
    for (uint32_t k = 0; k < c.count; k++) {
        const uint32_t size = c.start[k + 1] - c.start[k];
        CHECK(size > 0 && size <= TL_CLUSTER_MOST);
        small += size < TL_CLUSTER_FEW;
        for (uint32_t i = c.start[k]; i < c.start[k + 1]; i++) {
            const uint32_t zone = c.zone[i];
            CHECK_INT(of[zone], UINT32_MAX);
            of[zone] = k;
            /* one of its neighbours is in the cluster already */
            bool hangs = i == c.start[k];
            for (int s = 0; s < 4; s++)
                hangs = hangs || (m.beside[zone][s] != UINT32_MAX && of[m.beside[zone][s]] == k);
            CHECK(hangs || size > TL_CLUSTER_FULL);
        }
        uint32_t seen[4 * TL_CLUSTER_MOST], count = 0;
        for (uint32_t i = 4 * c.start[k]; i < 4 * c.start[k + 1]; i++) {
            const uint32_t point = m.zone[c.zone[i / 4]][i % 4];
            bool found = false;
            for (uint32_t s = 0; s < count; s++)
                found = found || seen[s] == point;
            if (!found)
                seen[count++] = point;
        }
        corners += count;
    }
    CHECK(small < c.count / 50);
    const double mean = (double)m.zone_count / c.count;
    CHECK(mean > 5 && mean < 7);
    /* a chain of six has nine corners, compact ones have eight and less */
    CHECK((double)corners / c.count < 8.7);
    free(of);
    tl_zone_clusters_free(&c);
    tl_zone_mesh_free(&m);
    tl_poly_free(box);
}

int main(void)
{
    scratch = tl_zone_scratch_create();
    RUN(corners_and_centroid);
    RUN(points_in_their_order);
    RUN(shapes_of_zones);
    RUN(the_same_with_any_scratch);
    RUN(free_faces);
    RUN(sizes_that_vary);
    RUN(what_is_refused);
    RUN(clusters);
    tl_zone_scratch_free(scratch);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
