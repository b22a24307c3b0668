/* test_regressions.c - mistakes that contact detection has been seen to make elsewhere, each as a test:
 * nearly parallel edges, flush but disjoint faces, the face that is not touched, stiffnesses of corners, edges and tilted
 * faces, faces half a degree apart, ties, tiny steps in large coordinates. */
#include "contact/contacts.h"
#include "contact_scene.h"
#include "model/joints.h"
#include "model/rows.h"
#include "narrow/manifold.h"

#define KN 1e9
#define OVERLAP 1e-4
static const tl_quat none = {1, 0, 0, 0};

/* The force of an edge of length L on a face that it is in by d, over kn L, where its faces rise from the face by two
 * angles: the inner circle of the triangle that is in has the radius r, and on its base b the pressure goes from 0 at the ends
 * to that of r. At its own ends the edge carries less, by a share of some d / L. */
static double edge_force(double one, double other, double d)
{
    double base = d / tan(one) + d / tan(other);
    double radius = base * d / (base + d / sin(one) + d / sin(other));
    return radius * base;
}

/* ---------------------------------------------------------------- 1 ---------------------- */

/* Two boxes, each on an edge, crossing at angles down to 1e-9 rad: in contact, and never lost while one slides along the
 * other. Edges that cross keep their force; of those nearly along each other so much is lost as is no longer over the other. */
TEST(nearly_parallel_edges_stay_in_contact)
{
    const double step = 1e-3;
    for (double angle = 1e-9; angle < 2; angle *= 10) {
        tl_model *m = scene_model(1);
        /* no face of one is parallel to a face of the other */
        double lean = 25 * TL_PI / 180, half = 0.5 * (cos(lean) + sin(lean));
        tl_quat turn = scene_turn(tl_v3(0, 0, 1), angle);
        tl_vec3 edge = {0, 0.5 * (sin(lean) - cos(lean)), -half};
        tl_vec3 place = tl_v3_sub(tl_v3(0, 0, sqrt(0.5) - OVERLAP), tl_q_rotate(turn, edge));
        scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(1, 0, 0), TL_PI / 4), tl_v3(0, 0, 0));
        scene_block(m, scene_box_shape(1, 1, 1), tl_q_mul(turn, scene_turn(tl_v3(1, 0, 0), lean)), place);
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        double first = scene_force(m, 0, 1).z, last = first, common = 1;
        CHECK(first > 0);
        for (int i = 0; i < 200; i++) {
            scene_move(m, 1, tl_v3(step, 0, 0), tl_v3(0, 0, 0));
            scene_forces(m);
            double force = scene_force(m, 0, 1).z;
            common -= step;
            /* edges cross over a length of some overlaps over the angle */
            if (angle > 1e-2 ? !CHECK_REL(force, first, 1e-6)
                             : !CHECK(force > 0 && fabs(force - last) <= 2 * step * first))
                break;
            last = force;
        }
        if (angle < 1e-6)
            CHECK_REL(last, common * first, 1e-3);
        tl_model_destroy(m);
    }
}

