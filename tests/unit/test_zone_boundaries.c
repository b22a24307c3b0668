/* test_zone_boundaries.c - initial stress in deformable blocks, and what acts on their faces: tractions, rollers,
 * velocities, quiet faces; loads and drives of whole blocks. */
#include "segment/segments.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/solids.h"
#include "zone_scene.h"

#include <stdlib.h>
#include <string.h>
#include <talus/boundary.h>
#include <talus/zones.h>

/* ---------------------------------------------------------------- scenes ----------------- */

static void divide(tl_model *m, uint32_t from, double edge)
{
    scene_divide(m, from, m->blocks.table.rows - from, edge);
}

/* A box of zones of 2000 kg/m3, alone. */
static tl_model *box(tl_vec3 min, tl_vec3 max, double edge, double young, double poisson, unsigned threads)
{
    tl_model *m = scene_model(threads);
    scene_box(m, min, max);
    scene_solid(m, young, poisson);
    divide(m, 0, edge);
    return m;
}

static void run(tl_model *m, int64_t steps)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, steps, &result));
}

static tl_boundary_action at_side(tl_side side)
{
    tl_boundary_action a = tl_boundary_action_default();
    a.where.side = (int32_t)side;
    return a;
}

static void put(tl_model *m, tl_boundary_action a)
{
    scene_ok(m, tl_model_boundary(m, &a, 1, false, NULL));
}

static const tl_sym3 squeeze = {.xx = -3e6, .yy = -5e6, .zz = -4e6, .xy = 1e6, .yz = -0.5e6, .zx = 0.7e6};

static void stress_all(tl_model *m, tl_sym3 stress, tl_sym3 gradient, tl_vec3 at)
{
    tl_boundary_action a = tl_boundary_action_default();
    a.loads = true;
    a.stress = stress;
    a.gradient = gradient;
    a.at = at;
    put(m, a);
    tl_insitu insitu = {.size = sizeof insitu, .stress = stress, .gradient = gradient, .at = at};
    scene_ok(m, tl_model_insitu(m, &insitu));
}

static double largest_force(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    double most = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        most = fmax(most, p->zones[row] > 0 ? tl_v3_norm(tl_columns_get(p->force, row)) : 0);
    return most;
}

static double largest_bearing(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    double most = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        most = fmax(most, p->bears[row]);
    return most;
}

static double largest_way(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    double most = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        most = fmax(most, tl_v3_norm(tl_columns_get(p->u, row)));
    return most;
}

static tl_vec3 mean_velocity(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    tl_vec3 sum = {0, 0, 0};
    double mass = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0) {
            sum = tl_v3_madd(sum, p->mass[row], tl_columns_get(p->v, row));
            mass += p->mass[row];
        }
    return tl_v3_scale(1 / mass, sum);
}

static double balance(tl_model *m)
{
    tl_energy energy;
    scene_ok(m, tl_model_energy(m, &energy));
    return fabs(energy.balance);
}

/* ---------------------------------------------------------------- initial stress --------- */

/* A cube under the same stress inside and on all sides is in equilibrium from the first step on, to rounding. */
TEST(a_squeezed_cube_is_at_rest)
{
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), 0.3, 1e9, 0.25, 2);
    stress_all(m, squeeze, (tl_sym3){0}, tl_v3(0, 0, 0));
    run(m, 1);
    CHECK(largest_bearing(m) > 1e4);
    CHECK(largest_force(m) < 1e-12 * largest_bearing(m));
    run(m, 200);
    CHECK(largest_force(m) < 1e-11 * largest_bearing(m));
    CHECK(largest_way(m) < 1e-14);
    tl_model_destroy(m);
}

/* Blocks that stand out over each other, by some triangles and parts of others: what lies bare bears the traction, the
 * segments the rest. So a uniform stress stays as it is, whether the block below has zones or none. */
TEST(ledges_are_at_rest)
{
    const double out[5] = {0.5, 0.37, 0.11, 1e-3, 1e-4};
    for (int k = 0; k < 10; k++) {
        const double x = out[k % 5], y = 0.6 * x;
        tl_model *m = scene_model(1);
        scene_box(m, tl_v3(0, 0, 0), tl_v3(2, 2, 1));
        scene_box(m, tl_v3(x, -y, 1), tl_v3(2 + x, 2 - y, 2));
        scene_solid(m, 1e9, 0.2);
        scene_law(m, "coulomb", 1e10, 5e9, 60);
        divide(m, k < 5 ? 0 : 1, 0.7);
        stress_all(m, squeeze, (tl_sym3){.xx = 1e5, .yy = 2e5, .xy = 3e4}, tl_v3(0, 0, 1));
        run(m, 1);
        CHECK(largest_bearing(m) > 1e4);
        CHECK(largest_force(m) < 1e-10 * largest_bearing(m));
        run(m, 100);
        CHECK(largest_way(m) < 1e-12);
        CHECK(largest_force(m) < 1e-9 * largest_bearing(m));
        tl_model_destroy(m);
    }
}

