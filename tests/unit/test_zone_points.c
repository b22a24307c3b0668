/* test_zone_points.c - points of the material of deformable blocks, driven gridpoints, held blocks, and what a model has of
 * zones. */
#include "zone/zones.h"
#include "zone_scene.h"
#include <talus/zones.h>

#include <stdlib.h>

/* ---------------------------------------------------------------- scenes ----------------- */

/* Two cubes of 2 m in a row along x, the first with zones, far from the origin. */
static tl_model *cubes(unsigned threads, size_t *zoned)
{
    tl_model *m = scene_model(threads);
    scene_box(m, tl_v3(999, -1, -1), tl_v3(1001, 1, 1));
    scene_box(m, tl_v3(1005, -1, -1), tl_v3(1007, 1, 1));
    scene_solid(m, 1e9, 0.25);
    const tl_zoned made = scene_divide(m, 0, 1, 0.6);
    if (zoned)
        *zoned = made.zones;
    return m;
}

static tl_zone_name *all_points(tl_model *m, size_t *count)
{
    const tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *names;
    scene_ok(m, tl_gridpoints_select(m, &filter, &names, count));
    return names;
}

static void run(tl_model *m, int64_t steps)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, steps, &result));
}

/* Where the gridpoints of a point of the material put it. */
static tl_vec3 place_of(tl_model *m, const tl_material_point *point)
{
    double place[12];
    size_t width;
    tl_vec3 sum = {0, 0, 0};
    scene_ok(m, tl_gridpoints_values(m, point->gridpoint, 4, "position", place, &width));
    for (int a = 0; a < 4; a++)
        sum = tl_v3_madd(sum, point->weight[a], tl_v3(place[3 * a], place[3 * a + 1], place[3 * a + 2]));
    return sum;
}

static size_t count_fixed(tl_model *m, int32_t fixed)
{
    tl_block_filter filter = tl_block_filter_default();
    tl_id *ids;
    size_t count;
    filter.fixed = fixed;
    scene_ok(m, tl_blocks_select(m, &filter, &ids, &count));
    free(ids);
    return count;
}

/* ---------------------------------------------------------------- tests ------------------ */

/* Random points lie where their weights say, and go as a linear motion says. */
TEST(points_of_the_material_go_along)
{
    tl_model *m = cubes(1, NULL);
    uint64_t seed = 7;
    enum { POINTS = 200 };
    tl_material_point point[POINTS];
    tl_vec3 at[POINTS];
    for (int k = 0; k < POINTS; k++) {
        at[k] = tl_v3(1000 + scene_between(&seed, -1, 1), scene_between(&seed, -1, 1), scene_between(&seed, -1, 1));
        scene_ok(m, tl_material_point_at(m, at[k], &point[k]));
        double sum = 0;
        for (int a = 0; a < 4; a++) {
            CHECK(point[k].weight[a] > -1e-10 && point[k].weight[a] < 1 + 1e-10);
            sum += point[k].weight[a];
        }
        CHECK_NEAR(sum, 1, 1e-15);
        CHECK(scene_apart(place_of(m, &point[k]), at[k]) < 1e-12);
    }
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        for (int i = 0; i < 3; i++)
            p->u[i][row] = 0.01 * p->ref[(i + 1) % 3][row] + 0.1;
    for (int k = 0; k < POINTS; k++) {
        const tl_vec3 x = tl_v3_sub(at[k], m->origin);
        const tl_vec3 wanted =
            tl_v3(at[k].x + 0.01 * x.y + 0.1, at[k].y + 0.01 * x.z + 0.1, at[k].z + 0.01 * x.x + 0.1);
        CHECK(scene_apart(place_of(m, &point[k]), wanted) < 1e-12);
    }
    CHECK_INT(tl_material_point_at(m, tl_v3(1006, 0, 0), &point[0]), TL_E_NOT_FOUND);
    CHECK_CONTAINS(tl_model_error(m)->text, "(1006, 0, 0) is in no zone");
    tl_model_destroy(m);
}

