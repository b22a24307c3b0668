/* zone_scene.h - what the tests of deformable blocks share: a solid, and blocks that are divided. */
#ifndef TALUS_TESTS_ZONE_SCENE_H
#define TALUS_TESTS_ZONE_SCENE_H

#include "contact_scene.h"

#include <talus/zones.h>

/* Names an elastic solid "rock". */
SCENE_UNUSED static void scene_solid(tl_model *m, double young, double poisson)
{
    const tl_value values[] = {{.key = "young", .type = TL_VALUE_NUMBER, .number = young},
                               {.key = "poisson", .type = TL_VALUE_NUMBER, .number = poisson}};
    tl_error error = {0};
    if (!tl_plugin_find(TL_KIND_SOLID, "elastic"))
        CHECK_INT(tl_plugin_load(TALUS_TEST_PLUGIN_DIR "/solid_elastic.so", &error), TL_OK);
    scene_ok(m, tl_model_solid(m, "rock", "elastic", &(tl_args){values, 2}));
}

/* Divides so many blocks from a row on into zones of "rock". */
SCENE_UNUSED static tl_zoned scene_divide(tl_model *m, uint32_t from, size_t count, double edge)
{
    const tl_zoning how = {.size = sizeof how, .edge = edge, .solid = "rock"};
    tl_zoned made = {0};
    scene_ok(m, tl_blocks_deform(m, m->blocks.id + from, count, &how, &made));
    return made;
}

/* Drives all gridpoints with one velocity gradient, 1/s, for two steps of 1 ms: the second sees the strain. */
SCENE_UNUSED static void scene_strain(tl_model *m, const double rate[3][3])
{
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++) {
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
        for (int i = 0; i < 3; i++)
            p->v[i][row] = rate[i][0] * p->ref[0][row] + rate[i][1] * p->ref[1][row] + rate[i][2] * p->ref[2][row];
    }
    m->constraints++;
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-3}));
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, 2, &result));
}

#endif