/* A column of cut rock, turned oddly and 10 km away, under its weight: stress grows with depth, in zones and joints. */
TEST(a_column_of_cut_rock_bears_its_weight)
{
    const tl_quat turn = scene_turn(tl_v3(1, 2, 3), 0.7);
    const tl_vec3 centre = {1e4, -2e4, 3e4};
    tl_model *m = scene_model(2);
    scene_block(m, scene_box_shape(2, 3, 8), turn, centre);
    scene_cut(m, "joint", tl_v3(0.3, 0.2, 1), tl_v3_add(centre, tl_v3(0.1, 0.2, 0.7)));
    scene_cut(m, "joint", tl_v3(1, -0.4, 0.1), tl_v3_add(centre, tl_v3(0.1, 0.1, -1)));
    CHECK(m->blocks.table.rows >= 3);
    scene_solid(m, 1e9, 0.2);
    scene_law(m, "coulomb", 1e10, 5e9, 60);
    divide(m, 0, 0.9);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    const tl_sym3 gradient = {.xx = 1e4, .yy = 8e3, .zz = 2e4};
    stress_all(m, (tl_sym3){.xx = -3e5, .yy = -2e5, .zz = -2e5, .xy = 2e4}, gradient, tl_v3(0, 0, centre.z + 4));
    run(m, 1);
    CHECK(m->segments->meet_count >= 2);
    CHECK(largest_force(m) < 1e-12 * largest_bearing(m));
    run(m, 100);
    CHECK(largest_way(m) < 1e-13);
    CHECK(largest_force(m) < 1e-11 * largest_bearing(m));
    tl_model_destroy(m);
}

/* Joints of zoned blocks on rigid ones carry the stress, too: held rigid blocks about a zoned one need no tractions. */
TEST(a_block_between_held_ones_is_at_rest)
{
    const tl_id held[2] = {1, 2};
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-1, -1, -1), tl_v3(2, 2, 0));
    scene_box(m, tl_v3(-1, -1, 1), tl_v3(2, 2, 2));
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_solid(m, 1e9, 0.25);
    scene_law(m, "coulomb", 1e10, 1e10, 30);
    scene_ok(m, tl_blocks_fix(m, held, 2, TL_FIX_ALL));
    divide(m, 2, 0.3);
    tl_insitu insitu = {.size = sizeof insitu, .stress = {.zz = -1e6, .zx = 2e5}};
    scene_ok(m, tl_model_insitu(m, &insitu));
    tl_boundary_action a = tl_boundary_action_default();
    a.where.box = (tl_bounds){{-0.1, -0.1, -0.1}, {1.1, 1.1, 1.1}};
    a.loads = true;
    a.stress = insitu.stress;
    tl_boundary_result found;
    scene_ok(m, tl_model_boundary(m, &a, 1, false, &found));
    CHECK_NEAR(found.area, 4, 1e-9); /* its two faces on the held blocks are covered */
    tl_boundary_free(&found);
    run(m, 1);
    CHECK(largest_force(m) < 1e-12 * largest_bearing(m));
    tl_vec3 reaction;
    scene_ok(m, tl_blocks_reaction(m, held, 1, &reaction));
    run(m, 100);
    CHECK(largest_way(m) < 1e-14);
    tl_model_destroy(m);
}

/* Initial stress stays with the points of joints when segments are laid anew. */
TEST(initial_forces_stay_when_segments_are_laid_anew)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1), tl_v3(1, 1, 2));
    scene_solid(m, 1e9, 0.25);
    scene_law(m, "coulomb", 1e10, 1e10, 60);
    divide(m, 0, 0.3);
    stress_all(m, (tl_sym3){.zz = -1e6}, (tl_sym3){0}, tl_v3(0, 0, 0));
    run(m, 1);
    for (size_t k = 0; k < m->segments->meet_count; k++)
        m->segments->meet[k].stale = true;
    run(m, 40);
    CHECK(largest_force(m) < 1e-10 * largest_bearing(m));
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- tractions -------------- */

