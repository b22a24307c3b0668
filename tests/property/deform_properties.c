/* deform_properties.c - contact of deformable blocks over random models: it makes no energy and no momentum, a stiff block
 * goes as a rigid one does, and the bits do not hang on threads or copies. */
#include "segment/segments.h"
#include "zone/life.h"
#include "zone/solids.h"
#include "zone_scene.h"
#include <talus/zones.h>

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- models ----------------- */

/* How a cube of 1 m falls on a floor. */
typedef struct fall {
    tl_quat turn;
    tl_vec3 velocity, place;
    double kn, ks, friction, young, edge;
    bool cube, floor; /* deformable */
    bool tiled;       /* the floor is of 25 blocks */
} fall;

static fall draw_fall(uint64_t *seed)
{
    static const double tilts[6] = {0, 0.002, 0.05, 0.12, 0.2, 0.7};
    const int which = (int)scene_between(seed, 0, 6);
    const double angle = scene_between(seed, 0, 2 * TL_PI), tilt = tilts[which] * scene_between(seed, 0.5, 1.2);
    const tl_quat spin = scene_turn(tl_v3(0, 0, 1), scene_between(seed, 0, 6));
    const tl_vec3 axis = scene_between(seed, 0, 1) < 0.5 ? tl_v3(cos(angle), sin(angle), 0) : tl_v3(1, 0, 0);
    fall f = {.turn = tl_q_mul(spin, scene_turn(axis, tilt)), .kn = scene_between(seed, 0, 1) < 0.5 ? 1e8 : 1e9};
    f.ks = f.kn * scene_between(seed, 0.3, 1);
    f.friction = scene_between(seed, 0, 1) < 0.3 ? 0 : scene_between(seed, 10, 45);
    f.velocity = tl_v3(scene_between(seed, -1, 1), scene_between(seed, -1, 1), scene_between(seed, -1, 0));
    f.young = f.kn * (scene_between(seed, 0, 1) < 0.5 ? 300 : 30);
    f.edge = scene_between(seed, 0.3, 0.6);
    return f;
}

/* Tile k of a floor of 1.5 m by 1.5 m. */
static void lay_tile(tl_model *m, int k)
{
    const double x = 0.3 * (k % 5) - 0.75, y = 0.3 * (k / 5) - 0.75;
    scene_box(m, tl_v3(x, y, -1), tl_v3(x + 0.3, y + 0.3, 0));
}

/* A floor, held, and the cube just above it, of row 1. */
static tl_model *model_of(const fall *f, unsigned threads)
{
    const tl_id floor = 1;
    tl_model *m = scene_model(threads);
    tl_poly *shape = scene_box_shape(1, 1, 1);
    double low = 0;
    for (uint32_t k = 0; k < shape->vertex_count; k++)
        low = fmin(low, tl_q_rotate(f->turn, shape->vertex[k]).z);
    if (f->tiled)
        lay_tile(m, 0);
    else
        scene_box(m, tl_v3(-1.5, -1.5, -1), tl_v3(1.5, 1.5, 0));
    scene_block(m, shape, f->turn, tl_v3(f->place.x, f->place.y, f->place.z - low + 1e-3));
    for (int k = 1; k < 25 && f->tiled; k++) {
        lay_tile(m, k);
        scene_ok(m, tl_blocks_fix(m, &m->blocks.id[m->blocks.table.rows - 1], 1, TL_FIX_ALL));
    }
    scene_law(m, "coulomb", f->kn, f->ks, f->friction);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    m->bodies.v[1] = f->velocity;
    scene_solid(m, f->young, 0.2);
    if (f->cube)
        scene_divide(m, 1, 1, f->edge);
    if (f->floor)
        scene_divide(m, 0, 1, 0.8);
    else
        scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    tl_gridpoints *p = &m->zones->points;
    const uint32_t mesh = f->floor ? m->bodies.mesh[0] - 1 : TL_NO_ROW;
    for (size_t row = 0; row < p->table.rows; row++)
        if (f->floor && p->mesh[row] == mesh && p->ref[2][row] + m->origin.z < -1 + 1e-9)
            p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    m->constraints++;
    return m;
}

