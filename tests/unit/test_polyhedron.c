/* test_polyhedron.c - making polyhedra from faces, boxes, copies, and the check itself. */
#include "check.h"
#include "geometry/make.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

static const tl_vec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t starts[5] = {0, 3, 6, 9, 12};
static const uint16_t loops[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

static void tetrahedron_planes(tl_plane planes[4])
{
    double s = 1 / sqrt(3.0);
    planes[0] = (tl_plane){{0, 0, -1}, 0};
    planes[1] = (tl_plane){{0, -1, 0}, 0};
    planes[2] = (tl_plane){{-1, 0, 0}, 0};
    planes[3] = (tl_plane){{s, s, s}, s};
}

/* Edges and loops of a polyhedron tell the same story. */
static void check_tables(const tl_poly *p)
{
    CHECK_INT(p->vertex_count + p->face_count, p->edge_count + 2);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_edge edge = p->edge[e];
        int forth = 0, back = 0;
        for (int side = 0; side < 2; side++) {
            uint32_t f = side ? edge.right : edge.left, n = tl_poly_face_size(p, f);
            const uint16_t *loop = p->loop + p->start[f];
            for (uint32_t i = 0; i < n; i++) {
                forth += !side && loop[i] == edge.a && loop[(i + 1) % n] == edge.b;
                back += side && loop[i] == edge.b && loop[(i + 1) % n] == edge.a;
            }
        }
        CHECK_INT(forth, 1);
        CHECK_INT(back, 1);
    }
}

TEST(make_derives_edges_and_stars)
{
    tl_plane planes[4];
    tetrahedron_planes(planes);
    const tl_tag tags[4] = {{1, 2}, {0, 0}, {3, 4}, {5, 6}};
    tl_poly *p = NULL;
    tl_error error;
    CHECK_INT(tl_poly_make(corners, 4, planes, tags, starts, loops, 4, &p, &error), TL_OK);
    CHECK_INT(p->edge_count, 6);
    CHECK_NEAR(p->size, sqrt(3.0), 0);
    CHECK(p->tag[3].joint == 5 && p->tag[3].plane == 6);
    check_tables(p);
    CHECK_INT(tl_poly_check(p, 1e-15, &error), TL_OK);
    tl_poly_free(p);
    tl_poly_free(NULL);
}

static void expect_failure(const tl_vec3 *vertices, size_t vertex_count, const uint32_t *start, const uint16_t *loop,
                           size_t face_count, const char *sentence)
{
    tl_plane planes[4];
    tetrahedron_planes(planes);
    tl_poly *p = (tl_poly *)&planes;
    tl_error error = {0};
    CHECK_INT(tl_poly_make(vertices, vertex_count, planes, NULL, start, loop, face_count, &p, &error), TL_E_GEOMETRY);
    CHECK_INT(error.status, TL_E_GEOMETRY);
    CHECK_CONTAINS(error.text, sentence);
    CHECK(p == NULL);
    /* The sentence is optional. */
    CHECK_INT(tl_poly_make(vertices, vertex_count, planes, NULL, start, loop, face_count, &p, NULL), TL_E_GEOMETRY);
}

