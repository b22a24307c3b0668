/* test_solids_divided.c - solids in the staging set: convex blocks of one body, or one sentence and nothing changed. */
#include "geometry/make.h"
#include "model/joints.h"
#include "model/model.h"
#include "solid_shapes.h"
#include "staged.h"
#include "values.h"

static shape s;

static tl_block_shape shape_of(const shape *of)
{
    return (tl_block_shape){.vertices = of->vertex,
                            .vertex_count = of->vertices,
                            .start = of->start,
                            .loops = of->loop,
                            .face_count = of->faces,
                            .density = 2500,
                            .group = "stone"};
}

static tl_model *model_new(void)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .threads = 1};
    tl_error error;
    tl_model *m;
    if (tl_model_create(&config, &m, &error) != TL_OK)
        exit(1);
    tl_model_log(m, keep_remark, NULL);
    return m;
}

/* Adds the solid at hand to an empty set; gives the status. */
static tl_status add(tl_model *m, tl_stage *stage, double flat, bool whole, size_t *parts)
{
    const tl_block_shape given = shape_of(&s);
    CHECK_INT(tl_stage_begin_empty(m, stage), TL_OK);
    return tl_stage_add_solid(stage, &given, flat, whole, parts);
}

TEST(parts_are_one_body)
{
    cells_of(&s, "### #.#");
    tl_model *m = model_new();
    tl_stage stage;
    size_t parts;
    CHECK_INT(add(m, &stage, 0, false, &parts), TL_OK);
    CHECK_INT(parts, 3);
    CHECK_INT(stage.count, 3);
    CHECK_NEAR(stage.created_volume, 5, 1e-12);
    for (size_t i = 0; i < stage.count; i++) {
        CHECK_INT(stage.blocks[i].body, stage.blocks[0].body);
        CHECK_INT(stage.blocks[i].draw, stage.blocks[0].draw);
    }
    tl_stage_end(&stage);
    tl_model_destroy(m);
}

/* A joint cuts a body of parts as one block: its sides are two bodies. */
TEST(a_joint_cuts_all_parts)
{
    cells_of(&s, "### #.# ###");
    tl_model *m = model_new();
    tl_stage stage;
    size_t parts, met = 0;
    CHECK_INT(add(m, &stage, 0, false, &parts), TL_OK);
    CHECK_INT(parts, 4);
    CHECK_INT(tl_stage_open(&stage), TL_OK);
    const uint32_t joint = tl_joint_intern(m, "A");
    m->joints[joint - 1].planes = 1;
    const tl_fracture plane = tl_fracture_disc(tl_v3(1, 0, 0), tl_v3(1.4, 0, 0), (double)INFINITY);
    CHECK_INT(tl_stage_cut_fracture(&stage, &plane, (tl_tag){joint, 1}, 1, &met), TL_OK);
    CHECK(met >= 2);
    tl_stage_end(&stage);
    tl_model_destroy(m);
}

TEST(a_convex_solid_is_one_block)
{
    cells_of(&s, "###");
    triangulate(&s);
    tl_model *m = model_new(), *other = model_new();
    tl_stage stage, single;
    size_t parts;
    const tl_block_shape given = shape_of(&s);
    CHECK_INT(add(m, &stage, 0, true, &parts), TL_OK);
    CHECK_INT(parts, 1);
    CHECK_INT(tl_stage_begin_empty(other, &single), TL_OK);
    CHECK_INT(tl_stage_add_faces(&single, &given), TL_OK);
    const tl_poly *a = stage.blocks[0].shape, *b = single.blocks[0].shape;
    CHECK_INT(a->vertex_count, b->vertex_count);
    CHECK_INT(a->face_count, b->face_count);
    CHECK(memcmp(a->vertex, b->vertex, a->vertex_count * sizeof *a->vertex) == 0);
    tl_stage_end(&stage);
    tl_stage_end(&single);
    tl_model_destroy(m);
    tl_model_destroy(other);
}

TEST(tags_stay_on_their_faces)
{
    cells_of(&s, "### #.#");
    for (size_t f = 0; f < s.faces; f++)
        s.tag[f] = (tl_tag){1, 1 + (uint32_t)f % 2};
    const tl_solid_surface given = surface_of(&s);
    tl_convex_parts p;
    tl_error error;
    CHECK_INT(tl_convex_parts_make(&given, &p, &error), TL_OK);
    CHECK_INT(p.count, 3);
    int inner = 0;
    for (size_t i = 0; i < p.count; i++)
        for (uint32_t f = 0; f < p.part[i]->face_count; f++)
            inner += p.part[i]->tag[f].joint == 0;
    CHECK(inner >= 2 && inner <= 4);
    tl_convex_parts_free(&p);
}

