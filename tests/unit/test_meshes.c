/* test_meshes.c - a mesh as a whole: what acts on it, how it moves and turns, and which of its gridpoints are strained. */
#include "cycle/meshes.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/solids.h"
#include "zone_scene.h"
#include <talus/zones.h>

/* A box that gets zones of an edge. */
static tl_model *box_of_zones(double edge)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(1, 2, 3), tl_v3(2, 4, 4));
    scene_solid(m, 1e9, 0.25);
    scene_divide(m, 0, 1, edge);
    return m;
}

/* Velocities and forces of a rigid motion are that motion, and its power. */
TEST(a_rigid_motion_is_all_of_a_mesh)
{
    tl_model *m = box_of_zones(0.5);
    tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *mesh = tl_mesh_of_body(m, 0);
    const tl_vec3 centre = tl_body_place(&m->bodies, 0), v = {1, -2, 0.5}, w = {0.3, 0.1, -0.4};
    CHECK(tl_body_is_free(m, 0));
    tl_vec3 momentum = {0, 0, 0};
    double power = 0;
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
        const tl_vec3 at = tl_v3_add(v, tl_v3_cross(w, arm)), force = tl_v3_scale(3 * p->mass[row], at);
        tl_columns_put(p->v, row, at);
        tl_columns_put(p->force, row, force);
        momentum = tl_v3_add(momentum, force);
        power += tl_v3_dot(force, at);
    }
    const tl_mesh_whole of = tl_mesh_whole_of(m, mesh);
    CHECK(scene_apart(of.velocity, v) < 1e-12);
    CHECK(scene_apart(of.turn, w) < 1e-12);
    CHECK(scene_apart(of.force, momentum) < 1e-9);
    CHECK_NEAR(of.power, power, 1e-9 * power);
    CHECK_NEAR(tl_v3_dot(of.force, of.velocity) + tl_v3_dot(of.moment, of.turn), power, 1e-9 * power);
    CHECK_NEAR(of.borne, 0, 0);
    tl_model_destroy(m);
}

/* A mesh that is carried and turned as a whole has no gridpoint that is strained; of one that is moved it is told. */
TEST(a_gridpoint_is_strained_by_what_it_moves_against_its_body)
{
    tl_model *m = box_of_zones(0.5);
    tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *mesh = tl_mesh_of_body(m, 0);
    const tl_vec3 centre = tl_body_place(&m->bodies, 0), way = {0.1, 0.2, -0.3};
    const tl_quat turn = scene_turn(tl_v3(1, 2, 3), 0.7);
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), centre);
        tl_columns_put(p->u, row, tl_v3_add(way, tl_v3_sub(tl_q_rotate(turn, arm), arm)));
    }
    m->bodies.pose[0].u = way;
    m->bodies.pose[0].r = tl_q_matrix(turn);
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
        CHECK(tl_v3_norm(tl_gridpoint_strained(m, mesh, row)) < 1e-12);
    p->u[1][mesh->point_begin] += 0.01;
    CHECK(scene_apart(tl_gridpoint_strained(m, mesh, mesh->point_begin), tl_v3(0, 0.01, 0)) < 1e-12);
    tl_model_destroy(m);
}

/* Only what can move counts, and what holds gridpoints bears the body. */
TEST(held_gridpoints_bear_their_body)
{
    tl_model *m = box_of_zones(2);
    tl_gridpoints *p = &m->zones->points;
    const tl_body_mesh *mesh = tl_mesh_of_body(m, 0);
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    CHECK(!tl_body_is_free(m, 0));
    p->fixed[mesh->point_begin] = TL_FIX_Z;
    CHECK(tl_body_is_free(m, 0));
    tl_columns_put(p->force, mesh->point_begin, tl_v3(3, 0, -4));
    const tl_mesh_whole of = tl_mesh_whole_of(m, mesh);
    CHECK_NEAR(of.borne, 4, 1e-12);
    CHECK(scene_apart(of.force, tl_v3(3, 0, 0)) < 1e-12);
    tl_model_destroy(m);
}

TEST_MAIN(a_rigid_motion_is_all_of_a_mesh(), a_gridpoint_is_strained_by_what_it_moves_against_its_body(),
          held_gridpoints_bear_their_body())
