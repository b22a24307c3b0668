/* test_joined.c - bodies of several blocks get zones: their blocks share gridpoints, and hang together as one solid does. */
#include "segment/segments.h"
#include "zone/columns.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/solids.h"
#include "zone_scene.h"
#include <talus/zones.h>

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- scenes ----------------- */

/* Joins all blocks from one row on, and divides them. */
static tl_zoned join_and_divide(tl_model *m, uint32_t from, double edge)
{
    const size_t count = m->blocks.table.rows - from;
    if (count > 1)
        scene_ok(m, tl_blocks_join(m, m->blocks.id + from, count));
    return scene_divide(m, from, count, edge);
}

/* A box of 2 m, cut into blocks by random planes: each goes through all of them, or through one alone. */
static tl_model *cut_box(uint64_t seed, int cuts, bool through_one)
{
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(-1, -1, -1), tl_v3(1, 1, 1));
    for (int k = 0; k < cuts; k++) {
        const tl_id one = m->blocks.id[(size_t)k % m->blocks.table.rows];
        tl_id others[64];
        size_t count = 0;
        for (size_t row = 0; row < m->blocks.table.rows; row++)
            if (m->blocks.id[row] != one)
                others[count++] = m->blocks.id[row];
        const tl_vec3 near = tl_v3_scale(0.5, scene_direction(&seed));
        if (through_one)
            scene_ok(m, tl_blocks_hide(m, others, count, true));
        scene_cut(m, "joint", scene_direction(&seed),
                  through_one ? tl_block_centroid(m, tl_block_row_quiet(m, one)) : near);
        if (through_one)
            scene_ok(m, tl_blocks_hide(m, others, count, false));
    }
    return m;
}

/* Eight blocks about a tunnel along y, each of whose ends lies on the side of the next one: four in a ring, and four in
 * one that goes the other way round. */
static tl_model *tunnel(int64_t threads)
{
    static const double box[4][4] = {{0, 2, 0, 1}, {2, 3, 0, 2}, {1, 3, 2, 3}, {0, 1, 1, 3}};
    tl_model *m = scene_model(threads);
    for (int k = 0; k < 4; k++)
        scene_box(m, tl_v3(box[k][0], 0, box[k][2]), tl_v3(box[k][1], 1, box[k][3]));
    for (int k = 0; k < 4; k++)
        scene_box(m, tl_v3(box[k][2], 1, box[k][0]), tl_v3(box[k][3], 2.2, box[k][1]));
    return m;
}

/* ---------------------------------------------------------------- what is made ----------- */

static double volume_of(const tl_model *m, uint32_t mesh)
{
    const struct tl_zones *z = m->zones;
    double sum = 0;
    for (uint32_t k = z->mesh[mesh].parcel_begin; k < z->mesh[mesh].parcel_end; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        for (uint32_t row = z->group[of->group_begin].start; row < z->zones.table.rows; row++) {
            tl_vec3 x[4];
            if (of->group_end < z->group_count && row >= z->group[of->group_end].start)
                break;
            if (z->zones.number[row] == TL_NO_ROW)
                continue;
            for (int a = 0; a < 4; a++)
                x[a] = tl_gridpoint_place(&z->points, z->listed[of->point_begin + z->zones.corner[a][row]]);
            const tl_vec3 b = tl_v3_sub(x[1], x[0]), c = tl_v3_sub(x[2], x[0]), d = tl_v3_sub(x[3], x[0]);
            sum += tl_v3_dot(b, tl_v3_cross(c, d)) / 6;
        }
    }
    return sum;
}

static double surface_of(const tl_model *m)
{
    double sum = 0;
    for (size_t k = 0; k < m->zones->part_count; k++) {
        const uint32_t *c = m->zones->part[k].corner;
        const tl_vec3 x = tl_gridpoint_place(&m->zones->points, c[0]);
        sum += 0.5 * tl_v3_norm(tl_v3_cross(tl_v3_sub(tl_gridpoint_place(&m->zones->points, c[1]), x),
                                            tl_v3_sub(tl_gridpoint_place(&m->zones->points, c[2]), x)));
    }
    return sum;
}