/* A bar under an end load is stretched by p l / E, and thinner by its Poisson's ratio; the ledger closes on the way. */
TEST(a_pulled_bar_is_stretched)
{
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(4, 1, 1), 0.5, 1e9, 0.25, 2);
    tl_boundary_action sides[4] = {at_side(TL_SIDE_XMIN), at_side(TL_SIDE_YMIN), at_side(TL_SIDE_ZMIN),
                                   at_side(TL_SIDE_XMAX)};
    tl_boundary_result found[4];
    sides[0].roller = sides[1].roller = sides[2].roller = true;
    sides[3].loads = true;
    sides[3].stress.xx = 1e5;
    scene_ok(m, tl_model_boundary(m, sides, 4, false, found));
    CHECK_NEAR(found[3].force.x, 1e5, 1e-6);
    CHECK_NEAR(found[3].moment.y, 0.5e5, 1e-6);
    CHECK_NEAR(found[3].area, 1, 1e-12);
    for (int k = 0; k < 4; k++)
        tl_boundary_free(&found[k]);
    run(m, 2000);
    CHECK(balance(m) < 1e-3);
    scene_ok(m, tl_model_damping(m, "local", NULL));
    run(m, 4000);
    const tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0 && fabs(p->ref[0][row] + m->origin.x - 4) < 1e-9) {
            CHECK_NEAR(p->u[0][row], 4e-4, 4e-7); /* strain of 1e-4: the next order */
            CHECK_NEAR(p->u[1][row], -0.25e-4 * (p->ref[1][row] + m->origin.y), 1e-7);
        }
    const tl_id bar = 1;
    tl_vec3 reaction;
    scene_ok(m, tl_blocks_reaction(m, &bar, 1, &reaction));
    CHECK_NEAR(reaction.x, -1e5, 100);
    tl_model_destroy(m);
}

/* A later call takes the place of an earlier one on the same triangles, and lets their gridpoints go; with `add` both
 * act. */
TEST(a_later_boundary_replaces_an_earlier_one)
{
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), 0.5, 1e9, 0.25, 1);
    tl_boundary_action a = at_side(TL_SIDE_ZMAX);
    a.roller = true;
    put(m, a);
    size_t held = 0;
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        held += p->zones[row] > 0 && p->fixed[row] == TL_FIX_Z;
    CHECK(held >= 5);
    a.roller = false;
    a.loads = true;
    a.traction = tl_v3(0, 0, -1e5);
    put(m, a);
    for (size_t row = 0; row < p->table.rows; row++)
        CHECK(p->zones[row] == 0 || p->fixed[row] == 0);
    run(m, 1);
    CHECK_NEAR(mean_velocity(m).z * 2000 / m->dt * 2, -1e5, 1e-4); /* the first kick is half a step */
    const size_t parts = m->zones->outer_count;
    a.traction = tl_v3(0, 0, 2e5);
    scene_ok(m, tl_model_boundary(m, &a, 1, true, NULL));
    CHECK_INT(m->zones->outer_count, parts);
    CHECK_NEAR(m->zones->outer[0].traction.z, 1e5, 1e-9);
    a.traction = tl_v3(0, 0, 3e5);
    put(m, a);
    CHECK_NEAR(m->zones->outer[0].traction.z, 3e5, 1e-9);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- rollers ---------------- */

/* On an oblique plane a roller holds along its normal alone: a turned block slides down it as on ice. */
TEST(a_roller_holds_along_any_normal)
{
    const tl_quat turn = scene_turn(tl_v3(1, -2, 0.5), 0.6);
    const tl_vec3 n = tl_q_rotate(turn, tl_v3(0, 0, 1)), g = {0, 0, -10};
    tl_model *m = scene_model(1);
    scene_block(m, scene_box_shape(1, 1, 1), turn, tl_v3(5, 6, 7));
    scene_solid(m, 1e9, 0.25);
    divide(m, 0, 0.4);
    scene_ok(m, tl_model_set_gravity(m, g));
    tl_boundary_action a = tl_boundary_action_default();
    a.where.normal = tl_v3_neg(n);
    a.where.at = tl_v3_madd(tl_v3(5, 6, 7), -0.5, n);
    a.roller = true;
    put(m, a);
    run(m, 4000);
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 along = tl_v3_madd(g, -tl_v3_dot(g, n), n), v = mean_velocity(m);
    size_t rolled = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0 && tl_v3_norm2(tl_columns_get(p->held[0], row)) > 0) {
            CHECK(fabs(tl_v3_dot(tl_columns_get(p->u, row), n)) < 1e-13);
            rolled++;
        }
    CHECK(rolled >= 9);
    const double t = m->time - 0.5 * m->dt;
    CHECK(scene_apart(tl_v3_madd(v, -tl_v3_dot(v, n), n), tl_v3_scale(t, along)) < 1e-9 * tl_v3_norm(along) * t);
    const tl_id block = 1;
    tl_vec3 reaction;
    scene_ok(m, tl_blocks_reaction(m, &block, 1, &reaction));
    CHECK(tl_v3_norm(tl_v3_cross(reaction, n)) < 1e-9 * tl_v3_norm(reaction));
    CHECK(balance(m) < 1e-3);
    tl_model_destroy(m);
}

