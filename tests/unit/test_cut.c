/* test_cut.c - cutting: known cuts of boxes, every result, and blocks that share a face. */
#include "check.h"
#include "geometry/cut.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

static tl_error error;

static tl_poly *box(tl_vec3 min, tl_vec3 max)
{
    tl_poly *p = NULL;
    if (!CHECK_INT(tl_poly_box(min, max, &p, &error), TL_OK))
        exit(1);
    return p;
}

static tl_cut cut_by(const tl_poly *p, tl_vec3 normal, tl_vec3 point)
{
    tl_vec3 n = tl_v3_unit(normal);
    tl_cut cut;
    CHECK_INT(tl_poly_cut(p, (tl_plane){n, tl_v3_dot(n, point)}, 0, (tl_tag){2, 5}, &cut, &error), TL_OK);
    CHECK((cut.result == TL_CUT_MADE) == (cut.below && cut.above));
    return cut;
}

static void free_cut(tl_cut *cut)
{
    tl_poly_free(cut->below);
    tl_poly_free(cut->above);
}

static void expect_counts(const tl_poly *p, uint32_t vertices, uint32_t edges, uint32_t faces)
{
    CHECK_INT(p->vertex_count, vertices);
    CHECK_INT(p->edge_count, edges);
    CHECK_INT(p->face_count, faces);
    CHECK_INT(tl_poly_check(p, 1e-14, &error), TL_OK);
}

TEST(box_cut_across)
{
    tl_poly *p = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    p->tag[4] = (tl_tag){9, 1};
    tl_cut cut = cut_by(p, tl_v3(0, 0, 1), tl_v3(0, 0, 0.3));
    CHECK_INT(cut.result, TL_CUT_MADE);
    expect_counts(cut.below, 8, 12, 6);
    expect_counts(cut.above, 8, 12, 6);
    /* New coordinates are those of the plane, so pieces are exact boxes. */
    CHECK_INT(tl_poly_check(cut.below, 0, &error), TL_OK);
    CHECK_INT(tl_poly_check(cut.above, 0, &error), TL_OK);
    CHECK_NEAR(tl_poly_mass(cut.below).volume, 0.3, 1e-16);
    CHECK_NEAR(tl_poly_mass(cut.above).volume, 0.7, 2e-16);
    /* The cap is the last face and has the plane and its tag; others keep theirs. */
    const tl_plane *low = &cut.below->plane[5], *high = &cut.above->plane[5];
    CHECK(low->normal.z == 1 && low->offset == 0.3);
    CHECK(high->normal.z == -1 && high->offset == -0.3);
    CHECK(cut.below->tag[5].joint == 2 && cut.below->tag[5].plane == 5);
    CHECK(cut.above->tag[5].joint == 2 && cut.above->tag[5].plane == 5);
    CHECK(cut.below->tag[4].joint == 9 && cut.above->tag[4].joint == 0);
    free_cut(&cut);
    tl_poly_free(p);
}

TEST(through_vertices_and_edges)
{
    tl_poly *p = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    /* Along two opposite edges: two wedges. */
    tl_cut cut = cut_by(p, tl_v3(1, -1, 0), tl_v3(0, 0, 0));
    CHECK_INT(cut.result, TL_CUT_MADE);
    expect_counts(cut.below, 6, 9, 5);
    expect_counts(cut.above, 6, 9, 5);
    CHECK_NEAR(tl_poly_mass(cut.below).volume, 0.5, 1e-16);
    free_cut(&cut);
    /* Through three vertices: a corner tetrahedron. */
    cut = cut_by(p, tl_v3(1, 1, 1), tl_v3(1, 0, 0));
    expect_counts(cut.below, 4, 6, 4);
    expect_counts(cut.above, 7, 12, 7);
    CHECK_NEAR(tl_poly_mass(cut.below).volume, 1.0 / 6, 1e-16);
    free_cut(&cut);
    /* Through one edge and the middles of two others. */
    cut = cut_by(p, tl_v3(-1, 0, 2), tl_v3(0, 0, 0));
    expect_counts(cut.below, 6, 9, 5);
    expect_counts(cut.above, 8, 12, 6);
    free_cut(&cut);
    /* The hexagon. */
    cut = cut_by(p, tl_v3(1, 1, 1), tl_v3(0.5, 0.5, 0.5));
    expect_counts(cut.below, 10, 15, 7);
    expect_counts(cut.above, 10, 15, 7);
    CHECK_INT(tl_poly_face_size(cut.below, 6), 6);
    CHECK_NEAR(tl_poly_face_area(cut.below, 6), 0.75 * sqrt(3.0), 1e-15);
    free_cut(&cut);
    tl_poly_free(p);
}

