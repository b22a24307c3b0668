/* test_deform.c - blocks of a cut rock get zones: what these fill, share, take over, and how they stand. */
#include "segment/segments.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/solids.h"
#include "zone_scene.h"
#include <talus/zones.h>

#include <string.h>

/* ---------------------------------------------------------------- scenes ----------------- */

/* A box of 2 m, cut by random planes near its centre. */
static tl_model *cut_rock(uint64_t seed, int cuts)
{
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(-1, -1, -1), tl_v3(1, 1, 1));
    for (int k = 0; k < cuts; k++)
        scene_cut(m, "joint", scene_direction(&seed), tl_v3_scale(0.5, scene_direction(&seed)));
    return m;
}

/* Divides all blocks from one row on. */
static tl_zoned divide(tl_model *m, uint32_t from, double edge)
{
    return scene_divide(m, from, m->blocks.table.rows - from, edge);
}

/* ---------------------------------------------------------------- tests ------------------ */

/* Gridpoints have the mass of their block, and its centroid. */
static void check_mass(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    for (size_t k = 0; k < m->zones->mesh_count; k++) {
        const tl_body_mesh *mesh = &m->zones->mesh[k];
        double mass = 0;
        tl_vec3 at = {0, 0, 0};
        for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
            mass += p->mass[row];
            at = tl_v3_madd(at, p->mass[row], tl_gridpoint_place(p, row));
        }
        CHECK_NEAR(mass / m->bodies.mass[mesh->row], 1, 1e-12);
        CHECK(scene_apart(tl_v3_scale(1 / mass, at), tl_body_place(&m->bodies, mesh->row)) < 1e-12);
    }
}

/* Lists of zones have no more room than they need. */
static void check_spare(const struct tl_zones *z)
{
    CHECK_INT(z->group_capacity, z->group_count);
    CHECK_INT(z->listed_capacity, z->listed_count);
    CHECK_INT(z->slot_capacity, z->listed_count);
    CHECK_INT(z->use_capacity, z->listed_count);
    CHECK_INT(z->use_start_capacity, z->points.table.rows + 1);
    CHECK_INT(z->row_of_capacity, z->row_of_count);
    CHECK_INT(z->part_capacity, z->part_count);
}

TEST(zones_fill_the_blocks_of_cut_rock)
{
    for (uint64_t seed = 1; seed <= 10; seed++) {
        tl_model *m = cut_rock(seed, 5);
        scene_solid(m, 1e9, 0.25);
        const size_t blocks = m->blocks.table.rows;
        const tl_zoned made = divide(m, 0, 0.4);
        CHECK_INT(made.blocks, blocks);
        CHECK(made.zones > 12 * blocks && made.gridpoints > 5 * blocks && made.clusters * 10 >= made.zones);
        CHECK(made.least_altitude > 0 && made.least_share > 0);
        check_mass(m);
        check_spare(m->zones);
        tl_model_destroy(m);
    }
}

/* The corner of a surface triangle. */
static tl_vec3 corner(const tl_model *m, const tl_surface_part *part, int k)
{
    return tl_gridpoint_place(&m->zones->points, part->corner[k]);
}

static bool is_same(const tl_model *m, const tl_surface_part *a, const tl_surface_part *b)
{
    int same = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            same += scene_apart(corner(m, a, i), corner(m, b, j)) < 1e-10;
    return same == 3;
}

/* Two blocks of one cut have the same triangles on both sides, at any attitude and place. */
TEST(both_sides_of_a_cut_have_the_same_triangles)
{
    for (uint64_t seed = 1; seed <= 20; seed++) {
        uint64_t random = seed;
        tl_model *m = cut_rock(seed, 0);
        scene_cut(m, "joint", scene_direction(&random), tl_v3_scale(0.3, scene_direction(&random)));
        scene_solid(m, 1e9, 0.25);
        divide(m, 0, 0.5);
        const struct tl_zones *z = m->zones;
        size_t shared = 0, parts[2] = {0, 0};
        for (int side = 0; side < 2; side++)
            for (uint32_t k = z->mesh[side].part_begin; k < z->mesh[side].part_end; k++)
                parts[side] += m->blocks.shape[side]->tag[z->part[k].face].joint != 0;
        for (uint32_t i = z->mesh[0].part_begin; i < z->mesh[0].part_end; i++)
            for (uint32_t j = z->mesh[1].part_begin; j < z->mesh[1].part_end; j++)
                shared += is_same(m, &z->part[i], &z->part[j]);
        CHECK(parts[0] > 3);
        CHECK_INT(shared, parts[0]);
        CHECK_INT(shared, parts[1]);
        tl_model_destroy(m);
    }
}