/* Two oblique rollers leave the edge between them one direction, along it. */
TEST(two_rollers_leave_their_edge_one_direction)
{
    const tl_quat turn = scene_turn(tl_v3(0.3, 1, -0.5), 0.9);
    const tl_vec3 x = tl_q_rotate(turn, tl_v3(1, 0, 0)), y = tl_q_rotate(turn, tl_v3(0, 1, 0));
    const tl_vec3 z = tl_q_rotate(turn, tl_v3(0, 0, 1));
    tl_model *m = scene_model(1);
    scene_block(m, scene_box_shape(1, 1, 1), turn, tl_v3(0, 0, 0));
    scene_solid(m, 1e9, 0.25);
    divide(m, 0, 0.4);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(1, 2, -3)));
    tl_boundary_action both[2] = {tl_boundary_action_default(), tl_boundary_action_default()};
    both[0].where.facing = tl_v3_neg(z);
    both[1].where.facing = tl_v3_neg(y);
    both[0].where.within = both[1].where.within = 1;
    both[0].roller = both[1].roller = true;
    scene_ok(m, tl_model_boundary(m, both, 2, false, NULL));
    run(m, 300);
    const tl_gridpoints *p = &m->zones->points;
    size_t edge = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0 && tl_v3_norm2(tl_columns_get(p->held[1], row)) > 0) {
            const tl_vec3 u = tl_columns_get(p->u, row);
            CHECK(tl_v3_norm(tl_v3_cross(u, x)) < 1e-12 * tl_v3_norm(u) + 1e-16);
            CHECK(tl_v3_norm(u) > 0);
            edge++;
        }
    CHECK(edge >= 3);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- quiet ------------------ */

static double kinetic(tl_model *m)
{
    tl_energy energy;
    scene_ok(m, tl_model_energy(m, &energy));
    return energy.kinetic + energy.stored;
}

/* A pulse in a bar, of compression (0) or shear (2), that moves along +x. Lets it leave, or come back. */
static double left_over(bool quiet, int component, double *ledger)
{
    const double young = 1e9, poisson = component ? 0.25 : 0, density = 2000, length = 10;
    const double modulus = component ? young / (2 * (1 + poisson)) : young, c = sqrt(modulus / density);
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(length, 1, 1), 0.34, young, poisson, 2);
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++) /* one-dimensional */
        if (p->zones[row] > 0)
            p->fixed[row] = (uint8_t)((TL_FIX_X | TL_FIX_Y | TL_FIX_Z) & ~(1 << component));
    m->constraints++;
    if (quiet) {
        tl_boundary_action a = at_side(TL_SIDE_XMAX);
        a.quiet = true;
        put(m, a);
    }
    /* v = f(x), strain = -f / c: a wave that moves along +x, set by a traction at x = 0 instead */
    tl_boundary_action push = at_side(TL_SIDE_XMIN);
    push.loads = true;
    run(m, 1);
    const double duration = 4 / c; /* the pulse is 4 m long */
    while (m->time < duration) {
        const double s = sin(TL_PI * m->time / duration), size = 1e5 * s * s;
        push.traction = component ? tl_v3(0, 0, size) : tl_v3(size, 0, 0);
        put(m, push);
        run(m, 1);
    }
    push.traction = tl_v3(0, 0, 0);
    put(m, push);
    const double before = kinetic(m);
    while (m->time < 1.6 * length / c)
        run(m, 1);
    *ledger = balance(m);
    const double after = kinetic(m);
    tl_model_destroy(m);
    return after / before;
}

TEST(a_quiet_face_lets_pulses_out)
{
    double ledger;
    for (int component = 0; component <= 2; component += 2) {
        CHECK(left_over(false, component, &ledger) > 0.95);
        CHECK(left_over(true, component, &ledger) < 0.02);
        CHECK(ledger < 5e-3);
    }
}

/* A face that becomes quiet goes on to bear what held it: a column on a roller stands on as it stood. */
TEST(a_quiet_face_bears_what_held_it)
{
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 3), 0.5, 1e9, 0.25, 1);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    tl_boundary_action a = at_side(TL_SIDE_ZMIN);
    a.roller = true;
    put(m, a);
    scene_ok(m, tl_model_damping(m, "local", NULL));
    tl_solve_result result;
    const tl_solve solve = {
        .size = sizeof solve, .ratio = 1e-10, .velocity = NAN, .max_time = NAN, .max_cycles = 100000};
    scene_ok(m, tl_model_solve(m, &solve, &result));
    CHECK_INT(result.reason, TL_SOLVE_RATIO);
    a.roller = false;
    a.quiet = true;
    put(m, a);
    const double way = largest_way(m);
    run(m, 1);
    CHECK(largest_force(m) < 1e-8 * largest_bearing(m));
    run(m, 2000);
    CHECK_NEAR(largest_way(m), way, 1e-6 * way);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- velocities ------------- */