TEST(planes_beside_and_touching_miss)
{
    tl_poly *p = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    const struct {
        tl_vec3 normal, point;
    } plane[5] = {{{1, 0, 0}, {2, 0, 0}},
                  {{1, 0, 0}, {-1, 0, 0}},
                  {{1, 1, 1}, {1, 1, 1}},
                  {{1, 1, 0}, {0, 0, 0}},
                  {{1, 0, 0}, {1 + 1e-8, 0, 0}}};
    for (int i = 0; i < 5; i++) {
        tl_cut cut = cut_by(p, plane[i].normal, plane[i].point);
        CHECK_INT(cut.result, TL_CUT_MISS);
        CHECK(cut.face == UINT32_MAX);
    }
    tl_cut cut;
    CHECK_INT(tl_poly_cut(p, (tl_plane){{NAN, 0, 0}, 0}, 0, (tl_tag){1, 1}, &cut, &error), TL_OK);
    CHECK_INT(cut.result, TL_CUT_MISS);
    tl_poly_free(p);
}

/* The plane of a face is found from either side of it, with the normal either way. */
TEST(coincident_names_the_face)
{
    tl_poly *p = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    for (uint32_t f = 0; f < 6; f++)
        for (int flip = 0; flip < 2; flip++)
            for (int off = -1; off <= 1; off++) {
                tl_plane plane = p->plane[f];
                plane.offset += 0.5 * TL_POLY_ON * off;
                if (flip)
                    plane = (tl_plane){tl_v3_neg(plane.normal), -plane.offset};
                tl_cut cut;
                CHECK_INT(tl_poly_cut(p, plane, 0, (tl_tag){1, 1}, &cut, &error), TL_OK);
                CHECK_INT(cut.result, TL_CUT_COINCIDENT);
                CHECK_INT(cut.face, f);
            }
    tl_poly_free(p);
}

TEST(thin_sides_are_refused)
{
    tl_poly *p = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    double thin = TL_POLY_THIN * p->size;
    /* A slice along the face x = 1 and one along x = 0, whichever way the plane looks. */
    for (int flip = -1; flip <= 1; flip += 2) {
        tl_cut cut = cut_by(p, tl_v3(flip, 0, 0), tl_v3(1 - 0.9 * thin, 0, 0));
        CHECK_INT(cut.result, TL_CUT_REFUSED);
        CHECK_INT(cut.face, 1);
        cut = cut_by(p, tl_v3(flip, 0, 0), tl_v3(0.9 * thin, 0, 0));
        CHECK_INT(cut.result, TL_CUT_REFUSED);
        CHECK_INT(cut.face, 0);
        /* A corner or an edge taken off has no face along it. */
        cut = cut_by(p, tl_v3(flip, flip, flip), tl_v3(1 - thin, 1, 1));
        CHECK_INT(cut.result, TL_CUT_REFUSED);
        CHECK(cut.face == UINT32_MAX);
        cut = cut_by(p, tl_v3(flip, 0, flip), tl_v3(1 - thin, 0, 1));
        CHECK_INT(cut.result, TL_CUT_REFUSED);
        CHECK(cut.face == UINT32_MAX);
        /* Just thick enough. */
        cut = cut_by(p, tl_v3(flip, 0, 0), tl_v3(1 - 1.01 * thin, 0, 0));
        CHECK_INT(cut.result, TL_CUT_MADE);
        free_cut(&cut);
    }
    tl_poly_free(p);
}

/* Vertices of `p` within reach of the plane x = 0. */
static int on_seam(const tl_poly *p, tl_vec3 *found)
{
    int count = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        if (p->vertex[v].x == 0)
            found[count++] = p->vertex[v];
    return count;
}

/* Two blocks with a face in common whose vertices are listed in different orders get the same new
 * vertices on it, bit for bit. */