/* A linear velocity strains all zones of a rock of many blocks alike: no stress of their own, no gap, no force. */
TEST(cut_rock_is_strained_alike)
{
    tl_model *m = cut_rock(7, 4);
    scene_solid(m, 1e9, 0.25);
    scene_law(m, "coulomb", 1e10, 1e10, 30);
    divide(m, 0, 0.5);
    const double rate[3][3] = {{-1e-3, 2e-4, -3e-4}, {5e-4, -2e-3, 1e-4}, {3e-4, 6e-4, -7e-4}};
    scene_strain(m, rate);
    const double g = 1e9 / 2.5, trace = rate[0][0] + rate[1][1] + rate[2][2];
    const double right[6] = {2 * g * rate[0][0] + g * trace, 2 * g * rate[1][1] + g * trace,
                             2 * g * rate[2][2] + g * trace, g * (rate[0][1] + rate[1][0]),
                             g * (rate[1][2] + rate[2][1]),  g * (rate[2][0] + rate[0][2])};
    const tl_zone_table *t = &m->zones->zones;
    for (size_t row = 0; row < t->table.rows; row++)
        for (int j = 0; j < 6 && t->number[row] != TL_NO_ROW; j++) {
            CHECK_NEAR(t->stress[j][row], 1e-3 * right[j], 1e-3 * 1e6 * 3e-6);
            CHECK_NEAR(t->stress[j][row], t->stress[j][m->zones->row_of[0]], 1e-6);
        }
    tl_model_destroy(m);
}

/* Gridpoints go on as their block went: a turning, flying block keeps its momentum. */
TEST(gridpoints_go_on_as_their_block_went)
{
    tl_model *m = cut_rock(3, 3);
    scene_solid(m, 1e9, 0.25);
    m->bodies.v[0] = tl_v3(1, -2, 0.5);
    m->bodies.w[0] = tl_v3(0.1, 0.2, -0.3);
    m->bodies.fixed[1] = TL_FIX_X | TL_FIX_Z;
    const tl_vec3 centre = tl_body_place(&m->bodies, 0);
    divide(m, 0, 0.6);
    const tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *mesh = m->zones->mesh;
    for (uint32_t row = mesh[0].point_begin; row < mesh[0].point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
        const tl_vec3 v = tl_v3_add(tl_v3(1, -2, 0.5), tl_v3_cross(tl_v3(0.1, 0.2, -0.3), arm));
        CHECK(scene_apart(tl_columns_get(p->v, row), v) < 1e-12);
        CHECK_INT(p->fixed[row], 0);
    }
    for (uint32_t row = mesh[1].point_begin; row < mesh[1].point_end; row++)
        CHECK_INT(p->fixed[row], TL_FIX_X | TL_FIX_Z);
    CHECK_INT(m->bodies.fixed[0], TL_FIX_ALL);
    CHECK_NEAR(tl_v3_norm(m->bodies.v[0]), 0, 0);
    tl_model_destroy(m);
}