static bool speed_up(void *user, double t, tl_vec3 *velocity)
{
    ++*(int *)user;
    *velocity = tl_v3(0, 0, -0.1 * t);
    return true;
}

static void note_end(void *user)
{
    *(int *)user += 1000000;
}

/* A face follows a function of time, and the block below it is pressed; replaced, the function ends. */
TEST(a_face_follows_a_function)
{
    int calls = 0;
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), 0.5, 1e9, 0, 1);
    tl_boundary_action both[2] = {at_side(TL_SIDE_ZMIN), at_side(TL_SIDE_ZMAX)};
    tl_drive drive = tl_drive_default();
    drive.velocity_at = speed_up;
    drive.user = &calls;
    drive.release = note_end;
    both[0].fixed = true;
    both[1].drive = &drive;
    scene_ok(m, tl_model_boundary(m, both, 2, false, NULL));
    run(m, 500);
    CHECK_INT(calls, 500);
    const tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0 && p->drive[row]) {
            CHECK_NEAR(p->u[2][row], -0.05 * m->time * m->time, 1e-12);
            CHECK_NEAR(p->u[0][row], 0, 0);
        }
    CHECK(balance(m) < 1e-3);
    both[1].drive = NULL;
    both[1].loads = true;
    put(m, both[1]);
    drive = tl_drive_default();
    const tl_id block = 1;
    scene_ok(m, tl_blocks_drive(m, &block, 1, &drive)); /* numbers of drives are used again */
    CHECK_INT(calls, 1000500);
    tl_model_destroy(m);
}

/* Deformable blocks turn with a drive as rigid ones do, without strain. */
TEST(a_driven_block_turns_without_strain)
{
    const tl_id block = 1;
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), 0.5, 1e9, 0.25, 2);
    tl_drive drive = tl_drive_default();
    drive.velocity = tl_v3(0.1, 0, 0);
    drive.angular_velocity = tl_v3(1, 2, 3);
    scene_ok(m, tl_blocks_drive(m, &block, 1, &drive));
    run(m, 1000);
    const tl_quat turn = scene_turn(tl_v3(1, 2, 3), sqrt(14) * m->time);
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 from = tl_v3_sub(tl_v3(0.5, 0.5, 0.5), m->origin), to = tl_v3_madd(from, m->time, drive.velocity);
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0) {
            const tl_vec3 arm = tl_v3_sub(tl_columns_get(p->ref, row), from);
            CHECK(scene_apart(tl_gridpoint_place(p, row), tl_v3_add(to, tl_q_rotate(turn, arm))) < 1e-11);
        }
    for (size_t row = 0; row < m->zones->zones.table.rows; row++)
        CHECK(fabs(m->zones->zones.stress[0][row]) < 1e-3);
    scene_ok(m, tl_blocks_free(m, &block, 1));
    CHECK_INT(m->bodies.drive[0], 0);
    CHECK_INT(m->bodies.fixed[0], TL_FIX_ALL);
    run(m, 10);
    CHECK(scene_apart(mean_velocity(m), drive.velocity) < 1e-9);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- whole blocks ----------- */

/* Sums of forces and moments about a point of the loads on gridpoints. */
static tl_vec3 load_sum(const tl_model *m, tl_vec3 about, tl_vec3 *moment)
{
    const tl_gridpoints *p = &m->zones->points;
    tl_vec3 sum = {0, 0, 0};
    *moment = sum;
    for (size_t row = 0; row < p->table.rows; row++) {
        const tl_vec3 f = tl_columns_get(p->load, row);
        sum = tl_v3_add(sum, f);
        *moment = tl_v3_add(*moment, tl_v3_cross(tl_v3_sub(tl_gridpoint_place(p, row), about), f));
    }
    return sum;
}

TEST(loads_of_blocks_have_their_force_and_moment)
{
    const tl_id block = 1;
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 2, 3), 0.6, 1e9, 0.25, 1);
    tl_vec3 moment;
    tl_load load = tl_load_default();
    load.force = tl_v3(1, 2, 3);
    load.moment = tl_v3(-2, 5, 1);
    scene_ok(m, tl_blocks_load(m, &block, 1, &load));
    CHECK(scene_apart(load_sum(m, tl_v3_sub(tl_v3(0.5, 1, 1.5), m->origin), &moment), load.force) < 1e-12);
    CHECK(scene_apart(moment, load.moment) < 1e-12);
    load.at = tl_v3(0.9, 0.3, 3);
    scene_ok(m, tl_blocks_load(m, &block, 1, &load));
    CHECK(scene_apart(load_sum(m, tl_v3_sub(load.at, m->origin), &moment), load.force) < 1e-12);
    CHECK(scene_apart(moment, load.moment) < 1e-12);
    load.at = tl_v3(3, 0, 0);
    CHECK_INT(tl_blocks_load(m, &block, 1, &load), TL_E_ARGUMENT);
    CHECK(strstr(m->error.text, "lies in no zone of block 1") != NULL);
    load = tl_load_default();
    scene_ok(m, tl_blocks_load(m, &block, 1, &load));
    CHECK_NEAR(tl_v3_norm(load_sum(m, tl_v3(0, 0, 0), &moment)), 0, 0);
    tl_model_destroy(m);
}

