/* test_invariance.c - what must not matter to contacts: the order of the blocks, motion and offset of the
 * whole model; and what must be continuous or absent: sizes that differ, sliding off, edges passing over
 * edges, corners of eight blocks, torsion. */
#include "contact/contacts.h"
#include "contact_scene.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "model/joints.h"
#include "property/exact_axis.h"

#define KN 1e9
#define OVERLAP 1e-4
/* What the corner of a cube presses with on a face that it is in by d, over kn d^3. */
#define CORNER (0.5 * (3 - sqrt(3)))

static const tl_quat none = {1, 0, 0, 0};

static double contact_area(const tl_model *m, uint32_t a, uint32_t b)
{
    uint32_t c = scene_contact(m, a, b);
    return c == TL_NO_ROW ? 0 : m->detect->contacts.area[c];
}

/* ---------------------------------------------------------------- swaps and motions ------ */

/* A random pair that overlaps a little, made in either order, and placed by a rotation. */
static tl_model *random_pair(uint64_t seed, bool swapped, tl_quat turn, tl_vec3 shift)
{
    tl_model *m = scene_model(1);
    scene_pair p;
    int kind = (int)(3 * check_random(&seed));
    if (kind == 0) {
        p = scene_pair_of(scene_box_shape(1, 1.2, 1), scene_random_hull(&seed, 10, tl_v3(1, 1, 1)),
                          scene_any_turn(&seed), tl_v3_scale(1.7, scene_direction(&seed)));
    } else if (kind == 1) {
        p = scene_pair_of(scene_box_shape(1, 1.2, 1), scene_box_shape(0.8, 1, 1.1),
                          scene_turn(tl_v3(0.1, 0.2, 1), scene_between(&seed, 0, 7)),
                          tl_v3(scene_between(&seed, -0.5, 0.5), scene_between(&seed, -0.5, 0.5), 1.5));
    } else {
        p = scene_pair_of(scene_random_hull(&seed, 12, tl_v3(1, 1, 1)), scene_random_hull(&seed, 12, tl_v3(1, 1, 0.6)),
                          scene_any_turn(&seed), tl_v3_scale(1.9, scene_direction(&seed)));
    }
    exact_press(&p, OVERLAP);
    tl_quat second = tl_q_mul(turn, p.turn);
    tl_vec3 there = tl_v3_add(shift, tl_q_rotate(turn, p.shift));
    if (swapped) {
        scene_block(m, p.b, second, there);
        scene_block(m, p.a, turn, shift);
    } else {
        scene_block(m, p.a, turn, shift);
        scene_block(m, p.b, second, there);
    }
    tl_narrow_scratch_free(&p.scratch);
    scene_law(m, "coulomb", KN, KN, 30);
    scene_forces(m);
    return m;
}

/* Coordinates are rounded to 1e-16, overlaps are 1e-4: forces agree to some 1e-12 times the number of
 * operations. */
#define SAME_FORCE 1e-9

TEST(order_of_the_blocks_does_not_matter)
{
    for (uint64_t seed = 1; seed <= 300; seed++) {
        tl_model *m = random_pair(seed, false, none, tl_v3(0, 0, 0));
        tl_model *s = random_pair(seed, true, none, tl_v3(0, 0, 0));
        tl_vec3 f = scene_force(m, 0, 1), g = scene_force(s, 0, 1);
        CHECK(tl_v3_norm(f) > 0);
        if (!CHECK(scene_apart(f, tl_v3_neg(g)) <= SAME_FORCE * tl_v3_norm(f)))
            printf("  seed %d: %g %g %g and %g %g %g\n", (int)seed, f.x, f.y, f.z, g.x, g.y, g.z);
        if (scene_contact(m, 0, 1) != TL_NO_ROW && scene_contact(s, 0, 1) != TL_NO_ROW) {
            CHECK_REL(contact_area(s, 0, 1), contact_area(m, 0, 1), SAME_FORCE);
            tl_vec3 moment = tl_contact_moment(m, 0, false);
            if (!CHECK(scene_apart(moment, tl_contact_moment(s, 0, true)) <= SAME_FORCE * tl_v3_norm(f)))
                printf("  seed %d: by %g, kinds %u %u\n", (int)seed,
                       scene_apart(moment, tl_contact_moment(s, 0, true)) / tl_v3_norm(f),
                       m->detect->contacts.facet[0].kind, s->detect->contacts.facet[0].kind);
        }
        tl_model_destroy(m);
        tl_model_destroy(s);
    }
}

