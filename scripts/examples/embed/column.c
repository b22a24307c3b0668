/* column.c - a program that embeds Talus: a deformable block, its zones and gridpoints.
 *
 * A column of rock, 1 m x 1 m x 4 m, stands on a rigid base. Under its own weight the stress at a height z above the foot
 * and the settlement of its top are
 *
 *     s_zz = -density g (4 - z),    u = -density g 4^2 / (2 E)
 *
 * README.md in this folder tells how to build it. */
#include <stdio.h>
#include <stdlib.h>
#include <talus/talus.h>
#include <talus/views.h>
#include <talus/zones.h>

#define DENSITY 2500.0
#define YOUNG 1e9
#define HEIGHT 4.0

/* Ends the program with the model's sentence when a call has failed. */
static void must(const tl_model *model, tl_status status)
{
    if (status == TL_OK)
        return;
    fprintf(stderr, "column: %s\n", tl_model_error(model)->text);
    exit(EXIT_FAILURE);
}

static tl_id build(tl_model *model)
{
    const tl_vec3 foot = {0.5, 0.5, 0};
    tl_block_filter filter = tl_block_filter_default();
    tl_zoning how = tl_zoning_default();
    tl_zoned made;
    tl_id *ids;
    size_t count;
    must(model, tl_generate(model, "box",
                            TL_ARGS(TL_ARG_VECTOR("min", 0, 0, 0), TL_ARG_VECTOR("max", 1, 1, HEIGHT),
                                    tl_arg_number("density", DENSITY)),
                            NULL));
    must(model,
         tl_model_solid(model, "rock", "elastic", TL_ARGS(tl_arg_number("young", YOUNG), tl_arg_number("poisson", 0))));
    filter.containing = &foot;
    must(model, tl_blocks_select(model, &filter, &ids, &count));
    const tl_id column = ids[0];
    how.edge = 0.5;
    how.solid = "rock";
    must(model, tl_blocks_deform(model, ids, count, &how, &made));
    printf("%zu zones, %zu gridpoints\n", made.zones, made.gridpoints);
    free(ids);
    return column;
}

/* Holds what is at the foot. */
static void hold_foot(tl_model *model)
{
    const tl_bounds foot = {{0, 0, 0}, {1, 1, 0}};
    tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *points;
    size_t count;
    filter.inside = &foot;
    must(model, tl_gridpoints_select(model, &filter, &points, &count));
    must(model, tl_gridpoints_fix(model, points, count, TL_FIX_Z));
    free(points);
}

/* The lowest displacement along z of a gridpoint, through a view without a copy. */
static double settlement(tl_model *model, tl_id column)
{
    tl_gridpoint_views of;
    double least = 0;
    must(model, tl_view_gridpoints(model, column, &of));
    for (size_t k = 0; k < of.displacement[2].count; k++) {
        const double u = of.displacement[2].data[of.displacement[2].stride * k];
        least = u < least ? u : least;
    }
    return least;
}

/* The largest error of the stress of a zone, over that of the foot. */
static double stress_error(tl_model *model)
{
    const tl_zone_filter all = tl_zone_filter_default();
    tl_zone_name *zones;
    size_t count, width;
    double most = 0;
    must(model, tl_zones_select(model, &all, &zones, &count));
    double *stress = malloc(6 * count * sizeof *stress), *centroid = malloc(3 * count * sizeof *centroid);
    if (!stress || !centroid)
        exit(EXIT_FAILURE);
    must(model, tl_zones_values(model, zones, count, "stress", stress, &width));
    must(model, tl_zones_values(model, zones, count, "centroid", centroid, &width));
    for (size_t k = 0; k < count; k++) {
        const double wanted = -DENSITY * 10 * (HEIGHT - centroid[3 * k + 2]);
        const double error = stress[6 * k + 2] > wanted ? stress[6 * k + 2] - wanted : wanted - stress[6 * k + 2];
        most = error > most ? error : most;
    }
    free(zones);
    free(stress);
    free(centroid);
    return most / (DENSITY * 10 * HEIGHT);
}

int main(void)
{
    tl_error error;
    tl_model *model;
    tl_model_config config = tl_model_config_default();
    config.gravity = (tl_vec3){0, 0, -10};
    tl_plugins_load_default();
    if (tl_model_create(&config, &model, &error) != TL_OK) {
        fprintf(stderr, "column: %s\n", error.text);
        return EXIT_FAILURE;
    }
    const tl_id column = build(model);
    hold_foot(model);
    must(model, tl_model_damping(model, "local", TL_ARGS(tl_arg_number("alpha", 0.8))));
    tl_solve solve = tl_solve_default();
    tl_solve_result found;
    solve.ratio = 1e-5;
    must(model, tl_model_solve(model, &solve, &found));
    printf("at rest after %lld steps; stress off by %.1f %% of that at the foot\n", (long long)found.cycles,
           100 * stress_error(model));
    printf("settlement %.4f mm, expected %.4f mm\n", -1000 * settlement(model, column),
           1000 * DENSITY * 10 * HEIGHT * HEIGHT / (2 * YOUNG));
    tl_model_destroy(model);
    return EXIT_SUCCESS;
}