/* Loads and drives that a rigid block has go over to its gridpoints. */
TEST(loads_and_drives_go_over_to_zones)
{
    const tl_id loaded = 1, driven = 2, pressed = 3;
    tl_model *m = scene_model(1);
    for (int k = 0; k < 3; k++)
        scene_box(m, tl_v3(3 * k, 0, 0), tl_v3(3 * k + 1, 1, 1));
    scene_solid(m, 1e9, 0.25);
    tl_load load = tl_load_default();
    load.force = tl_v3(0, 0, 700);
    load.moment = tl_v3(0, 10, 0);
    load.at = tl_v3(0.25, 0.5, 0.75);
    scene_ok(m, tl_blocks_load(m, &loaded, 1, &load));
    tl_drive drive = tl_drive_default();
    drive.velocity = tl_v3(0, 0.5, 0);
    scene_ok(m, tl_blocks_drive(m, &driven, 1, &drive));
    divide(m, 0, 0.6);
    tl_vec3 moment;
    CHECK(scene_apart(load_sum(m, tl_v3_sub(load.at, m->origin), &moment), load.force) < 1e-10);
    CHECK(scene_apart(moment, load.moment) < 1e-10);
    CHECK(!tl_body_loaded(&m->bodies, 0));
    run(m, 50);
    const tl_body_mesh *mesh = &m->zones->mesh[1];
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
        CHECK(scene_apart(tl_columns_get(m->zones->points.u, row), tl_v3(0, 0.5 * m->time, 0)) < 1e-15);
    tl_model_destroy(m);

    m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_solid(m, 1e9, 0.25);
    tl_boundary_action a = at_side(TL_SIDE_ZMAX);
    a.loads = true;
    a.stress.zz = -1e3;
    put(m, a);
    const tl_zoning how = {.size = sizeof how, .edge = 0.5, .solid = "rock"};
    tl_zoned made;
    CHECK_INT(tl_blocks_deform(m, &loaded, 1, &how, &made), TL_E_STATE);
    CHECK(strstr(m->error.text, "its faces are loaded") != NULL);
    CHECK_INT(pressed, 3);
    tl_model_destroy(m);
}

TEST(blocks_are_held_and_set_in_motion)
{
    const tl_id block = 1;
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), 0.5, 1e9, 0.25, 1);
    tl_block_set set = tl_block_set_default();
    set.velocity = tl_v3(1, 2, 3);
    set.angular_velocity = tl_v3(0, 0, 2);
    scene_ok(m, tl_blocks_set(m, &block, 1, &set));
    const tl_gridpoints *p = &m->zones->points;
    const tl_vec3 centre = tl_v3_sub(tl_v3(0.5, 0.5, 0.5), m->origin);
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0) {
            const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
            CHECK(scene_apart(tl_columns_get(p->v, row), tl_v3(1 - 2 * arm.y, 2 + 2 * arm.x, 3)) < 1e-12);
        }
    scene_ok(m, tl_blocks_fix(m, &block, 1, TL_FIX_X | TL_FIX_Z));
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0) {
            CHECK_INT(p->fixed[row], TL_FIX_X | TL_FIX_Z);
            CHECK_NEAR(p->v[0][row], 0, 0);
            CHECK(p->v[1][row] > 0.9);
        }
    CHECK_INT(tl_blocks_fix(m, &block, 1, TL_FIX_ROTATION), TL_E_STATE);
    CHECK(strstr(m->error.text, "no rotation to hold") != NULL);
    scene_ok(m, tl_blocks_free(m, &block, 1));
    for (size_t row = 0; row < p->table.rows; row++)
        CHECK(p->zones[row] == 0 || p->fixed[row] == 0);
    scene_ok(m, tl_blocks_fix(m, &block, 1, TL_FIX_ALL));
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    run(m, 2);
    tl_vec3 reaction;
    scene_ok(m, tl_blocks_reaction(m, &block, 1, &reaction));
    CHECK(scene_apart(reaction, tl_v3(0, 0, 20000)) < 1e-8);
    set = tl_block_set_default();
    set.density = 3000;
    CHECK_INT(tl_blocks_set(m, &block, 1, &set), TL_E_STATE);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- state ------------------ */

