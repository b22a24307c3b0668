/* test_delaunay.c - signs on the grid, and tetrahedra of points against a search through all of them. */
#include "base/random.h"
#include "check.h"
#include "geometry/delaunay.h"

static uint64_t seed = 5;
static tl_error error;

static tl_site site_at(double x, double y, double z)
{
    return (tl_site){x, y, z, 0};
}

TEST(signs_of_four_points)
{
    const tl_site a = site_at(0, 0, 0), b = site_at(8, 0, 0), c = site_at(0, 8, 0), d = site_at(0, 0, 8);
    CHECK_INT(tl_orient_sign(&a, &b, &c, &d), 1);
    CHECK_INT(tl_orient_sign(&b, &a, &c, &d), -1);
    CHECK_INT(tl_orient_exactly(&a, &b, &c, &d), 1);
    const tl_site inside = site_at(7, 7, 7), on = site_at(8, 8, 8), outside = site_at(9, 8, 8);
    CHECK_INT(tl_sphere_sign(&a, &b, &c, &d, &inside), 1);
    CHECK_INT(tl_sphere_sign(&a, &b, &c, &d, &on), 0);
    CHECK_INT(tl_sphere_sign(&a, &b, &c, &d, &outside), -1);
    /* a heavier point is in, others that are heavier leave it out */
    tl_site heavy = on, light = on;
    heavy.weight = 1;
    light.weight = -1;
    CHECK_INT(tl_sphere_sign(&a, &b, &c, &d, &heavy), 1);
    CHECK_INT(tl_sphere_sign(&a, &b, &c, &d, &light), -1);
}

TEST(signs_of_a_circle)
{
    const tl_site2 a = {0, 0, 0}, b = {4, 0, 0}, c = {0, 4, 0};
    CHECK_INT(tl_circle_sign(&a, &b, &c, &(tl_site2){3, 3, 0}), 1);
    CHECK_INT(tl_circle_sign(&a, &b, &c, &(tl_site2){4, 4, 0}), 0);
    CHECK_INT(tl_circle_sign(&a, &b, &c, &(tl_site2){4, 4, 1}), 1);
    CHECK_INT(tl_circle_sign(&a, &b, &c, &(tl_site2){4, 5, 0}), -1);
}

static tl_site random_site(double size)
{
    return site_at(floor(size * check_random(&seed)), floor(size * check_random(&seed)),
                   floor(size * check_random(&seed)));
}

/* The product of doubles and the whole numbers agree, also for points that nearly lie on a plane and a sphere. */
TEST(filters_agree_with_whole_numbers)
{
    for (int i = 0; i < 20000; i++) {
        tl_site v[5];
        const double size = i % 2 ? 0x1p40 : i % 4 ? 0x1p20 : 4;
        for (int k = 0; k < 5; k++) {
            v[k] = random_site(size);
            v[k].weight = i % 3 ? 0 : floor(size * check_random(&seed));
        }
        if (i % 5 == 0) { /* a corner of a box that is one grid unit off */
            const double a = floor(size / 2 * check_random(&seed)), b = floor(size / 2 * check_random(&seed));
            v[0] = site_at(0, 0, 0);
            v[1] = site_at(a, 0, 0);
            v[2] = site_at(0, b, 0);
            v[3] = site_at(a, b, floor(3 * check_random(&seed)));
            v[4] = site_at(a, b, floor(3 * check_random(&seed)));
        }
        const int side = tl_orient_sign(&v[0], &v[1], &v[2], &v[3]);
        CHECK_INT(side, tl_orient_exactly(&v[0], &v[1], &v[2], &v[3]));
        CHECK_INT(tl_sphere_sign(&v[0], &v[1], &v[2], &v[3], &v[4]),
                  tl_sphere_exactly(&v[0], &v[1], &v[2], &v[3], &v[4]));
        tl_site2 u[4];
        for (int k = 0; k < 4; k++)
            u[k] = (tl_site2){v[k].x, v[k].y, v[k].weight};
        CHECK_INT(tl_circle_sign(&u[0], &u[1], &u[2], &u[3]), tl_circle_exactly(&u[0], &u[1], &u[2], &u[3]));
    }
}

static int side_of(const tl_site *site, const uint32_t v[4])
{
    return tl_orient_exactly(&site[v[0]], &site[v[1]], &site[v[2]], &site[v[3]]);
}

/* Every side is that of two, which have the other three corners of it in common. */
static int is_linked(const tl_delaunay *d)
{
    int sound = 1;
    for (uint32_t t = 0; t < d->used; t++) {
        const tl_tetrahedron *here = &d->tetrahedron[t];
        for (uint32_t i = 0; tl_is_there(here) && i < 4; i++) {
            const tl_tetrahedron *there = &d->tetrahedron[here->next[i] / 4];
            sound = sound && there->next[here->next[i] % 4] == 4 * t + i && tl_is_there(there);
            for (uint32_t k = 0; k < 4; k++) {
                int found = k == i;
                for (uint32_t m = 0; m < 4; m++)
                    found |= m != here->next[i] % 4 && (there->corner[m] == here->corner[k] ||
                                                        (there->corner[m] >= TL_GHOST && here->corner[k] >= TL_GHOST));
                sound = sound && found;
            }
        }
    }
    return sound;
}