/* Gridpoints have the mass and the centroid of the body; no two are in one place. */
static void check_mesh(const tl_model *m, double volume, double surface)
{
    const tl_gridpoints *p = &m->zones->points;
    CHECK_INT(m->zones->mesh_count, 1);
    const tl_body_mesh *mesh = &m->zones->mesh[0];
    double mass = 0;
    tl_vec3 at = {0, 0, 0};
    size_t twice = 0;
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        mass += p->mass[row];
        at = tl_v3_madd(at, p->mass[row], tl_gridpoint_place(p, row));
        for (uint32_t other = mesh->point_begin; other < row; other++)
            twice += scene_apart(tl_gridpoint_place(p, row), tl_gridpoint_place(p, other)) < 1e-6;
    }
    CHECK_INT(twice, 0);
    CHECK_NEAR(mass / m->bodies.mass[mesh->row], 1, 1e-12);
    CHECK(scene_apart(tl_v3_scale(1 / mass, at), tl_body_place(&m->bodies, mesh->row)) < 1e-12);
    CHECK_NEAR(volume_of(m, 0), volume, 1e-11 * volume);
    CHECK_NEAR(surface_of(m), surface, 1e-11 * surface);
}

/* A linear velocity strains all zones alike, and no gridpoint inside feels a force: nothing parts at the faces between
 * blocks. */
static void check_uniform_strain(tl_model *m)
{
    tl_gridpoints *p = &m->zones->points;
    const double rate[3][3] = {{-1e-3, 2e-4, -3e-4}, {5e-4, -2e-3, 1e-4}, {3e-4, 6e-4, -7e-4}};
    scene_strain(m, rate);
    const tl_zone_table *t = &m->zones->zones;
    double most = 0, most_force = 0, off = 0;
    for (size_t row = 0; row < t->table.rows; row++)
        for (int j = 0; j < 6 && t->number[row] != TL_NO_ROW; j++) {
            most = fmax(most, fabs(t->stress[j][row]));
            off = fmax(off, fabs(t->stress[j][row] - t->stress[j][m->zones->row_of[0]]));
        }
    CHECK(most > 100);
    CHECK(off < 1e-12 * 1e9); /* of the modulus: strains are differences of places */
    for (size_t row = 0; row < p->table.rows; row++)
        for (int i = 0; i < 3; i++)
            if (p->zones[row] > 0 && !p->bare[row])
                most_force = fmax(most_force, fabs(p->force[i][row]));
    CHECK(most_force < 1e-12 * 1e9);
}

/* ---------------------------------------------------------------- tests ------------------ */

TEST(blocks_of_cut_boxes_are_strained_as_one)
{
    for (int through_one = 0; through_one <= 1; through_one++)
        for (uint64_t seed = 1; seed <= 6; seed++) {
            tl_model *m = cut_box(seed, 3, through_one);
            scene_solid(m, 1e9, 0.25);
            CHECK(m->blocks.table.rows > 3);
            const size_t blocks = m->blocks.table.rows;
            const tl_zoned made = join_and_divide(m, 0, 0.45);
            CHECK_INT(made.blocks, blocks);
            check_mesh(m, 8, 24);
            check_uniform_strain(m);
            tl_model_destroy(m);
        }
}

/* The blocks of a model once more, by corners that are rounded to a multiple of a unit. */
static tl_model *rounded(tl_model *from, double unit)
{
    tl_model *m = scene_model(2);
    for (uint32_t row = 0; row < from->blocks.table.rows; row++) {
        const tl_poly *p = from->blocks.shape[row];
        tl_vec3 *x = malloc(p->vertex_count * sizeof *x);
        tl_stage stage;
        for (uint32_t v = 0; v < p->vertex_count; v++) {
            x[v] = tl_v3_scale(1 / unit, tl_model_point(from, from->blocks.body[row], p->vertex[v]));
            x[v] = tl_v3(unit * floor(x[v].x + 0.5), unit * floor(x[v].y + 0.5), unit * floor(x[v].z + 0.5));
        }
        scene_ok(m, stage_begin(m, &stage));
        scene_ok(m, tl_stage_add_hull(&stage, x, p->vertex_count, 2000, "hull"));
        scene_ok(m, tl_stage_commit(&stage));
        free(x);
    }
    return m;
}