TEST(motion_of_the_whole_model_turns_the_forces)
{
    uint64_t random = 4;
    for (uint64_t seed = 1; seed <= 300; seed++) {
        tl_quat q = scene_any_turn(&random);
        tl_vec3 shift = tl_v3_scale(10, scene_direction(&random));
        tl_model *m = random_pair(seed, false, none, tl_v3(0, 0, 0));
        tl_model *s = random_pair(seed, false, q, shift);
        tl_vec3 f = tl_q_rotate(q, scene_force(m, 0, 1)), g = scene_force(s, 0, 1);
        if (!CHECK(scene_apart(f, g) <= SAME_FORCE * tl_v3_norm(f)))
            printf("  seed %d: %g %g %g and %g %g %g\n", (int)seed, f.x, f.y, f.z, g.x, g.y, g.z);
        tl_model_destroy(m);
        tl_model_destroy(s);
    }
}

/* The same by moving the bodies of one model, instead of making another. */
TEST(bodies_moved_together_keep_their_forces)
{
    uint64_t random = 6;
    for (uint64_t seed = 1; seed <= 100; seed++) {
        tl_model *m = random_pair(seed, false, none, tl_v3(0, 0, 0));
        tl_vec3 f = scene_force(m, 0, 1), apart = tl_sides_apart(m, (tl_sides){0, 1});
        for (int i = 0; i < 5; i++) {
            tl_quat q = scene_any_turn(&random);
            tl_vec3 u = tl_v3_scale(3, scene_direction(&random));
            scene_put(m, 0, u, q);
            scene_put(m, 1, tl_v3_add(u, tl_v3_sub(tl_q_rotate(q, apart), apart)), q);
            scene_forces(m);
            tl_vec3 g = scene_force(m, 0, 1), want = tl_q_rotate(q, f);
            CHECK(scene_apart(g, want) <= SAME_FORCE * tl_v3_norm(f));
        }
        tl_model_destroy(m);
    }
}

/* Coordinates are multiples of 2^-13, which are exact at 1e6 too: so is everything computed. */
TEST(offset_of_a_million_changes_nothing)
{
    double overlap = 0x1p-13;
    tl_vec3 forces[3];
    const tl_vec3 offsets[3] = {{0, 0, 0}, {1e6, -1e6, 1e6}, {0, 0, 1e6}};
    for (int i = 0; i < 3; i++) {
        tl_model *m = scene_model(1);
        tl_vec3 o = offsets[i];
        scene_box(m, o, tl_v3_add(o, tl_v3(1, 1, 1)));
        scene_box(m, tl_v3_add(o, tl_v3(0.25, 0.5, 1 - overlap)), tl_v3_add(o, tl_v3(1.25, 1.5, 2 - overlap)));
        scene_law(m, "elastic", KN, KN, -1);
        scene_forces(m);
        forces[i] = scene_force(m, 0, 1);
        CHECK_REL(forces[i].z, KN * 0.75 * 0.5 * overlap, 1e-12);
        CHECK(scene_apart(forces[i], forces[0]) <= 1e-9 * forces[0].z);
        tl_model_destroy(m);
    }
    /* one model that reaches from 0 to 1e6 */
    tl_model *m = scene_model(1);
    tl_vec3 o = {1e6, 1e6, -1e6};
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, o, tl_v3_add(o, tl_v3(1, 1, 1)));
    scene_box(m, tl_v3_add(o, tl_v3(0.25, 0.5, 1 - overlap)), tl_v3_add(o, tl_v3(1.25, 1.5, 2 - overlap)));
    scene_law(m, "elastic", KN, KN, -1);
    scene_forces(m);
    CHECK(scene_apart(scene_force(m, 1, 2), forces[0]) <= 1e-9 * forces[0].z);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- sizes, sliding --------- */