/* A call that is refused changes nothing. */
TEST(what_cannot_be_divided_is_refused)
{
    tl_model *m = cut_rock(5, 2);
    scene_solid(m, 1e9, 0.25);
    tl_zoned made;
    const tl_id good[2] = {m->blocks.id[0], m->blocks.id[1]}, stale[2] = {m->blocks.id[0], 999};
    tl_zoning how = {.size = sizeof how, .edge = 0.5, .solid = "rock"};
    CHECK_INT(tl_blocks_deform(m, stale, 2, &how, &made), TL_E_STALE);
    how.edge = -1;
    CHECK_INT(tl_blocks_deform(m, good, 2, &how, &made), TL_E_ARGUMENT);
    how.edge = NAN;
    CHECK_INT(tl_blocks_deform(m, good, 2, &how, &made), TL_E_ARGUMENT);
    how = (tl_zoning){.size = sizeof how, .edge = 0.5, .solid = "stone"};
    CHECK_INT(tl_blocks_deform(m, good, 2, &how, &made), TL_E_ARGUMENT);
    CHECK(strstr(m->error.text, "there is no solid 'stone'") != NULL);
    CHECK_INT(m->zones->mesh_count, 0);
    CHECK_INT(m->bodies.fixed[0], 0);
    how.solid = "rock";
    scene_ok(m, tl_blocks_deform(m, good, 1, &how, &made));
    CHECK_INT(tl_blocks_deform(m, good, 2, &how, &made), TL_E_STATE);
    CHECK(strstr(m->error.text, "it has zones already") != NULL);
    CHECK_INT(m->zones->mesh_count, 1);
    CHECK_INT(m->bodies.fixed[1], 0);
    tl_model_destroy(m);
}

/* Cut rock on a rigid floor comes to rest, with its weight on the floor. */
TEST(cut_rock_of_zones_stands)
{
    for (uint64_t seed = 1; seed <= 3; seed++) {
        uint64_t random = seed;
        const tl_id floor = 1;
        tl_model *m = scene_model(2);
        scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
        scene_box(m, tl_v3(-1, -1, 0), tl_v3(1, 1, 2));
        scene_solid(m, 1e10, 0.25);
        for (int k = 0; k < 2; k++) {
            const tl_vec3 tilt = tl_v3_scale(0.2, scene_direction(&random));
            const tl_vec3 normal = tl_v3_unit(tl_v3(tilt.x, tilt.y, 1)), at = {0, 0, 0.6 + 0.7 * k};
            scene_cut(m, "joint", normal, at);
        }
        scene_law(m, "coulomb", 1e10, 1e10, 40);
        scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
        scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
        divide(m, 1, 0.5);
        tl_solve_result result;
        tl_energy energy;
        const tl_solve solve = {
            .size = sizeof solve, .ratio = 1e-5, .velocity = NAN, .max_time = NAN, .max_cycles = 100000};
        scene_ok(m, tl_model_damping(m, "local", NULL));
        scene_ok(m, tl_model_solve(m, &solve, &result));
        CHECK_INT(result.reason, TL_SOLVE_RATIO);
        scene_ok(m, tl_model_energy(m, &energy));
        CHECK(fabs(energy.balance) < 2e-3);
        tl_model_destroy(m);
    }
}

/* Two cubes of zones on a rigid floor, and two blocks far away: a rigid one with a lower number, and zones with a higher
 * one. Both are held. */
static tl_model *cubes_and_far_blocks(void)
{
    const tl_id held[3] = {1, 2, 5};
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(9, 9, 9), tl_v3(10, 10, 10));
    scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
    scene_box(m, tl_v3(-1, -1, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(-1, -1, 1), tl_v3(1, 1, 2));
    scene_box(m, tl_v3(5, 5, 5), tl_v3(6, 6, 6));
    scene_solid(m, 1e9, 0.25);
    scene_law(m, "coulomb", 1e10, 1e10, 40);
    scene_ok(m, tl_blocks_fix(m, held, 3, TL_FIX_ALL));
    scene_ok(m, tl_model_set_gravity(m, tl_v3(1, 0, -10)));
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 2e-5}));
    return m;
}

/* How far the points of two meshes are from each other, m. */
static double apart(const tl_model *a, const tl_model *b, uint32_t mesh_a, uint32_t mesh_b)
{
    const tl_body_mesh *p = &a->zones->mesh[mesh_a], *q = &b->zones->mesh[mesh_b];
    double most = 0;
    CHECK_INT(p->point_end - p->point_begin, q->point_end - q->point_begin);
    for (uint32_t k = 0; k < p->point_end - p->point_begin; k++)
        most = fmax(most, scene_apart(tl_columns_get(a->zones->points.u, p->point_begin + k),
                                      tl_columns_get(b->zones->points.u, q->point_begin + k)));
    return most;
}