/* Corners that are known to seven digits leave faces bent a little, and a little apart. */
TEST(blocks_of_rounded_corners_fit)
{
    for (uint64_t seed = 1; seed <= 6; seed++) {
        tl_model *exact = cut_box(seed, 3, true), *m = rounded(exact, 1e-7);
        scene_solid(m, 1e9, 0.25);
        join_and_divide(m, 0, 0.45);
        CHECK_NEAR(volume_of(m, 0), 8, 1e-5);
        CHECK_NEAR(surface_of(m), 24, 1e-5);
        check_uniform_strain(m);
        tl_model_destroy(m);
        tl_model_destroy(exact);
    }
}

/* A small block on a large one, which lies bare around it. */
TEST(a_small_block_on_a_large_one)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(-2, -2, -1), tl_v3(2, 2, 0));
    scene_box(m, tl_v3(-0.5, -0.3, 0), tl_v3(0.9, 0.4, 1));
    scene_solid(m, 1e9, 0.25);
    join_and_divide(m, 0, 0.5);
    check_mesh(m, 16 + 1.4 * 0.7, 32 + 16 + 2 * (1.4 + 0.7));
    check_uniform_strain(m);
    tl_model_destroy(m);
}

TEST(eight_blocks_about_a_tunnel)
{
    const double edges[3] = {2, 0.5, 0.31};
    for (int k = 0; k < 3; k++) {
        tl_model *m = tunnel(2);
        scene_solid(m, 1e9, 0.25);
        join_and_divide(m, 0, edges[k]);
        check_mesh(m, 8 * 2.2, 2 * 8 + (12 + 4) * 2.2);
        for (size_t p = 0; p < m->zones->part_count; p++)
            CHECK(m->zones->part[p].block >= 1 && m->zones->part[p].block <= 8);
        check_uniform_strain(m);
        tl_model_destroy(m);
    }
}

/* The mean displacement of the top of a column of 1 x 1 x 2 m, held at its foot and pushed aside and down. */
static tl_vec3 pushed(bool joined, double edge)
{
    tl_model *m = scene_model(2);
    if (joined) {
        scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
        scene_box(m, tl_v3(0, 0, 1), tl_v3(1, 1, 2));
    } else {
        scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 2));
    }
    scene_solid(m, 1e9, 0.25);
    join_and_divide(m, 0, edge);
    tl_gridpoints *g = &m->zones->points;
    scene_ok(m, tl_gridpoints_hold_loads(g) ? TL_OK : TL_E_MEMORY);
    for (size_t row = 0; row < g->table.rows; row++)
        if (g->zones[row] > 0 && g->ref[2][row] + m->origin.z < 1e-9)
            g->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    double area = 0;
    tl_vec3 sum = {0, 0, 0};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < m->zones->part_count; k++) {
            const uint32_t *c = m->zones->part[k].corner;
            if (g->ref[2][c[0]] + m->origin.z < 2 - 1e-9 || g->ref[2][c[1]] + m->origin.z < 2 - 1e-9 ||
                g->ref[2][c[2]] + m->origin.z < 2 - 1e-9)
                continue;
            const tl_vec3 x = tl_columns_get(g->ref, c[0]), a = tl_v3_sub(tl_columns_get(g->ref, c[1]), x);
            const double own = 0.5 * tl_v3_norm(tl_v3_cross(a, tl_v3_sub(tl_columns_get(g->ref, c[2]), x)));
            for (int i = 0; i < 3; i++)
                if (pass == 0) {
                    g->load[0][c[i]] += 1e5 * own / 3;
                    g->load[2][c[i]] -= 1e6 * own / 3;
                    area += own / 3;
                } else {
                    sum = tl_v3_madd(sum, own / 3, tl_columns_get(g->u, c[i]));
                }
        }
        if (pass == 1)
            break;
        m->constraints++;
        tl_solve_result result;
        const tl_solve solve = {
            .size = sizeof solve, .ratio = 1e-6, .velocity = NAN, .max_time = NAN, .max_cycles = 20000};
        scene_ok(m, tl_model_damping(m, "local", NULL));
        scene_ok(m, tl_model_solve(m, &solve, &result));
        CHECK_INT(result.reason, TL_SOLVE_RATIO);
    }
    CHECK_NEAR(area, 1, 1e-12);
    tl_model_destroy(m);
    return sum;
}