/* Roundings of coordinates up to 1e3 over the overlap, cubed. */
#define CUBED 1e-8

TEST(small_block_on_a_huge_one)
{
    for (int order = 0; order < 2; order++)
        for (double x = -499; x < 500; x += 99.9) {
            tl_model *m = scene_model(1);
            if (order)
                scene_box(m, tl_v3(x, 3, -OVERLAP), tl_v3(x + 1, 4, 1 - OVERLAP));
            scene_box(m, tl_v3(-500, -500, -1000), tl_v3(500.5, 500, 0));
            if (!order)
                scene_box(m, tl_v3(x, 3, -OVERLAP), tl_v3(x + 1, 4, 1 - OVERLAP));
            scene_law(m, "coulomb", KN, KN, 30);
            scene_forces(m);
            CHECK_REL(fabs(scene_force(m, 0, 1).z), KN * OVERLAP, 1e-8);
            CHECK_REL(contact_area(m, 0, 1), 1.0, 1e-9);
            tl_model_destroy(m);
            /* and on its corner */
            m = scene_model(1);
            tl_vec3 d = tl_v3_unit(tl_v3(1, 1, 1)), down = {0, 0, -1};
            tl_quat q = scene_turn(tl_v3_cross(d, down), acos(tl_v3_dot(d, down)));
            scene_box(m, tl_v3(-500, -500, -1000), tl_v3(500.5, 500, 0));
            scene_block(m, scene_box_shape(1, 1, 1), q, tl_v3(x, 0.2, sqrt(0.75) - OVERLAP));
            scene_law(m, "coulomb", KN, KN, 30);
            scene_forces(m);
            CHECK_REL(scene_force(m, 0, 1).z, CORNER * KN * pow(OVERLAP, 3), CUBED);
            tl_model_destroy(m);
        }
}

/* B slides off A's edge: flush, or tilted. */
static void slide_off(double tilt_degrees, tl_vec3 about, double allowed)
{
    tl_model *m = scene_model(1);
    double a = tilt_degrees * TL_PI / 180;
    tl_quat q = scene_turn(about, a);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    /* B's lowest point OVERLAP below A's top */
    tl_poly *box = scene_box_shape(1, 1, 1);
    double low = 0;
    for (uint32_t i = 0; i < box->vertex_count; i++)
        low = fmin(low, tl_q_rotate(q, box->vertex[i]).z);
    scene_block(m, box, q, tl_v3(0.5, 0.5, 1 - OVERLAP - low));
    scene_law(m, "coulomb", KN, KN, 30);
    double most = 0, jump = 0, step = 1e-3, start = 0, last = 0;
    for (int i = 0; i < 1300; i++) {
        scene_forces(m);
        double force = tl_v3_norm(scene_force(m, 0, 1));
        if (i == 0)
            start = last = force;
        jump = fmax(jump, fabs(force - last));
        most = fmax(most, force);
        last = force;
        scene_move(m, 1, tl_v3(step, 0, 0), tl_v3(0, 0, 0));
    }
    CHECK(start > 0);
    CHECK_NEAR(last, 0, 0);
    CHECK(jump <= allowed * most);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  tilt %g about %g %g: jump %.3g of %.3g\n", tilt_degrees, about.x, about.y, jump, most);
    tl_model_destroy(m);
}

TEST(sliding_off_an_edge_is_continuous)
{
    slide_off(0, tl_v3(1, 0, 0), 0.003); /* the area shrinks by 1/1000 a step */
    slide_off(0.01, tl_v3(1, 0.2, 0), 0.02);
    slide_off(0.01, tl_v3(0, 1, 0), 0.02);
}

