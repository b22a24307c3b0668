/* test_regressions.c - mistakes that contact detection has been seen to make elsewhere, each as a test:
 * nearly parallel edges, flush but disjoint faces, the face that is not touched, line contacts that are
 * too soft, faces half a degree apart, ties, tiny steps in large coordinates. */
#include "contact_scene.h"

#define KN 1e9
#define OVERLAP 1e-4
/* Minimum area of a unit cube's contacts: 1 % of its mean face. */
#define UNIT_MINIMUM 0.01

static const tl_quat none = {1, 0, 0, 0};

static double contact_area(const tl_model *m, uint32_t a, uint32_t b)
{
    uint32_t c = scene_contact(m, a, b);
    return c == TL_NO_ROW ? 0 : m->detect->contacts.area[c];
}

/* ---------------------------------------------------------------- 1 ---------------------- */

/* Two boxes, each on an edge, crossing at angles down to 1e-9 rad: in contact, with the minimum area,
 * and never lost while one slides along the other. */
TEST(nearly_parallel_edges_stay_in_contact)
{
    for (double angle = 1e-9; angle < 2; angle *= 10) {
        tl_model *m = scene_model(1);
        /* no face of one is parallel to a face of the other */
        double lean = 25 * TL_PI / 180, half = 0.5 * (cos(lean) + sin(lean));
        tl_quat turn = scene_turn(tl_v3(0, 0, 1), angle);
        tl_vec3 edge = {0, 0.5 * (sin(lean) - cos(lean)), -half};
        tl_vec3 place = tl_v3_sub(tl_v3(0, 0, sqrt(0.5) - OVERLAP), tl_q_rotate(turn, edge));
        scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(1, 0, 0), TL_PI / 4),
                    tl_v3(0, 0, 0));
        scene_block(m, scene_box_shape(1, 1, 1), tl_q_mul(turn, scene_turn(tl_v3(1, 0, 0), lean)),
                    place);
        scene_law(m, "coulomb", KN, KN, 30);
        for (int i = 0; i < 200; i++) {
            scene_move(m, 1, tl_v3(1e-3, 0, 0), tl_v3(0, 0, 0));
            scene_forces(m);
            double area = contact_area(m, 0, 1);
            if (!CHECK_REL(area, UNIT_MINIMUM, 1e-9))
                break;
            /* for edges within 1e-4 of parallel the nearest way out is sideways over the edges */
            if (angle > 1e-2)
                CHECK_NEAR(scene_force(m, 0, 1).z, KN * area * OVERLAP, 1e-6 * KN * area * OVERLAP);
        }
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- 2 ---------------------- */

/* A's top is level, with a slope of 14 degrees beside it; B is level too and rests with its lower edge on
 * the slope, beside the top. That A's top is parallel to B's bottom means nothing: they do not meet. */