/* Two joined cubes are as stiff as one block of their shape: as near as two meshes of it are. */
TEST(two_joined_cubes_are_as_stiff_as_one_block)
{
    const tl_vec3 one = pushed(false, 0.3), two = pushed(true, 0.3);
    CHECK(one.x > 1e-4 && one.z < -1e-3);
    CHECK_NEAR(two.x, one.x, 0.03 * one.x);
    CHECK_NEAR(two.z, one.z, -0.005 * one.z);
}

/* The same bits on any number of threads, and after a save. */
TEST(joined_blocks_have_the_same_bits_on_any_threads)
{
    tl_model *m[3];
    tl_error error;
    tl_solve_result result;
    const char *path = "joined_blocks.talus";
    char hash[3][64];
    for (int k = 0; k < 2; k++) {
        m[k] = tunnel(k ? 3 : 1);
        scene_solid(m[k], 1e9, 0.25);
        join_and_divide(m[k], 0, 0.4);
        tl_gridpoints *p = &m[k]->zones->points;
        for (size_t row = 0; row < p->table.rows; row++)
            if (p->zones[row] > 0)
                p->v[0][row] = sin(7.0 * p->ref[1][row]);
        scene_ok(m[k], tl_model_cycle(m[k], 30, &result));
    }
    scene_ok(m[1], tl_model_save(m[1], path));
    CHECK_INT(tl_model_restore(path, 2, NULL, NULL, &m[2], &error), TL_OK);
    CHECK_INT(remove(path), 0);
    for (int k = 0; k < 3; k++) {
        scene_ok(m[k], tl_model_cycle(m[k], 20, &result));
        scene_ok(m[k], tl_state_hash(m[k], hash[k]));
        CHECK_TEXT(hash[k], hash[0]);
    }
    for (int k = 0; k < 3; k++)
        tl_model_destroy(m[k]);
}

/* A joined body that falls and turns ten times has the stress of its turning alone. */
TEST(a_joined_body_turns_ten_times_without_stress_of_its_own)
{
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 0.5, 0.5));
    scene_box(m, tl_v3(0, 0, 0.5), tl_v3(0.4, 0.5, 1));
    scene_box(m, tl_v3(0.4, 0, 0.5), tl_v3(1, 0.5, 1));
    const double w = 2 * TL_PI, density = 2000;
    scene_solid(m, 1e8, 0.25);
    scene_ok(m, tl_blocks_join(m, m->blocks.id, 3));
    m->bodies.w[0] = tl_v3(0, w, 0);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    join_and_divide(m, 0, 0.3);
    tl_solve_result result;
    tl_energy energy;
    tl_zone_energy zones;
    while (m->time < 10)
        scene_ok(m, tl_model_cycle(m, 100, &result));
    scene_ok(m, tl_model_energy(m, &energy));
    scene_ok(m, tl_model_zone_energy(m, &zones));
    CHECK(fabs(energy.balance) < 1e-3);
    double most = 0;
    const tl_zone_table *t = &m->zones->zones;
    for (size_t row = 0; row < t->table.rows; row++)
        for (int j = 0; j < 6; j++)
            most = fmax(most, fabs(t->stress[j][row]));
    CHECK(most < 3 * density * w * w * 0.5); /* of centrifugal forces, twice as much while it swings */
    CHECK(zones.strain < 1e-3 * energy.kinetic);
    CHECK_NEAR(m->bodies.pose[0].u.z, -0.5 * 10 * m->time * m->time, 1e-2 * 500);
    tl_model_destroy(m);
}