/* The largest error of the energy balance up to a time. */
static double run(tl_model *m, double until)
{
    double worst = 0;
    tl_solve_result result;
    tl_energy e;
    while (m->time < until) {
        scene_ok(m, tl_model_cycle(m, 5, &result));
        scene_ok(m, tl_model_energy(m, &e));
        worst = fmax(worst, fabs(e.balance));
    }
    return worst;
}

/* Cubes that land, slide and rock, flush, on an edge, on a corner, askew, make no energy, whether cube, floor or both
 * are deformable. */
TEST(rocking_makes_no_energy)
{
    for (int k = 0; k < (int)check_cases(5); k++) {
        uint64_t seed = 7919 * (uint64_t)k + 13;
        fall f = draw_fall(&seed);
        for (int which = 1; which < 4; which++) {
            f.cube = which & 1;
            f.floor = which & 2;
            tl_model *m = model_of(&f, 1);
            const double worst = run(m, 0.25);
            CHECK(worst < 1e-3);
            if (!(worst < 1e-3))
                printf("    seed %d, which %d: %g\n", k, which, worst);
            tl_model_destroy(m);
        }
    }
}

/* A cube that tips through 10 degrees of tilt hands its segments over to a field contact, and back. */
TEST(a_cube_that_tips_keeps_its_energy)
{
    const double tilts[3] = {9, 12, 14};
    for (int k = 0; k < 3; k++) {
        const fall f = {.turn = scene_turn(tl_v3(0.3 * k, 1, 0), tilts[k] * TL_PI / 180),
                        .kn = 1e8,
                        .ks = 1e8,
                        .friction = 30,
                        .young = 1e10,
                        .edge = 0.4,
                        .cube = true};
        tl_model *m = model_of(&f, 1);
        bool alone = false, shared = false;
        double worst = 0;
        while (m->time < 0.4) {
            worst = fmax(worst, run(m, m->time + 1e-3));
            for (size_t i = 0; i < m->segments->meet_count; i++) {
                alone = alone || m->segments->meet[i].alone;
                shared = shared || (m->segments->meet[i].flat > 0.1 && m->segments->meet[i].flat < 0.9);
            }
        }
        CHECK(alone && shared);
        CHECK(worst < 2e-4);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- momentum --------------- */

typedef struct momentum {
    tl_vec3 linear, angular;
    double size, turns; /* sums of sizes */
} momentum;

static momentum momentum_of(const tl_model *m)
{
    momentum out = {.size = 0};
    const tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++) {
        if (p->zones[row] == 0)
            continue;
        const tl_vec3 v = tl_columns_get(p->v, row), x = tl_gridpoint_place(p, row);
        /* the place half a step back, where the velocity is */
        const tl_vec3 at = tl_v3_madd(x, -0.5 * m->dt, v);
        out.linear = tl_v3_madd(out.linear, p->mass[row], v);
        out.angular = tl_v3_madd(out.angular, p->mass[row], tl_v3_cross(at, v));
        out.size += p->mass[row] * tl_v3_norm(v);
        out.turns += p->mass[row] * tl_v3_norm(tl_v3_cross(at, v));
    }
    return out;
}

/* Two hulls that fly into each other. */
static tl_model *two_hulls(uint64_t seed, double friction, unsigned threads)
{
    tl_model *m = scene_model(threads);
    for (int k = 0; k < 2; k++) {
        tl_poly *shape = k ? scene_box_shape(1, 0.8, 1.1) : scene_random_hull(&seed, 10, tl_v3(0.6, 0.7, 0.5));
        const tl_quat turn = scene_between(&seed, 0, 1) < 0.5 ? scene_turn(tl_v3(0, 0, 1), 0) : scene_any_turn(&seed);
        scene_block(m, shape, turn,
                    tl_v3(k ? 0.9 : -0.9, scene_between(&seed, -0.3, 0.3), scene_between(&seed, -0.3, 0.3)));
        m->bodies.v[k] = tl_v3(k ? -2 : 2, scene_between(&seed, -0.5, 0.5), scene_between(&seed, -0.5, 0.5));
    }
    scene_law(m, "coulomb", 1e8, 1e8, friction);
    scene_solid(m, 3e9, 0.2);
    for (uint32_t k = 0; k < 2; k++)
        scene_divide(m, k, 1, 0.5);
    return m;
}

/* Momentum and angular momentum stay to rounding, energy to the error of the march. */
TEST(impacts_keep_momentum)
{
    for (int k = 1; k < 5; k++) {
        tl_model *m = two_hulls((uint64_t)k * 77 + 1, k % 2 ? 30 : 0, 1);
        const momentum before = momentum_of(m);
        const double worst = run(m, 0.3);
        const momentum after = momentum_of(m);
        CHECK(worst < 1e-3);
        CHECK(tl_v3_norm(tl_v3_sub(before.linear, after.linear)) < 1e-12 * before.size);
        CHECK(tl_v3_norm(tl_v3_sub(before.angular, after.angular)) < 1e-11 * before.turns);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- stiff blocks ----------- */

/* How many times as large as that of a cube of 1 m the moment of inertia of its mesh is. */
static double mesh_inertia(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    tl_vec3 first = {0, 0, 0};
    double mass = 0, second = 0;
    for (size_t row = 0; row < p->table.rows; row++) {
        mass += p->mass[row];
        first = tl_v3_madd(first, p->mass[row], tl_gridpoint_place(p, row));
    }
    for (size_t row = 0; row < p->table.rows; row++)
        second += p->mass[row] * tl_v3_norm2(tl_v3_madd(tl_gridpoint_place(p, row), -1 / mass, first));
    return second / (mass / 4);
}

/* A stiff cube goes as a rigid one of its moments of inertia, on a face, an edge, a corner, askew. Where it lands flush
 * the floor of the rigid one is of tiles, as segments are. Of a face that opens in part, parts stick while others slide.
 * On one block it goes 6 % another way, whatever zones, stiffness and step. */
TEST(a_stiff_cube_goes_as_a_rigid_one)
{
    const double tilts[5] = {0, 0.03, 0.13, 0.4, 0.75};
    for (int k = 0; k < 5; k++) {
        fall f = {.turn = scene_turn(tl_v3(k == 4 ? 0.8 : 0.1, 1, 0), tilts[k]),
                  .velocity = {0.5, 0.2, -0.3},
                  .kn = 1e8,
                  .ks = 1e8,
                  .friction = 25,
                  .young = 1e11,
                  .edge = 0.35};
        tl_vec3 u[2];
        double inertia = 1;
        for (int which = 0; which < 2; which++) {
            f.cube = which == 0;
            f.tiled = which == 1 && k == 0;
            tl_model *m = model_of(&f, 1);
            if (f.cube) {
                inertia = mesh_inertia(m);
            } else {
                m->bodies.moments[1] = tl_v3_scale(inertia, m->bodies.moments[1]);
                m->bodies.round[1] *= inertia;
                /* about as short as that of zones */
                scene_ok(
                    m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-5}));
            }
            run(m, 0.05);
            u[which] = m->bodies.pose[1].u;
            tl_model_destroy(m);
        }
        CHECK(scene_apart(u[0], u[1]) < 0.01 * tl_v3_norm(u[1]));
        if (!(scene_apart(u[0], u[1]) < 0.01 * tl_v3_norm(u[1])))
            printf("    %d: %g of %g\n", k, scene_apart(u[0], u[1]), tl_v3_norm(u[1]));
    }
}

/* A brick that hangs over the end of another by little is borne from below, and not pushed aside. */
TEST(ends_of_bricks_do_not_push)
{
    const double slip[3] = {0.1, 0.01, 0.003}, over = 1e-4;
    for (int k = 0; k < 3; k++) {
        tl_model *m = scene_model(1);
        tl_solve_result result;
        scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
        scene_box(m, tl_v3(1 - slip[k], 0, 1 - over), tl_v3(2 - slip[k], 1, 2 - over));
        scene_law(m, "coulomb", 1e9, 1e9, 0);
        scene_solid(m, 1e12, 0.2);
        scene_divide(m, 0, 1, 0.5);
        scene_divide(m, 1, 1, 0.5);
        scene_ok(m, tl_model_cycle(m, 1, &result));
        tl_vec3 sum = {0, 0, 0};
        const tl_body_mesh *mesh = &m->zones->mesh[1];
        for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
            sum = tl_v3_add(sum, tl_columns_get(m->zones->points.force, row));
        CHECK_NEAR(sum.z, 1e9 * slip[k] * over, 1e-6 * 1e9 * slip[k] * over);
        CHECK(hypot(sum.x, sum.y) < 1e-6 * sum.z);
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- piles ------------------ */

static tl_model *pile(uint64_t seed, int count, unsigned threads, bool deforms, double edge)
{
    const tl_id floor = 1;
    tl_model *m = scene_model(threads);
    scene_box(m, tl_v3(-4, -4, -1), tl_v3(4, 4, 0));
    for (int k = 0; k < count; k++) {
        tl_poly *shape = scene_random_hull(&seed, 12, tl_v3(0.5, 0.5, 0.5));
        scene_block(m, shape, scene_any_turn(&seed),
                    tl_v3(1.05 * (k % 3) - 1, 1.05 * (k / 3 % 3) - 1, 0.6 + 1.05 * (k / 9)));
    }
    scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    scene_solid(m, 3e9, 0.2);
    for (uint32_t k = 1; deforms && k < m->blocks.table.rows; k++)
        scene_divide(m, k, 1, edge);
    return m;
}
/* The bits do not hang on threads, nor on a copy in the middle of the run; the ledger holds. */
TEST(piles_have_the_same_bits)
{
    char text[4][33];
    for (int k = 0; k < 3; k++) {
        tl_model *m = pile(3, 9, 1u << k, true, 0.9), *copy = NULL;
        CHECK(run(m, 0.2) < 1e-3);
        if (k == 0)
            scene_ok(m, tl_model_copy(m, NULL, NULL, &copy));
        run(m, 0.24);
        scene_ok(m, tl_state_hash(m, text[k]));
        CHECK_TEXT(text[k], text[0]);
        CHECK(m->detect->contacts.table.rows + m->segments->meet_count > 0);
        if (copy) {
            run(copy, 0.24);
            scene_ok(copy, tl_state_hash(copy, text[3]));
            CHECK_TEXT(text[3], text[0]);
            tl_model_destroy(copy);
        }
        tl_model_destroy(m);
    }
}

/* Soft hulls that overlap by centimetres tilt from segments to field contacts while they slip. What slip lets go at once
 * is heat by as much as it takes from both: the balance changes by no more in a step than the march makes it. */
TEST(soft_piles_do_not_jump)
{
    tl_model *m = pile(1, 30, 1, true, 0.9);
    tl_solve_result result;
    tl_energy e;
    double before = 0, jump = 0;
    scene_ok(m, tl_model_cycle(m, 29400, &result));
    for (int k = 0; k < 200; k++) {
        scene_ok(m, tl_model_energy(m, &e));
        jump = k ? fmax(jump, fabs(e.balance - before)) : 0;
        before = e.balance;
        scene_ok(m, tl_model_cycle(m, 1, &result));
    }
    CHECK(jump < 2e-4);
    CHECK(m->segments->blend_count > 0);
    tl_model_destroy(m);
}

TEST_MAIN(rocking_makes_no_energy(), a_cube_that_tips_keeps_its_energy(), impacts_keep_momentum(),
          a_stiff_cube_goes_as_a_rigid_one(), ends_of_bricks_do_not_push(), piles_have_the_same_bits(),
          soft_piles_do_not_jump())