static void refused(const char *what, bool whole)
{
    tl_model *m = model_new();
    tl_stage stage;
    size_t parts = 7;
    if (!CHECK_INT(add(m, &stage, 0, whole, &parts), TL_E_GEOMETRY))
        printf("%s\n", what);
    CHECK_CONTAINS(tl_model_error(m)->text, what);
    CHECK_INT(stage.count, 0);
    CHECK_INT(parts, 0);
    CHECK(!m->origin_set);
    tl_stage_end(&stage);
    tl_model_destroy(m);
}

/* A cube from `low` with this edge; its faces look inward where `inward`. */
static void put_cube(double low, double edge, bool inward)
{
    static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const uint32_t base = (uint32_t)s.vertices;
    for (int i = 0; i < 8; i++)
        put_vertex(&s, tl_v3(low + (i & 1 ? edge : 0), low + (i & 2 ? edge : 0), low + (i & 4 ? edge : 0)));
    for (int f = 0; f < 6; f++) {
        uint32_t c[4];
        for (int k = 0; k < 4; k++)
            c[k] = base + faces[f][inward ? 3 - k : k];
        put_face(&s, c, 4);
    }
}

TEST(faults_are_told_with_their_place)
{
    cells_of(&s, "## #");
    refused("not convex: it bends inward at the edge from {1, 1, ", true);
    s.faces--;
    refused("the surface is open at the edge from {", false);
    cells_of(&s, "## #");
    const uint32_t held = s.loop[0];
    s.loop[0] = s.loop[2];
    s.loop[2] = held;
    refused("of which one is turned over at the edge from {", false);
    cells_of(&s, "#. .#");
    refused("has more than two faces at the edge from {1, 1, 0} to {1, 1, 1}", false);
    refused("; a solid must not touch itself along an edge: make a solid of each of the parts", false);
    clear(&s);
    put_cube(0, 1, true);
    refused("turned inside out: its volume is -1 m3", false);
    clear(&s);
    put_cube(0, 1, false);
    put_cube(3, 1, false);
    refused("is of several solids", false);
    clear(&s);
    put_cube(0, 1, false);
    put_cube(3, 0.5, true);
    refused("no cavity at {3, 3", false);
    clear(&s);
    put_cube(0, 1, false);
    for (size_t v = 0; v < 8; v++)
        s.vertex[v].z = 0;
    refused("holds no volume", false);
    cells_of(&s, "## #");
    s.vertex[0].z -= 0.2;
    refused("is bent: a corner lies ", false);
}

/* A surface that goes through itself, with and without corners on its own faces. */
TEST(crossings_are_found)
{
    /* a cavity that reaches out of the solid */
    clear(&s);
    put_cube(0, 1, false);
    put_cube(0.7, 0.6, true);
    refused("the surface crosses itself at {", false);
    for (int i = 0; i < check_cases(300); i++) {
        /* a bent pipe whose ends go through each other */
        pipe(&s, 3 + below(9), 8 + below(8), 0.999, 0.2);
        const size_t n = s.vertices / 2;
        for (size_t v = 0; v < s.vertices; v++) /* the second half sinks into the first */
            if (v >= n)
                s.vertex[v].z += 0.02 * sin((double)(v - n));
        triangulate(&s);
        const double turns = between(1.02, 1.3);
        for (size_t v = 0; v < s.vertices; v++) {
            const double x = s.vertex[v].x, y = s.vertex[v].y, r = sqrt(x * x + y * y);
            double angle = atan2(y, x);
            angle = (angle < -1e-9 ? angle + 2 * TL_PI : angle) * turns / 0.999;
            s.vertex[v].x = r * cos(angle);
            s.vertex[v].y = r * sin(angle);
        }
        refused("the surface crosses itself at {", false);
    }
}

TEST(odd_numbers_are_refused)
{
    cells_of(&s, "## #");
    tl_model *m = model_new();
    tl_stage stage;
    size_t parts;
    s.vertex[3] = s.vertex[2];
    CHECK_INT(add(m, &stage, 0, false, &parts), TL_E_GEOMETRY);
    CHECK_INT(stage.count, 0);
    tl_stage_end(&stage);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(parts_are_one_body), RUN(a_joint_cuts_all_parts), RUN(a_convex_solid_is_one_block),
          RUN(tags_stay_on_their_faces), RUN(faults_are_told_with_their_place), RUN(crossings_are_found),
          RUN(odd_numbers_are_refused))