/* A stiff cube of two joined blocks, turned, falls on a rigid floor: with zones, and rigid. */
static tl_model *falling(bool deforms, tl_quat turn)
{
    const tl_id floor = 1, both[2] = {2, 3};
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(-4, -4, -2), tl_v3(4, 4, 0));
    scene_block(m, scene_box_shape(1, 1, 0.4), turn, tl_v3_add(tl_v3(0, 0, 1), tl_q_rotate(turn, tl_v3(0, 0, -0.3))));
    scene_block(m, scene_box_shape(1, 1, 0.6), turn, tl_v3_add(tl_v3(0, 0, 1), tl_q_rotate(turn, tl_v3(0, 0, 0.2))));
    scene_solid(m, 1e10, 0.2);
    scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    scene_ok(m, tl_blocks_join(m, both, 2));
    m->bodies.v[1] = tl_v3(0.3, 0, -1);
    if (deforms)
        join_and_divide(m, 1, 0.4);
    return m;
}

/* On an edge, a corner, askew: the contact is that of one of its blocks, and zones of that carry it. */
TEST(a_stiff_joined_cube_falls_as_a_rigid_one)
{
    const tl_vec3 axis[2] = {{1, 1, 0}, {0, 1, 0}};
    const double angle[2] = {0.95, 0.7}, until[2] = {0.16, 0.21};
    for (int k = 0; k < 2; k++) {
        const tl_quat turn = scene_turn(tl_v3_unit(axis[k]), angle[k]);
        tl_model *m[2] = {falling(false, turn), falling(true, turn)};
        tl_solve_result result;
        for (int which = 0; which < 2; which++)
            while (m[which]->time < until[k])
                scene_ok(m[which], tl_model_cycle(m[which], 1, &result));
        CHECK_INT(m[1]->detect->contacts.table.rows, 1);
        tl_energy energy;
        scene_ok(m[1], tl_model_energy(m[1], &energy));
        CHECK(fabs(energy.balance) < 1e-4);
        CHECK(energy.stored > 0);
        const tl_vec3 rigid = m[0]->bodies.pose[1].u, zoned = m[1]->bodies.pose[1].u;
        CHECK(scene_apart(rigid, zoned) < 0.03 * tl_v3_norm(rigid));
        for (int which = 0; which < 2; which++)
            tl_model_destroy(m[which]);
    }
}