/* B's low edge, along y, passes over A's edge: `side` 1 leads, -1 trails. The steps are a fiftieth of the
 * overlap, for that is the length on which the contact changes over. */
static void pass_edge(double tilt_degrees, int side)
{
    tl_model *m = scene_model(1);
    double a = tilt_degrees * TL_PI / 180, step = OVERLAP / 50;
    double height = 0.5 * (cos(a) + sin(a)), ahead = 0.5 * (cos(a) - sin(a)) * side;
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(0, side, 0), a),
                tl_v3(1 - ahead - 2 * OVERLAP, 0.6, 1 + height - OVERLAP));
    scene_law(m, "coulomb", KN, KN, 30);
    double most = 0, jump = 0, last = 0;
    for (int i = 0; i < 20000; i++) {
        scene_forces(m);
        double force = tl_v3_norm(scene_force(m, 0, 1));
        if (i)
            jump = fmax(jump, fabs(force - last));
        most = fmax(most, force);
        last = force;
        if (force == 0)
            break;
        scene_move(m, 1, tl_v3(step, 0, 0), tl_v3(0, 0, 0));
    }
    CHECK(most > 0);
    CHECK_NEAR(last, 0, 0);
    CHECK(jump <= 0.02 * most);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  edge tilted %g, side %d: jump %.3g of %.3g\n", tilt_degrees, side, jump, most);
    tl_model_destroy(m);
}

TEST(edge_passing_over_an_edge_is_continuous)
{
    for (double tilt = 0.6; tilt < 30; tilt *= 1.5) {
        pass_edge(tilt, 1);
        pass_edge(tilt, -1);
    }
}