TEST(parallel_faces_that_do_not_meet_leave_the_point_share)
{
    for (double strip = 0.02; strip < 0.2; strip *= 1.5) {
        double t = tan(14 * TL_PI / 180);
        tl_vec3 a[] = {{-1, -1, -1}, {2, -1, -1}, {2, 1, -1}, {-1, 1, -1},     {-1, -1, 0},
                       {0, -1, 0},   {0, 1, 0},   {-1, 1, 0}, {2, -1, -2 * t}, {2, 1, -2 * t}};
        tl_model *m = scene_model(1);
        scene_block(m, scene_hull_shape(a, 10), none, tl_v3(0, 0, 0));
        /* B's lower left edge at x = 0.5, just below the slope there */
        tl_vec3 lift = {1, 0, 0.5 - 0.5 * t - OVERLAP};
        scene_block(m, scene_box_shape(1, strip, 1), none, lift);
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        const tl_blocks *b = &m->blocks;
        double minimum = 0.01 * fmin(b->mean_face[0], b->mean_face[1]);
        CHECK(contact_area(m, 0, 1) >= minimum * (1 - 1e-9));
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- 3 ---------------------- */

static uint32_t cut(tl_model *m, const char *joint, tl_vec3 normal, tl_vec3 point, bool keep_below)
{
    tl_stage stage;
    scene_ok(m, tl_stage_begin(m, &stage));
    uint32_t number = tl_joint_intern(m, joint);
    tl_tag tag = {number, ++m->joints[number - 1].planes};
    scene_ok(m, tl_stage_cut(&stage, tl_v3_unit(normal), point, tag, 1));
    scene_ok(m, tl_stage_commit(&stage));
    /* the part on the wrong side goes */
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        double side = tl_v3_dot(normal, tl_v3_sub(tl_block_centroid(m, row), point));
        if ((side > 0) == keep_below) {
            tl_id id = m->blocks.id[row];
            scene_ok(m, tl_blocks_delete(m, &id, 1));
            break;
        }
    }
    return number;
}

/* A vertex whose own faces are steep, and a nearly level face of a joint that lies higher: the level one
 * is the nearest to the contact's normal, but it does not touch. */
TEST(joint_is_that_of_a_face_that_touches)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-2, -2, -3), tl_v3(2, 2, 1));
    /* a thin wedge down to the ridge through the tip (0, 0, -2), tilted along it */
    tl_vec3 tip = {0, 0, -2};
    cut(m, "steep1", tl_v3(0.9, 0.06, -0.44), tip, true);
    cut(m, "steep2", tl_v3(-0.9, 0.06, -0.44), tip, true);
    cut(m, "steep3", tl_v3(0, -0.9, -0.44), tip, true);
    /* the level face takes the far end of the ridge off, not the tip */
    uint32_t level = cut(m, "level", tl_v3(0, 0.25, -1), tl_v3(0, 0.5, -1.932), true);
    CHECK_INT(m->blocks.table.rows, 1);
    scene_box(m, tl_v3(-4, -4, -4), tl_v3(4, 4, -2 + OVERLAP));
    scene_law(m, "coulomb", KN, KN, 30);
    scene_forces(m);
    uint32_t c = scene_contact(m, 0, 1);
    if (CHECK(c != TL_NO_ROW)) {
        const tl_tag tag = m->detect->contacts.tag[c];
        CHECK(tag.joint != 0);
        CHECK(tag.joint != level);
    }
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- 4 ---------------------- */

/* A cube on its edge, tilted by 30 degrees: the minimum area, at both ends of the edge. */
TEST(edge_on_face_has_the_minimum_area)
{
    for (double degrees = 16; degrees < 75; degrees += 4.5) {
        double a = degrees * TL_PI / 180;
        tl_model *m = scene_model(1);
        scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
        double height = 0.5 * (sin(a) + cos(a)) - OVERLAP;
        scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(1, 0, 0), a),
                    tl_v3(0.1, 0.2, height));
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        uint32_t c = scene_contact(m, 0, 1);
        if (CHECK(c != TL_NO_ROW)) {
            CHECK_REL(m->detect->contacts.area[c], UNIT_MINIMUM, 1e-12);
            CHECK_REL(scene_force(m, 0, 1).z, KN * UNIT_MINIMUM * OVERLAP, 1e-9);
            /* the force acts in the middle of the edge, and resists turning about it both ways */
            tl_vec3 normal, point;
            double gap;
            tl_contact_summary(m, c, &normal, &point, &gap);
            CHECK_NEAR(point.x + m->origin.x, 0.1, 1e-9);
            CHECK(m->detect->contacts.point_count[c] >= 2);
        }
        tl_model_destroy(m);
    }
}

TEST(vertex_on_face_has_the_minimum_area)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
    tl_vec3 d = tl_v3_unit(tl_v3(1, 1, 1)), down = {0, 0, -1};
    tl_vec3 axis = tl_v3_cross(d, down);
    tl_quat q = scene_turn(axis, acos(tl_v3_dot(d, down)));
    scene_block(m, scene_box_shape(1, 1, 1), q, tl_v3(0.3, 0.2, sqrt(0.75) - OVERLAP));
    scene_law(m, "coulomb", KN, KN, 30);
    scene_forces(m);
    CHECK_REL(contact_area(m, 0, 1), UNIT_MINIMUM, 1e-12);
    CHECK_REL(scene_force(m, 0, 1).z, KN * UNIT_MINIMUM * OVERLAP, 1e-8);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- 5 ---------------------- */

/* A plate rocks on a roof of two faces half a degree apart: the force is the sum over both, and has no
 * jump where the plate changes from one to the other. */