/* Blocks of a body come all at once, and go all at once; nothing parts them or joins them to others. */
TEST(bodies_get_zones_whole_and_stay_whole)
{
    tl_model *m = tunnel(1);
    scene_box(m, tl_v3(0, 0, -1), tl_v3(3, 2.2, 0));
    scene_solid(m, 1e9, 0.25);
    scene_law(m, "coulomb", 1e9, 1e9, 30);
    tl_zoned made;
    tl_zoning how = {.size = sizeof how, .edge = 0.6, .solid = "rock"};
    const tl_id all[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    char before[64], after[64];
    scene_ok(m, tl_blocks_join(m, all, 8));
    CHECK_INT(tl_blocks_deform(m, all, 7, &how, &made), TL_E_STATE);
    CHECK(strstr(m->error.text, "it is joined to block 8, which is not among the blocks given") != NULL);
    CHECK_INT(m->zones->mesh_count, 0);
    scene_ok(m, tl_blocks_deform(m, all, 9, &how, &made));
    CHECK_INT(made.blocks, 9);
    CHECK_INT(m->zones->mesh_count, 2);
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, 20, &result));
    CHECK_INT(m->segments->meet_count, 4); /* the lower faces of blocks 1, 4, 5 and 6 on the ninth's upper one */
    double area = 0;
    for (size_t k = 0; k < m->segments->meet_count; k++)
        area += m->segments->meet[k].area;
    CHECK_NEAR(area, 3 * 2.2, 1e-6);
    tl_zone_filter filter = tl_zone_filter_default();
    const tl_id third = 3;
    tl_zone_name *names;
    size_t count;
    filter.blocks = &third;
    filter.block_count = 1;
    scene_ok(m, tl_zones_select(m, &filter, &names, &count));
    CHECK(count > 12);
    for (size_t k = 0; k < count; k++) {
        double block;
        size_t width;
        CHECK_INT(names[k].body, 1);
        scene_ok(m, tl_zones_values(m, &names[k], 1, "block", &block, &width));
        CHECK_NEAR(block, 3, 0);
    }
    free(names);
    scene_ok(m, tl_gridpoints_select(m, &filter, &names, &count));
    for (size_t k = 0; k < count; k++) {
        const tl_vec3 x = tl_v3_add(m->origin, tl_gridpoint_place(&m->zones->points, names[k].number));
        CHECK(x.x > 1 - 1e-3 && x.z > 2 - 1e-3 && x.y < 1 + 1e-3);
    }
    free(names);
    scene_ok(m, tl_state_hash(m, before));
    CHECK_INT(tl_blocks_delete(m, all + 2, 1), TL_E_STATE);
    CHECK(strstr(m->error.text, "cannot delete block 3: it is deformable and joined to block 1") != NULL);
    CHECK_INT(tl_blocks_join(m, all, 9), TL_E_STATE);
    CHECK(strstr(m->error.text, "join or unjoin blocks before they get zones") != NULL);
    CHECK_INT(tl_blocks_unjoin(m, all, 1), TL_E_STATE);
    CHECK_INT(tl_blocks_deform(m, all, 8, &how, &made), TL_E_STATE);
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    stage.count = 5; /* a generator takes the others away */
    CHECK_INT(tl_stage_commit(&stage), TL_E_STATE);
    CHECK(strstr(m->error.text, "is deformable and joined to block 1, which stays") != NULL);
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(before, after);
    scene_ok(m, tl_blocks_delete(m, all, 8));
    scene_ok(m, tl_model_cycle(m, 5, &result));
    CHECK_INT(m->zones->mesh_count, 1);
    CHECK_INT(m->blocks.table.rows, 1);
    tl_model_destroy(m);
}

/* Blocks that had settled on each other when they were joined leave a gap, over which no zones hang together. */
TEST(joined_blocks_with_a_gap_are_refused)
{
    tl_model *m = scene_model(1);
    const tl_id both[2] = {1, 2};
    tl_zoned made;
    const tl_zoning how = {.size = sizeof how, .edge = 0.6, .solid = "rock"};
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1.0003), tl_v3(1, 1, 2));
    scene_solid(m, 1e9, 0.25);
    scene_ok(m, tl_blocks_join(m, both, 2));
    CHECK_INT(tl_blocks_deform(m, both, 2, &how, &made), TL_E_GEOMETRY);
    CHECK(strstr(m->error.text, "blocks 1 and 2 were joined with up to 0.0003 m between their faces") != NULL);
    CHECK_INT(m->zones->mesh_count, 0);
    CHECK_INT(m->bodies.fixed[0], 0);
    tl_model_destroy(m);
}

TEST_MAIN(blocks_of_cut_boxes_are_strained_as_one(), blocks_of_rounded_corners_fit(), a_small_block_on_a_large_one(),
          eight_blocks_about_a_tunnel(), two_joined_cubes_are_as_stiff_as_one_block(),
          joined_blocks_have_the_same_bits_on_any_threads(), a_joined_body_turns_ten_times_without_stress_of_its_own(),
          a_stiff_joined_cube_falls_as_a_rigid_one(), bodies_get_zones_whole_and_stay_whole(),
          joined_blocks_with_a_gap_are_refused())