/* Meshes and segments follow when rows move and blocks go: what stays goes on as if nothing had gone. */
TEST(meshes_follow_when_blocks_go)
{
    tl_model *m[2] = {cubes_and_far_blocks(), cubes_and_far_blocks()}, *again;
    tl_solve_result result;
    tl_error error;
    const tl_id far[2] = {1, 5}, above = 4;
    const tl_id of[3] = {5, 3, 4};
    const char *path = "meshes_follow.talus";
    const tl_zoning how = {.size = sizeof how, .edge = 0.5, .solid = "rock"};
    tl_zoned made;
    for (int k = 0; k < 2; k++) {
        for (int b = 0; b < 3; b++) /* the mesh of the far block comes first */
            scene_ok(m[k], tl_blocks_deform(m[k], of + b, 1, &how, &made));
        scene_ok(m[k], tl_model_cycle(m[k], 100, &result));
    }
    scene_ok(m[1], tl_blocks_delete(m[1], far, 2));
    scene_ok(m[1], tl_model_save(m[1], path));
    CHECK_INT(tl_model_restore(path, 2, NULL, NULL, &again, &error), TL_OK);
    CHECK_INT(remove(path), 0);
    CHECK_INT(m[1]->zones->mesh_count, 2);
    tl_model *all[3] = {m[0], m[1], again};
    for (int k = 0; k < 3; k++)
        scene_ok(all[k], tl_model_cycle(all[k], 100, &result));
    for (uint32_t mesh = 0; mesh < 2; mesh++)
        for (int k = 1; k < 3; k++)
            CHECK_NEAR(apart(m[0], all[k], mesh + 1, mesh), 0, 0);
    scene_ok(m[1], tl_blocks_delete(m[1], &above, 1));
    scene_ok(m[1], tl_model_cycle(m[1], 100, &result));
    CHECK_INT(m[1]->zones->mesh_count, 1);
    CHECK_INT(m[1]->segments->meet_count, 1);
    for (int k = 0; k < 3; k++)
        tl_model_destroy(all[k]);
}

/* What would part or join a deformable block, or change its mass, is refused, and names it. */
TEST(deformable_blocks_refuse_what_is_for_rigid_ones)
{
    tl_model *m = cut_rock(5, 1);
    scene_solid(m, 1e9, 0.25);
    const tl_id both[2] = {m->blocks.id[0], m->blocks.id[1]};
    const tl_zoning how = {.size = sizeof how, .edge = 0.5, .solid = "rock"};
    tl_zoned made;
    char before[64], after[64];
    scene_ok(m, tl_blocks_deform(m, both + 1, 1, &how, &made));
    tl_block_set set = tl_block_set_default();
    set.density = 3000;
    scene_ok(m, tl_state_hash(m, before));
    CHECK_INT(tl_blocks_fix(m, both, 2, TL_FIX_ROTATION), TL_E_STATE);
    CHECK(strstr(m->error.text, "is deformable; it has no rotation to hold") != NULL);
    CHECK_INT(tl_blocks_join(m, both, 2), TL_E_STATE);
    CHECK_INT(tl_blocks_unjoin(m, both, 2), TL_E_STATE);
    CHECK_INT(tl_blocks_set(m, both, 2, &set), TL_E_STATE);
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    scene_ok(m, stage_cut(&stage, tl_v3(1, 0, 0), tl_v3(0, 0, 0), (tl_tag){.joint = 1, .plane = 9}, 1));
    CHECK_INT(tl_stage_commit(&stage), TL_E_STATE);
    CHECK(strstr(m->error.text, "is deformable and cannot be cut") != NULL);
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(before, after);
    scene_ok(m, tl_blocks_hide(m, both, 2, true));
    tl_model_destroy(m);
}

TEST_MAIN(zones_fill_the_blocks_of_cut_rock(), both_sides_of_a_cut_have_the_same_triangles(),
          cut_rock_is_strained_alike(), gridpoints_go_on_as_their_block_went(), what_cannot_be_divided_is_refused(),
          cut_rock_of_zones_stands(), meshes_follow_when_blocks_go(), deformable_blocks_refuse_what_is_for_rigid_ones())