/* No point is inside a sphere or beyond the hull, and all volumes are positive. Returns six times the volume. */
static double search_through_all(const tl_delaunay *d, const tl_site *site, uint32_t count)
{
    double six = 0;
    int faults = 0;
    for (uint32_t t = 0; t < d->used; t++) {
        const tl_tetrahedron *here = &d->tetrahedron[t];
        if (!tl_is_there(here))
            continue;
        const uint32_t *v = here->corner;
        for (uint32_t p = 0; p < count; p++) {
            if (tl_is_ghost(here))
                faults += side_of(site, (uint32_t[]){v[0], v[1], v[2], p}) > 0;
            else if (p != v[0] && p != v[1] && p != v[2] && p != v[3])
                faults += tl_sphere_exactly(&site[v[0]], &site[v[1]], &site[v[2]], &site[v[3]], &site[p]) > 0;
        }
        if (tl_is_ghost(here))
            continue;
        faults += side_of(site, v) <= 0;
        const tl_site *a = &site[v[0]], *b = &site[v[1]], *c = &site[v[2]], *e = &site[v[3]];
        six += (b->x - a->x) * ((c->y - a->y) * (e->z - a->z) - (c->z - a->z) * (e->y - a->y)) +
               (b->y - a->y) * ((c->z - a->z) * (e->x - a->x) - (c->x - a->x) * (e->z - a->z)) +
               (b->z - a->z) * ((c->x - a->x) * (e->y - a->y) - (c->y - a->y) * (e->x - a->x));
    }
    CHECK_INT(faults, 0);
    CHECK(is_linked(d));
    return six;
}

TEST(no_point_in_a_sphere)
{
    tl_delaunay d = {0};
    tl_site site[60];
    for (int i = 0; i < 300; i++) {
        const uint32_t count = 5 + (uint32_t)(check_random(&seed) * 55);
        const double size = i % 3 == 0 ? 4 : i % 3 == 1 ? 64 : 0x1p40;
        for (uint32_t k = 0; k < count; k++) {
            site[k] = random_site(size);
            site[k].weight = i % 4 == 3 ? floor(size * check_random(&seed)) : 0;
        }
        site[0] = site_at(0, 0, 0);
        site[1] = site_at(size, 0, 0);
        site[2] = site_at(0, size, 0);
        site[3] = site_at(0, 0, size);
        const tl_delaunay_points points = {.count = count, .site = site};
        if (CHECK_INT(tl_delaunay_make(&d, &points, &error), TL_OK))
            search_through_all(&d, site, count);
    }
    tl_delaunay_free(&d);
}

/* Whole boxes of a lattice: all of eight corners lie on one sphere, and all volumes add up. */
TEST(a_lattice_is_filled)
{
    tl_delaunay d = {0};
    tl_site site[125];
    uint32_t count = 0;
    for (int x = 0; x < 5; x++)
        for (int y = 0; y < 5; y++)
            for (int z = 0; z < 5; z++)
                site[count++] = site_at(x, y, z);
    const tl_delaunay_points points = {.count = count, .site = site};
    CHECK_INT(tl_delaunay_make(&d, &points, &error), TL_OK);
    CHECK_NEAR(search_through_all(&d, site, count), 6 * 64.0, 0);
    CHECK_INT(d.hidden, 0);
    /* weights choose among the tetrahedra of a box, always the same way */
    for (uint32_t p = 0; p < count; p++) {
        site[p] = site_at(0x1p30 * site[p].x, 0x1p30 * site[p].y, 0x1p30 * site[p].z);
        site[p].weight = floor(0x1p30 * tl_uniform(p));
    }
    CHECK_INT(tl_delaunay_make(&d, &points, &error), TL_OK);
    CHECK_NEAR(search_through_all(&d, site, count), 6 * 64 * 0x1p90, 0);
    tl_delaunay_free(&d);
}

TEST(points_that_make_none)
{
    tl_delaunay d = {0};
    tl_site site[16];
    for (uint32_t k = 0; k < 16; k++)
        site[k] = site_at(k % 4, k / 4, 3 + k % 4);
    tl_delaunay_points points = {.count = 16, .site = site};
    CHECK_INT(tl_delaunay_make(&d, &points, &error), TL_E_GEOMETRY);
    CHECK_CONTAINS(error.text, "lie in one plane");
    points.count = 3;
    CHECK_INT(tl_delaunay_make(&d, &points, &error), TL_E_GEOMETRY);
    /* a point twice is left out */
    site[2] = site_at(0, 1, 3);
    site[3] = site_at(1, 1, 9);
    site[4] = site[1];
    points.count = 5;
    CHECK_INT(tl_delaunay_make(&d, &points, &error), TL_OK);
    CHECK_INT(d.hidden, 1);
    tl_delaunay_free(&d);
}

TEST_MAIN(RUN(signs_of_four_points), RUN(signs_of_a_circle), RUN(filters_agree_with_whole_numbers),
          RUN(no_point_in_a_sphere), RUN(a_lattice_is_filled), RUN(points_that_make_none))