/* A cube tips about its lower edge, from flat to standing on the edge: from a patch to a field contact, without a jump. */
TEST(tipping_from_face_to_edge_is_continuous)
{
    for (int reuse = 0; reuse < 2; reuse++) {
        tl_model *m = scene_model(1);
        m->config.reuse_geometry = reuse;
        scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
        scene_box(m, tl_v3(0, 0, -OVERLAP), tl_v3(1, 1, 1 - OVERLAP));
        scene_law(m, "coulomb", KN, KN, 30);
        double last = 0, worst = 0, at = 0;
        for (int i = 0; i <= 22500; i++) {
            double degrees = 0.002 * i;
            tl_quat q = scene_turn(tl_v3(1, 0.05, 0), degrees * TL_PI / 180);
            tl_vec3 arm = {0.5, 0.5, 0.5}; /* from the corner that stays */
            scene_put(m, 1, tl_v3_sub(tl_q_rotate(q, arm), arm), q);
            scene_forces(m);
            double force = scene_force(m, 0, 1).z;
            CHECK(force > 0);
            /* while the patch opens a step of 0.002 degrees is much of the overlap: look beyond */
            double jump = fabs(force - last) / fmax(force, last);
            if (degrees > 0.2 && jump > worst) {
                worst = jump;
                at = degrees;
            }
            last = force;
        }
        CHECK(worst <= 0.02);
        if (getenv("TALUS_TEST_VERBOSE"))
            printf("  tipping: jump %.3g at %g degrees\n", worst, at);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- eight blocks ----------- */

/* Eight cubes pressed together from all sides: neighbours by an edge or a corner carry next to
 * nothing. */
TEST(edges_and_corners_of_eight_blocks_carry_nothing)
{
    for (double overlap = 1e-6; overlap < 5e-4; overlap *= 10) {
        tl_model *m = scene_model(1);
        double s = 1 - overlap;
        for (int i = 0; i < 8; i++) {
            tl_vec3 low = {(i & 1) * s, (i >> 1 & 1) * s, (i >> 2) * s};
            scene_box(m, low, tl_v3_add(low, tl_v3(1, 1, 1)));
        }
        scene_law(m, "coulomb", KN, KN, 30);
        scene_forces(m);
        double face = KN * overlap * (1 - overlap) * (1 - overlap);
        for (uint32_t a = 0; a < 8; a++)
            for (uint32_t b = a + 1; b < 8; b++) {
                uint32_t bits = a ^ b, sides = (bits & 1) + (bits >> 1 & 1) + (bits >> 2);
                double force = tl_v3_norm(scene_force(m, a, b));
                if (sides == 1)
                    CHECK_REL(force, KN * overlap, 3 * overlap + 1e-9);
                else
                    CHECK(force <= 1e-3 * face);
            }
        tl_model_destroy(m);
    }
}

/* A cube cut into eight, under isotropic stress: faces carry the stress on their area, nothing else carries
 * anything, at once and after the whole has been squeezed by 1e-4 more. */
TEST(eight_blocks_under_isotropic_stress)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-1, -1, -1), tl_v3(1, 1, 1));
    const tl_vec3 normals[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) {
        tl_stage stage;
        scene_ok(m, stage_begin(m, &stage));
        uint32_t number = tl_joint_intern(m, "J");
        tl_tag tag = {number, ++m->joints[number - 1].planes};
        scene_ok(m, stage_cut(&stage, normals[k], tl_v3(0, 0, 0), tag, 1));
        scene_ok(m, tl_stage_commit(&stage));
    }
    CHECK_INT(m->blocks.table.rows, 8);
    scene_law(m, "coulomb", KN, KN, 30);
    tl_insitu insitu = {.size = sizeof(tl_insitu), .stress = {.xx = -1e6, .yy = -1e6, .zz = -1e6}};
    scene_ok(m, tl_model_insitu(m, &insitu));
    for (int pass = 0; pass < 2; pass++) {
        scene_forces(m);
        double face = 1e6 + (pass ? KN * OVERLAP : 0);
        int faces = 0;
        for (uint32_t a = 0; a < 8; a++) {
            CHECK(tl_v3_norm(m->bodies.force[a]) <= 3 * 1.01 * face); /* three open sides */
            for (uint32_t b = a + 1; b < 8; b++) {
                tl_vec3 d = tl_v3_sub(tl_block_centroid(m, b), tl_block_centroid(m, a));
                int sides = (fabs(d.x) > 0.5) + (fabs(d.y) > 0.5) + (fabs(d.z) > 0.5);
                double force = tl_v3_norm(scene_force(m, a, b));
                faces += sides == 1;
                if (sides == 1)
                    CHECK_REL(force, face, 5e-4);
                else
                    CHECK(force <= 1e-3 * face);
            }
        }
        CHECK_INT(faces, 12);
        for (uint32_t a = 0; a < 8; a++) {
            tl_vec3 x = tl_block_centroid(m, a);
            tl_vec3 in = {copysign(0.5, -x.x), copysign(0.5, -x.y), copysign(0.5, -x.z)};
            scene_move(m, m->blocks.body[a], tl_v3_scale(OVERLAP, in), tl_v3(0, 0, 0));
        }
    }
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- torsion ---------------- */

/* Spin about the normal of a unit square: moment ks J angle with J = 1/6, both about B and A. */
TEST(spin_about_the_normal_is_resisted)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1 - OVERLAP), tl_v3(1, 1, 2 - OVERLAP));
    scene_law(m, "elastic", KN, 0.5 * KN, -1);
    scene_forces(m);
    double rate = 1e-5, total = 0;
    m->dt = 1;
    for (int i = 0; i < 20; i++) {
        m->bodies.pose[1].w_moved = tl_v3(0, 0, rate);
        scene_move(m, 1, tl_v3(0, 0, 0), tl_v3(0, 0, rate));
        scene_forces(m);
        total += rate;
        CHECK_REL(-tl_contact_moment(m, 0, true).z, 0.5 * KN * total / 6, 1e-3);
        tl_vec3 force = scene_force(m, 0, 1);
        CHECK_NEAR(force.x, 0, 1e-6 * force.z);
        CHECK_NEAR(force.y, 0, 1e-6 * force.z);
    }
    tl_model_destroy(m);
}

