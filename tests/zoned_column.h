/* zoned_column.h - a column of zones between a floor that is held and a block that presses it. */
#ifndef TALUS_TESTS_ZONED_COLUMN_H
#define TALUS_TESTS_ZONED_COLUMN_H

#include "check.h"

#include <talus/zones.h>

static tl_id column_block(tl_model *m, const double min[3], const double max[3])
{
    const tl_value values[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = min, .count = 3},
                               {.key = "max", .type = TL_VALUE_NUMBERS, .data = max, .count = 3},
                               {.key = "density", .type = TL_VALUE_NUMBER, .number = 2500}};
    const tl_args args = {values, 3};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "box", &args, &summary), TL_OK);
    return (tl_id)tl_block_count(m);
}

/* Fills an empty model: block 1 is the floor, block 2 the column of 2 x 1 x 3, block 3 lies on it. The zones yield under
 * what they bear. */
static void zoned_column(tl_model *m, double edge)
{
    const double floor_min[] = {-1, -1, -1}, floor_max[] = {3, 2, 0}, min[] = {0, 0, 0}, max[] = {2, 1, 3};
    const double top_min[] = {0, 0, 3}, top_max[] = {2, 1, 4};
    const tl_id floor = column_block(m, floor_min, floor_max), middle = column_block(m, min, max);
    column_block(m, top_min, top_max);
    const tl_value law[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e10},
                            {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e10},
                            {.key = "friction", .type = TL_VALUE_NUMBER, .number = 30}};
    const tl_args args = {law, 3};
    CHECK_INT(tl_joint_law(m, "*", "coulomb", &args), TL_OK);
    CHECK_INT(tl_blocks_fix(m, &floor, 1, TL_FIX_ALL), TL_OK);
    const tl_value rock[] = {{.key = "young", .type = TL_VALUE_NUMBER, .number = 1e9},
                             {.key = "poisson", .type = TL_VALUE_NUMBER, .number = 0.3},
                             {.key = "cohesion", .type = TL_VALUE_NUMBER, .number = 2e4},
                             {.key = "friction", .type = TL_VALUE_NUMBER, .number = 20},
                             {.key = "tension", .type = TL_VALUE_NUMBER, .number = 1e4}};
    const tl_args of_rock = {rock, 5};
    tl_error error = {0};
    if (!tl_plugin_find(TL_KIND_SOLID, "mohr_coulomb"))
        CHECK_INT(tl_plugin_load(TALUS_TEST_PLUGIN_DIR "/solid_mohr_coulomb.so", &error), TL_OK);
    CHECK_INT(tl_model_solid(m, "rock", "mohr_coulomb", &of_rock), TL_OK);
    tl_zoning how = tl_zoning_default();
    how.edge = edge;
    how.solid = "rock";
    tl_zoned made;
    CHECK_INT(tl_blocks_deform(m, &middle, 1, &how, &made), TL_OK);
}

#endif