TEST(neighbours_get_the_same_vertices)
{
    uint64_t seed = 11;
    int made = 0;
    for (int i = 0; i < 2000; i++) {
        /* A random quadrilateral on x = 0 with one apex on either side. */
        tl_vec3 left[5], right[5];
        for (int k = 0; k < 4; k++) {
            double angle = 0.5 * TL_PI * (k + 0.8 * check_random(&seed));
            left[k] = tl_v3(0, cos(angle) + 3e3, sin(angle));
            right[3 - k] = left[k];
        }
        left[4] = tl_v3(-1, 3e3, 0);
        right[4] = tl_v3(1, 3e3, 0);
        tl_poly *p = NULL, *q = NULL;
        CHECK_INT(tl_poly_hull(left, 5, TL_HULL_OF_CORNERS, &p, &error), TL_OK);
        CHECK_INT(tl_poly_hull(right, 5, TL_HULL_OF_CORNERS, &q, &error), TL_OK);
        tl_vec3 n = tl_v3(check_random(&seed) - 0.5, check_random(&seed) - 0.5, check_random(&seed) - 0.5);
        tl_cut a = cut_by(p, n, tl_v3(0, 3e3, 0)), b = cut_by(q, n, tl_v3(0, 3e3, 0));
        if (a.result == TL_CUT_MADE && b.result == TL_CUT_MADE) {
            tl_vec3 seam_a[8], seam_b[8];
            int count = on_seam(a.below, seam_a);
            CHECK_INT(on_seam(b.below, seam_b), count);
            for (int k = 0; k < count; k++) {
                int found = 0;
                for (int j = 0; j < count; j++)
                    found = found || memcmp(&seam_a[k], &seam_b[j], sizeof seam_a[k]) == 0;
                CHECK(found);
            }
            made++;
        }
        free_cut(&a);
        free_cut(&b);
        tl_poly_free(p);
        tl_poly_free(q);
    }
    CHECK(made > 1900);
}

/* Cuts every block of a list by a plane. */
static int cut_all(tl_poly **blocks, int count, tl_plane plane)
{
    int before = count;
    for (int i = 0; i < before; i++) {
        tl_cut cut;
        CHECK_INT(tl_poly_cut(blocks[i], plane, 0, (tl_tag){1, 1}, &cut, &error), TL_OK);
        if (cut.result != TL_CUT_MADE)
            continue;
        tl_poly_free(blocks[i]);
        blocks[i] = cut.below;
        blocks[count++] = cut.above;
    }
    return count;
}

/* The unit cube by 3, 3 and 5 planes symmetric about its centre, 1/4, 1/5 and 1/10 apart, makes
 * 4 x 4 x 6 bricks. */
TEST(orthogonal_grid)
{
    tl_poly *blocks[96];
    int count = 1, planes[3] = {3, 3, 5};
    double spacing[3] = {0.25, 0.2, 0.1};
    static const tl_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    blocks[0] = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < planes[k]; i++)
            count = cut_all(blocks, count, (tl_plane){axis[k], 0.5 + spacing[k] * (i - planes[k] / 2)});
    CHECK_INT(count, 96);
    uint32_t faces = 0, vertices = 0, edges = 0;
    double sum = 0, squares = 0, smallest = 1, largest = 0;
    for (int i = 0; i < count; i++) {
        faces += blocks[i]->face_count;
        vertices += blocks[i]->vertex_count;
        edges += blocks[i]->edge_count;
        CHECK_INT(tl_poly_check(blocks[i], 0, &error), TL_OK);
        double volume = tl_poly_mass(blocks[i]).volume;
        sum += volume;
        squares += volume * volume;
        smallest = fmin(smallest, volume);
        largest = fmax(largest, volume);
        tl_poly_free(blocks[i]);
    }
    CHECK_INT(faces, 576);
    CHECK_INT(vertices, 768);
    CHECK_INT(edges, 1152);
    CHECK_NEAR(sum, 1, 1e-14);
    CHECK_REL(squares, 0.0143, 1e-13);
    CHECK_REL(smallest, 0.005, 1e-13);
    CHECK_REL(largest, 0.0225, 1e-13);
}

/* A prism with more sides than the scratch on the stack holds. */
TEST(large_polyhedron)
{
    enum { SIDES = 1000 };
    static tl_vec3 points[2 * SIDES];
    for (int k = 0; k < SIDES; k++) {
        double angle = 2 * TL_PI * k / SIDES;
        points[2 * k] = tl_v3(cos(angle), sin(angle), -1);
        points[2 * k + 1] = tl_v3(cos(angle), sin(angle), 1);
    }
    tl_poly *p = NULL;
    CHECK_INT(tl_poly_hull(points, 2 * SIDES, TL_HULL_OF_CORNERS, &p, &error), TL_OK);
    tl_cut cut = cut_by(p, tl_v3(0.1, 0.2, 1), tl_v3(0, 0, 0));
    CHECK_INT(cut.result, TL_CUT_MADE);
    expect_counts(cut.below, 2 * SIDES, 3 * SIDES, SIDES + 2);
    expect_counts(cut.above, 2 * SIDES, 3 * SIDES, SIDES + 2);
    CHECK_REL(tl_poly_mass(cut.below).volume, 0.5 * tl_poly_mass(p).volume, 1e-13);
    free_cut(&cut);
    tl_poly_free(p);
}

TEST_MAIN(RUN(box_cut_across), RUN(through_vertices_and_edges), RUN(planes_beside_and_touching_miss),
          RUN(coincident_names_the_face), RUN(thin_sides_are_refused), RUN(neighbours_get_the_same_vertices),
          RUN(orthogonal_grid), RUN(large_polyhedron))