/* At right angles, both on edges of 90 degrees: what is in is a tetrahedron. */
TEST(crossing_edges_press_with_the_cube_of_their_depth)
{
    for (double d = 1e-5; d < 2e-2; d *= 10) {
        tl_model *m = scene_model(1);
        tl_quat lower = scene_turn(tl_v3(1, 0, 0), TL_PI / 4);
        tl_quat upper = tl_q_mul(scene_turn(tl_v3(0, 0, 1), TL_PI / 2), lower);
        scene_block(m, scene_box_shape(1, 1, 1), lower, tl_v3(0, 0, 0));
        scene_block(m, scene_box_shape(1, 1, 1), upper, tl_v3(0.1, 0.2, sqrt(2) - d));
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        tl_vec3 f = scene_force(m, 0, 1);
        CHECK_REL(f.z, sqrt(2) / 3 * KN * d * d * d, 1e-9);
        CHECK_NEAR(hypot(f.x, f.y), 0, 1e-9 * f.z);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- 2 ---------------------- */

/* A's top is level, with a slope of 14 degrees beside it; B is level too and rests with its lower edge on
 * the slope, beside the top. That A's top is parallel to B's bottom means nothing: they do not meet. */
TEST(parallel_faces_that_do_not_meet_change_nothing)
{
    const double slope = 14 * TL_PI / 180;
    for (double strip = 0.02; strip < 0.2; strip *= 1.5) {
        double t = tan(slope);
        tl_vec3 a[] = {{-1, -1, -1}, {2, -1, -1}, {2, 1, -1}, {-1, 1, -1},     {-1, -1, 0},
                       {0, -1, 0},   {0, 1, 0},   {-1, 1, 0}, {2, -1, -2 * t}, {2, 1, -2 * t}};
        tl_model *m = scene_model(1);
        scene_block(m, scene_hull_shape(a, 10), none, tl_v3(0, 0, 0));
        /* B's lower left edge at x = 0.5, just below the slope there */
        tl_vec3 lift = {1, 0, 0.5 - 0.5 * t - OVERLAP}, up = {sin(slope), 0, cos(slope)};
        scene_block(m, scene_box_shape(1, strip, 1), none, lift);
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        double d = OVERLAP * cos(slope);
        double want = KN * strip * edge_force(slope, TL_PI / 2 - slope, d);
        CHECK_REL(tl_v3_dot(scene_force(m, 0, 1), up), want, 2 * OVERLAP / strip);
        CHECK_NEAR(tl_v3_norm(tl_v3_cross(scene_force(m, 0, 1), up)), 0, 1e-9 * want);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- 3 ---------------------- */

static uint32_t cut(tl_model *m, const char *joint, tl_vec3 normal, tl_vec3 point, bool keep_below)
{
    scene_cut(m, joint, normal, point);
    /* the part on the wrong side goes */
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        double side = tl_v3_dot(normal, tl_v3_sub(tl_block_centroid(m, row), point));
        if ((side > 0) == keep_below) {
            tl_id id = m->blocks.id[row];
            scene_ok(m, tl_blocks_delete(m, &id, 1));
            tl_rows_tidy(m);
            break;
        }
    }
    return tl_joint_intern(m, joint);
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

/* A cube on its edge, tilted by any angle: the force in the middle of the edge. */
TEST(edge_on_face_presses_all_along)
{
    for (double degrees = 16; degrees < 75; degrees += 4.5) {
        double a = degrees * TL_PI / 180;
        tl_model *m = scene_model(1);
        scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
        double height = 0.5 * (sin(a) + cos(a)) - OVERLAP;
        tl_quat q = scene_turn(tl_v3(1, 0, 0), a);
        scene_block(m, scene_box_shape(1, 1, 1), q, tl_v3(0.1, 0.2, height));
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        uint32_t c = scene_contact(m, 0, 1);
        if (CHECK(c != TL_NO_ROW)) {
            double want = KN * edge_force(a, TL_PI / 2 - a, OVERLAP);
            CHECK_REL(scene_force(m, 0, 1).z, want, 2 * OVERLAP);
            tl_vec3 normal, point;
            double gap;
            tl_contact_summary(m, c, &normal, &point, &gap);
            CHECK_NEAR(point.x + m->origin.x, 0.1, 1e-9);
            /* with the force c d^2 a metre a turn about the middle by t is resisted by 2 c d t L^3 / 12, both ways */
            for (int side = -1; side <= 1; side += 2) {
                double turn = side * 1e-3 * OVERLAP;
                scene_put(m, 1, tl_v3(0, 0, 0), scene_turn(tl_v3(0, 1, 0), turn));
                scene_forces(m);
                CHECK_REL(tl_contact_moment(m, c, true).y, -want / OVERLAP / 6 * turn, 2e-3);
            }
        }
        tl_model_destroy(m);
    }
}

TEST(corner_on_face_presses_with_the_cube_of_its_depth)
{
    for (double overlap = 1e-5; overlap < 0.2; overlap *= 10) {
        tl_model *m = scene_model(1);
        scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
        tl_vec3 d = tl_v3_unit(tl_v3(1, 1, 1)), down = {0, 0, -1};
        tl_vec3 axis = tl_v3_cross(d, down);
        tl_quat q = scene_turn(axis, acos(tl_v3_dot(d, down)));
        scene_block(m, scene_box_shape(1, 1, 1), q, tl_v3(0.3, 0.2, sqrt(0.75) - overlap));
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        tl_vec3 f = scene_force(m, 0, 1);
        CHECK_REL(f.z, 0.5 * (3 - sqrt(3)) * KN * pow(overlap, 3), 1e-9);
        CHECK_NEAR(hypot(f.x, f.y), 0, 1e-9 * f.z);
        tl_model_destroy(m);
    }
}

/* A face tilted by an angle, in by d at its lower edge: the angle of that edge with the other face hardly counts. */
TEST(tilted_face_presses_with_the_square_of_its_depth)
{
    for (double degrees = 0.3; degrees < 5; degrees *= 1.5) {
        double a = degrees * TL_PI / 180;
        tl_model *m = scene_model(1);
        scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
        scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(1, 0, 0), a),
                    tl_v3(0, 0, 0.5 * (sin(a) + cos(a)) - OVERLAP));
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        double want = KN * OVERLAP * OVERLAP / (2 * tan(a));
        CHECK_REL(scene_force(m, 0, 1).z, KN * edge_force(a, TL_PI / 2 - a, OVERLAP), 2 * OVERLAP);
        CHECK_REL(scene_force(m, 0, 1).z, want, 2 * a);
        tl_model_destroy(m);
    }
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

/* Cubes that touch along an edge and slide along it: along two directions they overlap by the same for ever, and all that
 * could touch is looked at only after a share of the size. */
TEST(ties_do_not_trigger_the_full_search_every_step)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(1 - OVERLAP, 1 - OVERLAP, 0), tl_v3(2, 2, 1));
    scene_law(m, "elastic", KN, KN, -1);
    tl_contact_area area = {.size = sizeof(tl_contact_area), .absolute = 0.01};
    scene_ok(m, tl_model_contact_area(m, &area));
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 1);
    int searches = 0;
    double last = m->detect->contacts.faces_valid_to[0], step = 2e-7;
    for (int i = 0; i < 1000; i++) {
        scene_move(m, 1, tl_v3(0, 0, step), tl_v3(0, 0, 0));
        scene_forces(m);
        searches += m->detect->contacts.faces_valid_to[0] != last;
        last = m->detect->contacts.faces_valid_to[0];
    }
    CHECK(searches <= 1000 * step / TL_LIST_MARGIN + 2);
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

TEST_MAIN(RUN(nearly_parallel_edges_stay_in_contact), RUN(crossing_edges_press_with_the_cube_of_their_depth),
          RUN(parallel_faces_that_do_not_meet_change_nothing), RUN(joint_is_that_of_a_face_that_touches),
          RUN(edge_on_face_presses_all_along), RUN(corner_on_face_presses_with_the_cube_of_its_depth),
          RUN(tilted_face_presses_with_the_square_of_its_depth), RUN(faces_half_a_degree_apart_share_the_force),
          RUN(ties_do_not_trigger_the_full_search_every_step), RUN(touching_without_area_is_not_looked_at_every_step),
          RUN(tiny_steps_in_large_coordinates_add_up))