/* A gradient moves gridpoints as the exponential of it, to second order of the step, on any threads. */
TEST(gradients_drive_gridpoints)
{
    char text[2][33];
    for (int k = 0; k < 2; k++) {
        tl_model *m = cubes(k ? 3 : 1, NULL);
        size_t count, width;
        tl_zone_name *names = all_points(m, &count);
        tl_drive drive = tl_drive_default();
        drive.gradient[0][0] = 20;
        drive.gradient[1][2] = 15;
        drive.at = tl_v3(1000, 0, 0);
        drive.velocity = tl_v3(0, 0, 3);
        double *before = malloc(3 * count * sizeof *before), *after = malloc(3 * count * sizeof *after);
        scene_ok(m, tl_gridpoints_values(m, names, count, "position", before, &width));
        scene_ok(m, tl_gridpoints_drive(m, names, count, &drive));
        CHECK_INT(count_fixed(m, 1), 1);
        scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-4}));
        run(m, 100);
        scene_ok(m, tl_gridpoints_values(m, names, count, "position", after, &width));
        const double grown = exp(20 * 0.01);
        for (size_t i = 0; i < count; i++) {
            const double *x = before + 3 * i, *y = after + 3 * i;
            CHECK_NEAR(y[0], 1000 + (x[0] - 1000) * grown, 1e-6);
            CHECK_NEAR(y[2], x[2] + 0.03, 1e-12);
            CHECK_NEAR(y[1], x[1] + 15 * (x[2] * 0.01 + 0.5 * 3 * 0.01 * 0.01), 1e-9);
        }
        scene_ok(m, tl_state_hash(m, text[k]));
        CHECK_TEXT(text[k], text[0]);
        scene_ok(m, tl_gridpoints_free(m, names, 1, TL_FIX_X | TL_FIX_Y | TL_FIX_Z));
        CHECK_INT(count_fixed(m, 1), 0);
        free(before);
        free(after);
        free(names);
        tl_model_destroy(m);
    }
}

TEST(bad_drives_are_refused)
{
    tl_model *m = cubes(1, NULL);
    size_t count;
    tl_zone_name *names = all_points(m, &count);
    char before[33], after[33];
    scene_ok(m, tl_state_hash(m, before));
    tl_drive drive = tl_drive_default();
    drive.gradient[2][1] = INFINITY;
    CHECK_INT(tl_gridpoints_drive(m, names, count, &drive), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "gradient[3][2] = inf 1/s must be finite");
    drive.gradient[2][1] = 1;
    CHECK_INT(tl_blocks_drive(m, m->blocks.id, 2, &drive), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "a gradient of velocity drives gridpoints");
    drive.angular_velocity = tl_v3(0, 0, 1);
    CHECK_INT(tl_gridpoints_drive(m, names, count, &drive), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "gridpoints do not turn");
    tl_zone_name wrong = {2, 0};
    CHECK_INT(tl_gridpoints_drive(m, &wrong, 1, &drive), TL_E_STALE);
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(after, before);
    drive = tl_drive_default();
    drive.velocity = tl_v3(1, 0, 0);
    scene_ok(m, tl_blocks_drive(m, m->blocks.id, 1, &drive));
    CHECK_INT(tl_gridpoints_drive(m, names, count, &drive), TL_E_STATE);
    CHECK_CONTAINS(tl_model_error(m)->text, "block 1 is driven whole");
    free(names);
    tl_model_destroy(m);
}

TEST(zones_are_summed_up)
{
    size_t zones;
    tl_model *m = cubes(1, &zones);
    const tl_zone_summary of = tl_model_zone_summary(m);
    CHECK_INT(of.blocks, 1);
    CHECK_INT(of.zones, zones);
    CHECK(of.gridpoints > 20 && of.gridpoints < of.zones && of.clusters > of.zones / 10);
    CHECK(of.least_altitude > 0.1 && of.least_altitude < 0.6);
    CHECK_INT(of.worst, 1);
    tl_model_destroy(m);
    m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    const tl_zone_summary none = tl_model_zone_summary(m);
    CHECK(none.zones == 0 && none.blocks == 0 && isnan(none.least_altitude));
    tl_model_destroy(m);
}

TEST_MAIN(points_of_the_material_go_along(), gradients_drive_gridpoints(), bad_drives_are_refused(),
          zones_are_summed_up())