TEST(make_refuses_what_is_not_closed)
{
    static const uint16_t reversed[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 3, 2};
    static const uint16_t twice[12] = {0, 2, 1, 0, 2, 1, 0, 3, 2, 1, 2, 3};
    static const uint16_t loopy[12] = {0, 0, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    static const uint16_t unknown[12] = {0, 2, 4, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    static const uint16_t thirteen[13] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 1};
    static const uint32_t ragged[5] = {0, 2, 6, 9, 12}, longer[5] = {0, 3, 6, 9, 13};
    tl_vec3 bad[4] = {corners[0], corners[1], {0, NAN, 0}, corners[3]};
    expect_failure(corners, 4, starts, reversed, 4, "the edge from vertex 3 to vertex 2 belongs to 2");
    expect_failure(corners, 4, starts, twice, 4, "the edge from vertex 1 to vertex 3");
    expect_failure(corners, 4, starts, loopy, 4, "the edge from vertex 1 to vertex 1");
    expect_failure(corners, 4, starts, unknown, 4, "face 1 names vertex 5 of 4");
    expect_failure(corners, 4, ragged, loops, 4, "face 1 needs three vertices");
    expect_failure(corners, 4, longer, thirteen, 4, "vertices + faces - edges must be 2");
    expect_failure(corners, 3, starts, loops, 4, "a polyhedron of 3 vertices");
    expect_failure(corners, 4, starts, loops, 3, "a polyhedron of 3 faces");
    expect_failure(bad, 4, starts, loops, 4, "vertex 3 has a coordinate that is not finite");
}

TEST(box_is_exact)
{
    tl_poly *p = NULL;
    tl_error error;
    CHECK_INT(tl_poly_box(tl_v3(-0.1, 0.2, 0.3), tl_v3(0.7, 1.1, 1e3), &p, &error), TL_OK);
    CHECK_INT(p->vertex_count, 8);
    CHECK_INT(p->edge_count, 12);
    CHECK_INT(p->face_count, 6);
    check_tables(p);
    CHECK_INT(tl_poly_check(p, 0, &error), TL_OK);
    CHECK(p->plane[0].normal.x == -1 && p->plane[0].offset == 0.1);
    CHECK(p->plane[5].normal.z == 1 && p->plane[5].offset == 1e3);
    CHECK(p->tag[0].joint == 0 && p->tag[5].plane == 0);
    tl_poly_free(p);
}

TEST(box_without_volume_is_refused)
{
    const tl_vec3 zero = {0, 0, 0}, max[6] = {{1, 1, 0},   {1, -1, 1},       {1, 1, 1e-6},
                                              {NAN, 1, 1}, {INFINITY, 1, 1}, {1e-200, 1e-200, 1e-200}};
    for (int i = 0; i < 6; i++) {
        tl_poly *p = NULL;
        tl_error error = {0};
        CHECK_INT(tl_poly_box(zero, max[i], &p, &error), TL_E_GEOMETRY);
        CHECK(p == NULL);
        CHECK_CONTAINS(error.text, "box");
    }
}

TEST(transformed_by_identity_is_the_same)
{
    tl_poly *p = NULL, *q = NULL;
    tl_error error;
    tl_mat3 identity = tl_m3_identity();
    CHECK_INT(tl_poly_box(tl_v3(0.1, 0.2, 0.3), tl_v3(1, 2, 3), &p, &error), TL_OK);
    for (int i = 0; i < 2; i++) {
        CHECK_INT(tl_poly_transformed(p, i ? &identity : NULL, tl_v3(0, 0, 0), &q, &error), TL_OK);
        for (uint32_t v = 0; v < 8; v++)
            CHECK_NEAR(tl_v3_norm(tl_v3_sub(p->vertex[v], q->vertex[v])), 0, 0);
        CHECK_INT(tl_poly_check(q, 0, &error), TL_OK);
        tl_poly_free(q);
    }
    tl_poly_free(p);
}

TEST(transformed_moves_and_turns)
{
    tl_poly *p = NULL, *q = NULL;
    tl_error error;
    tl_quat turn = tl_q_unit((tl_quat){1, 2, -3, 0.5});
    tl_mat3 r = tl_q_matrix(turn);
    tl_vec3 t = {10, -20, 30};
    CHECK_INT(tl_poly_box(tl_v3(0, 0, 0), tl_v3(1, 2, 3), &p, &error), TL_OK);
    p->tag[2] = (tl_tag){4, 5};
    CHECK_INT(tl_poly_transformed(p, &r, t, &q, &error), TL_OK);
    for (uint32_t v = 0; v < 8; v++) {
        tl_vec3 want = tl_v3_add(tl_q_rotate(turn, p->vertex[v]), t);
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(q->vertex[v], want)), 0, 1e-14);
    }
    CHECK(q->tag[2].joint == 4 && q->tag[2].plane == 5);
    check_tables(q);
    CHECK_INT(tl_poly_check(q, 1e-14, &error), TL_OK);
    tl_poly_free(p);
    tl_poly_free(q);
}

/* Spoils one thing of a sound box at a time. */
TEST(check_finds_what_is_wrong)
{
    tl_error error;
    for (int what = 0; what < 6; what++) {
        tl_poly *p = NULL;
        const char *sentence = "";
        CHECK_INT(tl_poly_box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), &p, &error), TL_OK);
        switch (what) {
        case 0:
            p->vertex[7].x += 0.1;
            sentence = "outside face 2";
            break;
        case 1:
            p->vertex[7].x -= 0.1;
            sentence = "off its face 2";
            break;
        case 2:
            p->plane[3].normal.y = 1.1;
            sentence = "normal of face 4 has length 1.1";
            break;
        case 3:
            p->edge[0].left = p->edge[0].right;
            sentence = "edge 1 is not in the loops";
            break;
        case 4:
            p->face_count--;
            sentence = "is not 2";
            break;
        case 5:
            for (uint32_t v = 0; v < 8; v++)
                p->vertex[v].z = 0;
            sentence = "face";
            break;
        }
        CHECK_INT(tl_poly_check(p, 1e-9, &error), TL_E_GEOMETRY);
        CHECK_CONTAINS(error.text, sentence);
        tl_poly_free(p);
    }
}

TEST_MAIN(RUN(make_derives_edges_and_stars), RUN(make_refuses_what_is_not_closed), RUN(box_is_exact),
          RUN(box_without_volume_is_refused), RUN(transformed_by_identity_is_the_same),
          RUN(transformed_moves_and_turns), RUN(check_finds_what_is_wrong))