TEST(faces_half_a_degree_apart_share_the_force)
{
    double t = tan(0.25 * TL_PI / 180);
    tl_vec3 roof[] = {{-1, -1, -t}, {0, -1, 0},   {1, -1, -t}, {-1, 1, -t}, {0, 1, 0},
                      {1, 1, -t},   {-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}};
    for (int reuse = 0; reuse < 2; reuse++) {
        tl_model *m = scene_model(1);
        m->config.reuse_geometry = reuse;
        scene_block(m, scene_hull_shape(roof, 10), none, tl_v3(0, 0, 0));
        scene_block(m, scene_box_shape(1.6, 1.6, 1), none, tl_v3(0.05, 0, 0.5 - 5e-4));
        scene_law(m, "coulomb", KN, KN, 30);
        tl_vec3 last = {0, 0, 0}, arm = {0.05, 0, 0.5};
        double worst = 0, most = 0;
        for (int i = -400; i <= 400; i++) {
            tl_quat q = scene_turn(tl_v3(0, 1, 0), i / 400.0 * 0.5 * TL_PI / 180);
            scene_put(m, 1, tl_v3_sub(tl_q_rotate(q, arm), arm), q);
            scene_forces(m);
            tl_vec3 force = scene_force(m, 0, 1);
            CHECK(force.z > 0);
            if (i > -400)
                worst = fmax(worst, scene_apart(force, last));
            most = fmax(most, force.z);
            last = force;
        }
        CHECK(worst <= 0.03 * most);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- 6 ---------------------- */

/* Cubes that touch along an edge and slide along it: two axes are equally good for ever, and the axis
 * is searched again only after a share of the overlap. */
TEST(ties_do_not_trigger_the_full_search_every_step)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(1 - OVERLAP, 1 - OVERLAP, 0), tl_v3(2, 2, 1));
    scene_law(m, "elastic", KN, KN, -1);
    tl_contact_area area = {.fraction = 0.01, .absolute = 0.01};
    scene_ok(m, tl_model_contact_area(m, &area));
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 1);
    int searches = 0;
    double last = m->detect->contacts.search[0], step = 2e-7;
    for (int i = 0; i < 1000; i++) {
        scene_move(m, 1, tl_v3(0, 0, step), tl_v3(0, 0, 0));
        scene_forces(m);
        searches += m->detect->contacts.search[0] != last;
        last = m->detect->contacts.search[0];
    }
    /* one in a twentieth of the overlap, and one of the first */
    CHECK(searches <= 1000 * step / (0.05 * OVERLAP) + 2);
    tl_model_destroy(m);
}

/* The same without area of their own: the pair is not looked at in every step. */
TEST(touching_without_area_is_not_looked_at_every_step)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(1, 1, 0), tl_v3(2, 2, 1));
    scene_law(m, "elastic", KN, KN, -1);
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 0);
    if (CHECK_INT(m->detect->pair_count, 1)) {
        int looks = 0;
        double last = m->detect->pairs[0].wake;
        for (int i = 0; i < 1000; i++) {
            scene_move(m, 1, tl_v3(0, 0, 1e-7), tl_v3(0, 0, 0));
            scene_forces(m);
            looks += m->detect->pairs[0].wake != last;
            last = m->detect->pairs[0].wake;
        }
        CHECK(looks <= 12);
    }
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- 7 ---------------------- */

/* Blocks at coordinates of 1e3, one approaching the other by 1e-12 a step: after 2000 steps the gap has
 * closed by 2e-9, though a step is below the rounding of the coordinates. */
TEST(tiny_steps_in_large_coordinates_add_up)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1)); /* the origin is here */
    scene_box(m, tl_v3(1000, 1000, 1000), tl_v3(1001, 1001, 1001));
    scene_box(m, tl_v3(1000, 1000, 1001), tl_v3(1001, 1001, 1002));
    scene_law(m, "elastic", KN, KN, -1);
    tl_id id = m->blocks.id[1];
    scene_ok(m, tl_blocks_fix(m, &id, 1, TL_FIX_ALL));
    for (int i = 0; i < 2000; i++) {
        scene_move(m, 2, tl_v3(0, 0, -1e-12), tl_v3(0, 0, 0));
        scene_forces(m);
    }
    double force = scene_force(m, 1, 2).z;
    CHECK_REL(force, KN * 2e-9, 1e-6);
    CHECK_REL(m->bodies.pose[2].u.z, -2e-9, 1e-12);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(nearly_parallel_edges_stay_in_contact),
          RUN(parallel_faces_that_do_not_meet_leave_the_point_share),
          RUN(joint_is_that_of_a_face_that_touches), RUN(edge_on_face_has_the_minimum_area),
          RUN(vertex_on_face_has_the_minimum_area), RUN(faces_half_a_degree_apart_share_the_force),
          RUN(ties_do_not_trigger_the_full_search_every_step),
          RUN(touching_without_area_is_not_looked_at_every_step),
          RUN(tiny_steps_in_large_coordinates_add_up))