static bool again(void *user, const tl_drive_asked *asked, tl_drive *drive)
{
    CHECK_INT(asked->block, 2);
    CHECK_INT(asked->bodies, 1);
    CHECK(asked->velocity && !asked->angular_velocity);
    drive->velocity_at = speed_up;
    drive->user = user;
    return true;
}

/* Two blocks with everything on their faces. */
static tl_model *furnished(int *calls, unsigned threads)
{
    const tl_quat turn = scene_turn(tl_v3(1, 2, 3), 0.4);
    tl_model *m = scene_model(threads);
    scene_block(m, scene_box_shape(1, 1, 1), turn, tl_v3(5, 5, 5));
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1), tl_v3(1, 1, 2));
    scene_solid(m, 1e9, 0.25);
    scene_law(m, "coulomb", 1e10, 1e10, 60);
    divide(m, 0, 0.5);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 1, -10)));
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 2e-5}));
    tl_insitu insitu = {.size = sizeof insitu, .stress = {.zz = -2e5}, .gradient = {.zz = 2e4}};
    scene_ok(m, tl_model_insitu(m, &insitu));
    tl_drive drive = tl_drive_default();
    drive.velocity_at = speed_up;
    drive.user = calls;
    const tl_bounds lower = {{-0.1, -0.1, -0.1}, {1.1, 1.1, 1.1}}, upper = {{-0.1, -0.1, 0.9}, {1.1, 1.1, 2.1}};
    const tl_bounds far = {{4, 4, 4}, {7, 7, 7}};
    tl_boundary_action a[5];
    for (int k = 0; k < 5; k++)
        a[k] = tl_boundary_action_default();
    a[0].where.box = lower;
    a[0].where.facing = tl_v3(0, 0, -1);
    a[0].where.within = 10;
    a[0].drive = &drive;
    a[1].where.box = upper;
    a[1].where.facing = tl_v3(0, 0, 1);
    a[1].where.within = 10;
    a[1].loads = true;
    a[1].stress.zz = -3e5;
    a[2].where.box = upper;
    a[2].where.facing = tl_v3(1, 0, 0);
    a[2].where.within = 10;
    a[2].quiet = true;
    for (int k = 3; k < 5; k++) {
        a[k].where.box = far;
        a[k].where.facing = tl_q_rotate(turn, tl_v3(k == 3, k == 4, 0));
        a[k].where.within = 10;
        a[k].roller = true;
    }
    scene_ok(m, tl_model_boundary(m, a, 5, false, NULL));
    return m;
}

/* A copy, and a model that was saved, go on to the same bits; so does one that loses another block. */
TEST(boundaries_are_copied_saved_and_follow)
{
    int calls = 0;
    const char *path = "zone_boundaries.talus";
    tl_model *m = furnished(&calls, 2), *copy, *restored;
    tl_error error;
    char text[3][64];
    run(m, 50);
    scene_ok(m, tl_model_copy(m, again, &calls, &copy));
    scene_ok(m, tl_model_save(m, path));
    CHECK_INT(tl_model_restore(path, 1, NULL, NULL, &restored, &error), TL_E_STATE);
    CHECK(strstr(error.text, "block 2 is driven by a function for its velocity") != NULL);
    if (!CHECK_INT(tl_model_restore(path, 1, again, &calls, &restored, &error), TL_OK)) {
        printf("%s\n", error.text);
        return;
    }
    CHECK_INT(remove(path), 0);
    tl_model *all[3] = {m, copy, restored};
    for (int turn = 0; turn < 2; turn++)
        for (int k = 0; k < 3; k++) {
            scene_ok(all[k], tl_state_hash(all[k], text[k]));
            CHECK_TEXT(text[k], text[0]);
            run(all[k], turn == 0 ? 50 : 0);
        }
    const tl_id far = 1;
    scene_ok(copy, tl_blocks_delete(copy, &far, 1));
    run(copy, 50);
    run(m, 50);
    CHECK(copy->zones->outer_count > 0 && copy->zones->outer_count < m->zones->outer_count);
    for (uint32_t mesh = 0; mesh < 2; mesh++) {
        const tl_body_mesh *of = &copy->zones->mesh[mesh], *was = &m->zones->mesh[mesh + 1];
        for (uint32_t k = 0; k < of->point_end - of->point_begin; k++)
            CHECK_NEAR(scene_apart(tl_columns_get(copy->zones->points.u, of->point_begin + k),
                                   tl_columns_get(m->zones->points.u, was->point_begin + k)),
                       0, 0);
    }
    for (int k = 0; k < 3; k++)
        tl_model_destroy(all[k]);
}

/* Any number of threads gives the same bits. */
TEST(threads_make_no_difference)
{
    int calls = 0;
    char text[2][64];
    for (unsigned k = 0; k < 2; k++) {
        tl_model *m = furnished(&calls, 1 + 3 * k);
        run(m, 100);
        scene_ok(m, tl_state_hash(m, text[k]));
        tl_model_destroy(m);
    }
    CHECK_TEXT(text[0], text[1]);
}