/* Pairs of blocks, each of which turns together by 90 degrees about an axis: the shear forces turn with them. */
static void check_shear_turns(tl_vec3 axis, uint32_t pairs, int steps)
{
    tl_model *m = scene_model(1);
    for (uint32_t p = 0; p < pairs; p++) {
        scene_box(m, tl_v3(10 * p, 0, 0), tl_v3(10 * p + 1, 1, 1));
        scene_box(m, tl_v3(10 * p, 0, 1 - OVERLAP), tl_v3(10 * p + 1, 1, 2 - OVERLAP));
    }
    scene_law(m, "elastic", KN, KN, -1);
    scene_forces(m);
    m->dt = 1;
    for (uint32_t p = 0; p < pairs; p++) {
        tl_pose *upper = &m->bodies.pose[2 * p + 1];
        upper->v_moved = tl_v3(1e-6, 0, 0);
        scene_move(m, 2 * p + 1, upper->v_moved, tl_v3(0, 0, 0));
    }
    scene_forces(m);
    tl_vec3 before = scene_force(m, 0, 1), apart = tl_sides_apart(m, (tl_sides){0, 1}), place = apart;
    CHECK_REL(before.x, -KN * 1e-6, 1e-3);
    double angle = TL_PI / 2 / steps;
    tl_vec3 w = tl_v3_scale(angle, axis);
    for (int i = 1; i <= steps; i++) {
        tl_vec3 next = tl_q_rotate(scene_turn(axis, i * angle), apart);
        /* the midpoint's velocity is the one that a step has */
        tl_vec3 v = tl_v3_sub(next, place);
        for (uint32_t p = 0; p < pairs; p++) {
            tl_pose *lower = &m->bodies.pose[2 * p], *upper = &m->bodies.pose[2 * p + 1];
            lower->w_moved = upper->w_moved = w;
            lower->v_moved = tl_v3(0, 0, 0);
            upper->v_moved = v;
            scene_move(m, 2 * p, tl_v3(0, 0, 0), w);
            scene_move(m, 2 * p + 1, v, w);
        }
        place = next;
        scene_forces(m);
    }
    tl_vec3 want = tl_q_rotate(scene_turn(axis, TL_PI / 2), before);
    for (uint32_t p = 0; p < pairs; p++)
        CHECK(scene_apart(scene_force(m, 2 * p, 2 * p + 1), want) <= 1e-3 * tl_v3_norm(before));
    tl_model_destroy(m);
}

/* One pair, and so many that they are worked on side by side; in small steps, and by 45 degrees a step. */
TEST(shear_turns_with_the_blocks)
{
    const tl_vec3 axes[] = {{0, 0, 1}, {1, 0, 0}, {0.3, -0.5, 0.8}};
    for (int k = 0; k < 3; k++)
        for (uint32_t pairs = 1; pairs <= 6; pairs += 5) {
            check_shear_turns(tl_v3_unit(axes[k]), pairs, 1000);
            check_shear_turns(tl_v3_unit(axes[k]), pairs, 2);
        }
}

TEST_MAIN(RUN(order_of_the_blocks_does_not_matter), RUN(motion_of_the_whole_model_turns_the_forces),
          RUN(bodies_moved_together_keep_their_forces), RUN(offset_of_a_million_changes_nothing),
          RUN(small_block_on_a_huge_one), RUN(sliding_off_an_edge_is_continuous),
          RUN(edge_passing_over_an_edge_is_continuous), RUN(tipping_from_face_to_edge_is_continuous),
          RUN(edges_and_corners_of_eight_blocks_carry_nothing), RUN(eight_blocks_under_isotropic_stress),
          RUN(spin_about_the_normal_is_resisted), RUN(shear_turns_with_the_blocks))