/* Quiet faces resist by the solid that their zones have now. */
TEST(quiet_faces_follow_their_solid)
{
    const tl_id block = 1;
    const tl_value values[] = {{.key = "young", .type = TL_VALUE_NUMBER, .number = 4e9},
                               {.key = "poisson", .type = TL_VALUE_NUMBER, .number = 0.25}};
    tl_model *m = box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), 0.5, 1e9, 0.25, 1);
    tl_boundary_action a = at_side(TL_SIDE_ZMIN);
    a.quiet = true;
    put(m, a);
    run(m, 1);
    double sum[2] = {0, 0};
    const tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        sum[0] += p->quiet[2][row];
    CHECK_NEAR(sum[0], sqrt(2000 * 1.2e9), 1e-3); /* of 1 m2: the square root of density times modulus */
    scene_ok(m, tl_solid_set(m, "stiff", tl_plugin_find(TL_KIND_SOLID, "elastic"), &(tl_args){values, 2}));
    tl_block_set set = tl_block_set_default();
    set.solid = "stiff";
    scene_ok(m, tl_blocks_set(m, &block, 1, &set));
    run(m, 1);
    for (size_t row = 0; row < p->table.rows; row++)
        sum[1] += p->quiet[2][row];
    CHECK_NEAR(sum[1] / sum[0], 2, 1e-12);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- errors ----------------- */

/* What is refused has changed nothing. */
TEST(what_does_not_go_together_is_refused)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(3, 0, 0), tl_v3(4, 1, 1));
    scene_solid(m, 1e9, 0.25);
    divide(m, 1, 0.5);
    char before[64], after[64];
    scene_ok(m, tl_state_hash(m, before));
    tl_boundary_action a = at_side(TL_SIDE_ZMAX);
    a.quiet = true;
    CHECK_INT(tl_model_boundary(m, &a, 1, false, NULL), TL_E_STATE);
    CHECK(strstr(m->error.text, "block 1 is rigid, and only deformable blocks have quiet faces of this sort") != NULL);
    a = at_side(TL_SIDE_XMAX);
    a.quiet = a.roller = true;
    CHECK_INT(tl_model_boundary(m, &a, 1, false, NULL), TL_E_ARGUMENT);
    CHECK(strstr(m->error.text, "a quiet face moves") != NULL);
    tl_drive drive = tl_drive_default();
    a.quiet = false;
    a.drive = &drive;
    CHECK_INT(tl_model_boundary(m, &a, 1, false, NULL), TL_E_ARGUMENT);
    CHECK(strstr(m->error.text, "is held by that") != NULL);
    a.roller = false;
    drive.angular_velocity = tl_v3(0, 0, 1);
    CHECK_INT(tl_model_boundary(m, &a, 1, false, NULL), TL_E_ARGUMENT);
    CHECK(strstr(m->error.text, "do not turn") != NULL);
    a = tl_boundary_action_default();
    a.where.box = (tl_bounds){{3.1, 0.1, 0.1}, {3.2, 0.2, 0.2}};
    a.loads = true;
    CHECK_INT(tl_model_boundary(m, &a, 1, false, NULL), TL_E_NOT_FOUND);
    CHECK(strstr(m->error.text, "no outer face is there") != NULL);
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(before, after);
    const tl_id driven = 2;
    drive = tl_drive_default();
    scene_ok(m, tl_blocks_drive(m, &driven, 1, &drive));
    a = at_side(TL_SIDE_XMAX);
    a.roller = true;
    CHECK_INT(tl_model_boundary(m, &a, 1, false, NULL), TL_E_STATE);
    CHECK(strstr(m->error.text, "block 2 is driven as a whole") != NULL);
    tl_model_destroy(m);
}

TEST_MAIN(a_squeezed_cube_is_at_rest(), ledges_are_at_rest(), a_column_of_cut_rock_bears_its_weight(),
          a_block_between_held_ones_is_at_rest(), initial_forces_stay_when_segments_are_laid_anew(),
          a_pulled_bar_is_stretched(), a_later_boundary_replaces_an_earlier_one(), a_roller_holds_along_any_normal(),
          two_rollers_leave_their_edge_one_direction(), a_quiet_face_lets_pulses_out(),
          a_quiet_face_bears_what_held_it(), a_face_follows_a_function(), a_driven_block_turns_without_strain(),
          loads_of_blocks_have_their_force_and_moment(), loads_and_drives_go_over_to_zones(),
          blocks_are_held_and_set_in_motion(), boundaries_are_copied_saved_and_follow(), threads_make_no_difference(),
          quiet_faces_follow_their_solid(), what_does_not_go_together_is_refused())
