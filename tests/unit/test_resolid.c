/* test_resolid.c - zones get another solid: what stays, what is laid anew, and what the balance makes of it. */
#include "contact_scene.h"
#include "zone/grid.h"
#include "zone/solids.h"
#include <talus/zones.h>

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- scenes ----------------- */

static void load_solid(const char *name)
{
    tl_error error = {0};
    char path[1024];
    if (tl_plugin_find(TL_KIND_SOLID, name))
        return;
    snprintf(path, sizeof path, "%s/solid_%s.so", TALUS_TEST_PLUGIN_DIR, name);
    CHECK_INT(tl_plugin_load(path, &error), TL_OK);
}

static tl_status elastic(tl_model *m, const char *name, double young, double poisson)
{
    const tl_value values[] = {{.key = "young", .type = TL_VALUE_NUMBER, .number = young},
                               {.key = "poisson", .type = TL_VALUE_NUMBER, .number = poisson}};
    load_solid("elastic");
    return tl_model_solid(m, name, "elastic", &(tl_args){values, 2});
}

static tl_status plastic(tl_model *m, const char *name, const char *kind, double young)
{
    const tl_value values[] = {{.key = "young", .type = TL_VALUE_NUMBER, .number = young},
                               {.key = "poisson", .type = TL_VALUE_NUMBER, .number = 0.25},
                               {.key = "cohesion", .type = TL_VALUE_NUMBER, .number = 1e4},
                               {.key = "friction", .type = TL_VALUE_NUMBER, .number = 30},
                               {.key = "tension", .type = TL_VALUE_NUMBER, .number = 1e3},
                               {.key = "joint_cohesion", .type = TL_VALUE_NUMBER, .number = 1e4},
                               {.key = "joint_friction", .type = TL_VALUE_NUMBER, .number = 20},
                               {.key = "dip", .type = TL_VALUE_NUMBER, .number = 30},
                               {.key = "dip_direction", .type = TL_VALUE_NUMBER, .number = 90}};
    load_solid(kind);
    return tl_model_solid(m, name, kind, &(tl_args){values, strcmp(kind, "ubiquitous") == 0 ? 9 : 5});
}

static void deform(tl_model *m, double edge)
{
    const tl_zoning how = {.size = sizeof how, .edge = edge, .solid = "rock"};
    tl_zoned made;
    scene_ok(m, tl_blocks_deform(m, m->blocks.id, m->blocks.table.rows, &how, &made));
}

/* Two cubes of 2 m in a row along x, 4 m apart, of the solid "rock". */
static tl_model *two_cubes(unsigned threads, double edge)
{
    tl_model *m = scene_model(threads);
    scene_box(m, tl_v3(-1, -1, -1), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(5, -1, -1), tl_v3(7, 1, 1));
    scene_ok(m, elastic(m, "rock", 1e9, 0));
    scene_ok(m, elastic(m, "fault", 2e8, 0));
    deform(m, edge);
    return m;
}

static void run(tl_model *m, int64_t steps)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, steps, &result));
}

/* The zones below a height, by their centroids. */
static tl_zone_name *below(tl_model *m, double height, size_t *count)
{
    const tl_bounds box = {tl_v3(-100, -100, -100), tl_v3(100, 100, height)};
    tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *names;
    filter.inside = &box;
    scene_ok(m, tl_zones_select(m, &filter, &names, count));
    return names;
}

static void set_below(tl_model *m, double height, const char *solid)
{
    size_t count;
    tl_zone_name *names = below(m, height, &count);
    CHECK(count > 0);
    scene_ok(m, tl_zones_solid(m, names, count, solid));
    free(names);
}

/* A column of all zones of the model, from malloc. */
static double *column(tl_model *m, const char *name, size_t *count)
{
    const tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *names;
    size_t width;
    scene_ok(m, tl_zones_select(m, &filter, &names, count));
    scene_ok(m, tl_zones_values(m, names, 1, name, NULL, &width));
    double *out = malloc((width * *count + 1) * sizeof *out);
    scene_ok(m, tl_zones_values(m, names, *count, name, out, &width));
    *count *= width;
    free(names);
    return out;
}

/* Gives all gridpoints velocities that swing. */
static void swing(tl_model *m, double speed)
{
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        for (int i = 0; i < 3 && p->zones[row] > 0; i++)
            p->v[i][row] = speed * sin(1.5 * p->ref[(i + 1) % 3][row] + i);
}

/* What all parcels store, and what their stress is worth to their solids. */
static void check_stored(const tl_model *m, double tolerance)
{
    const struct tl_zones *z = m->zones;
    double stored = 0, worth = 0;
    for (size_t k = 0; k < z->parcels.table.rows; k++) {
        stored += z->parcels.stored[k];
        worth += tl_parcel_stored(z, &z->parcels.of[k]);
    }
    CHECK(worth > 0);
    CHECK_NEAR(stored / worth, 1, tolerance);
}

/* Each zone is in one cluster of zones of its solid and block, in the row that it is told to be in. */
static void check_tables(const tl_model *m)
{
    const struct tl_zones *z = m->zones;
    size_t rows = 0, zones = 0, wrong = 0;
    for (uint32_t k = 0; k < z->parcels.table.rows; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        const tl_body_mesh *mesh = &z->mesh[of->mesh];
        CHECK(k >= mesh->parcel_begin && k < mesh->parcel_end);
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            for (uint32_t i = 0; i < z->group[g].depth * (uint32_t)TL_LANES; i++) {
                const uint32_t row = z->group[g].start + i, number = z->zones.number[row];
                rows++;
                zones += number != TL_NO_ROW;
                wrong += number != TL_NO_ROW && z->row_of[mesh->zone_begin + number] != row;
                for (int a = 0; a < 4; a++) {
                    const uint32_t point = z->listed[of->point_begin + z->zones.corner[a][row]];
                    wrong += point < mesh->point_begin || point >= mesh->point_end;
                }
            }
    }
    CHECK_INT(wrong, 0);
    CHECK_INT(rows, z->zones.table.rows);
    CHECK_INT(zones, z->row_of_count);
    for (size_t p = 0, k = 0; p < z->points.table.rows; p++)
        for (; k < z->use_start[p + 1]; k++)
            CHECK_INT(z->listed[z->use[k]], p);
}

/* ---------------------------------------------------------------- tests ------------------ */

/* Under one strain each zone has the stress of its own solid: no cluster mixes them. */
TEST(each_zone_has_the_stress_of_its_solid)
{
    tl_model *m = two_cubes(2, 0.3);
    set_below(m, 0.1, "fault");
    check_tables(m);
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++) {
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
        p->v[0][row] = 1e-3 * p->ref[0][row];
        p->v[2][row] = 2e-3 * p->ref[2][row];
    }
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-3}));
    run(m, 2);
    size_t count, all;
    double *place = column(m, "centroid", &count), *stress = column(m, "stress", &all);
    CHECK_INT(all, 2 * count);
    for (size_t k = 0; 3 * k < count; k++) {
        const double young = place[3 * k + 2] <= 0.1 ? 2e8 : 1e9;
        CHECK_NEAR(stress[6 * k] / (1e-6 * young), 1, 1e-5);
        CHECK_NEAR(stress[6 * k + 2] / (2e-6 * young), 1, 1e-5);
        CHECK_NEAR(stress[6 * k + 1], 0, 1e-6 * young * 1e-5);
    }
    free(place);
    free(stress);
    tl_model_destroy(m);
}

/* Between steps of a run stress stays to the bit, the balance stays closed, and what is stored is what the stress is
 * worth to the new solids. The same bits on other threads, in a copy and in a restored model. */
TEST(zones_change_between_steps)
{
    tl_model *all[4] = {two_cubes(1, 0.25), two_cubes(3, 0.25), NULL, NULL};
    tl_error error = {0};
    for (int k = 0; k < 2; k++) {
        tl_model *m = all[k];
        swing(m, 0.3);
        run(m, 40);
        CHECK(m->zones->parcels.table.rows > 2);
        size_t count, now;
        double *before = column(m, "stress", &count);
        set_below(m, 0, "fault");
        double *after = column(m, "stress", &now);
        CHECK_INT(now, count);
        CHECK(memcmp(before, after, count * sizeof *before) == 0);
        free(before);
        free(after);
        check_tables(m);
        check_stored(m, 1e-12);
        run(m, 1);
        tl_energy energy;
        scene_ok(m, tl_model_energy(m, &energy));
        CHECK(energy.external > 0.1 * energy.kinetic); /* a soft solid stores more at the same stress */
        for (int n = 0; n < 10; n++) {
            run(m, 10);
            scene_ok(m, tl_model_energy(m, &energy));
            CHECK(fabs(energy.balance) < 2e-3);
        }
        check_stored(m, 0.02);
    }
    scene_ok(all[0], tl_model_copy(all[0], NULL, NULL, &all[2]));
    const char *path = "zones_change.talus";
    scene_ok(all[0], tl_model_save(all[0], path));
    CHECK_INT(tl_model_restore(path, 2, NULL, NULL, &all[3], &error), TL_OK);
    CHECK_INT(remove(path), 0);
    char text[4][33];
    for (int k = 0; k < 4; k++) {
        set_below(all[k], 0.5, "fault");
        run(all[k], 20);
        set_below(all[k], 0.5, "rock");
        run(all[k], 20);
        scene_ok(all[k], tl_state_hash(all[k], text[k]));
        CHECK_TEXT(text[k], text[0]);
    }
    for (int k = 0; k < 4; k++)
        tl_model_destroy(all[k]);
}

/* Zones keep the states that both solids have, flags, and their numbers; those of the same solid keep all. */
TEST(states_of_the_same_names_stay)
{
    tl_model *m = two_cubes(2, 0.3);
    scene_ok(m, plastic(m, "rock", "mohr_coulomb", 1e8));
    scene_ok(m, plastic(m, "fault", "ubiquitous", 1e8));
    swing(m, 2);
    run(m, 60);
    size_t count;
    double *slip = column(m, "plastic_shear", &count), *yielded = column(m, "plastic", &count), largest = 0;
    for (size_t k = 0; k < count; k++)
        largest = fmax(largest, slip[k]);
    CHECK(largest > 1e-4);
    set_below(m, 0.2, "fault");
    double *now = column(m, "plastic_shear", &count), *is = column(m, "plastic", &count);
    CHECK(memcmp(slip, now, count * sizeof *now) == 0);
    CHECK(memcmp(yielded, is, count * sizeof *is) == 0);
    double *normal = column(m, "normal", &count), *place = column(m, "centroid", &count);
    for (size_t k = 0; 3 * k < count; k++)
        CHECK(isnan(normal[3 * k]) == !(place[3 * k + 2] <= 0.2));
    run(m, 20);
    check_tables(m);
    free(slip);
    free(yielded);
    free(now);
    free(is);
    free(normal);
    free(place);
    tl_model_destroy(m);
}

/* Where whole blocks get a solid, only their parcels change it. */
TEST(blocks_change_as_they_lie)
{
    tl_model *m = two_cubes(1, 0.5);
    struct tl_zones *z = m->zones;
    swing(m, 0.1);
    run(m, 30);
    const size_t bytes = z->row_of_count * sizeof *z->row_of;
    uint32_t *rows = malloc(bytes);
    memcpy(rows, z->row_of, bytes);
    tl_block_set set = tl_block_set_default();
    set.solid = "fault";
    set.group = "weak";
    scene_ok(m, tl_blocks_set(m, &m->blocks.id[1], 1, &set));
    CHECK(memcmp(rows, z->row_of, bytes) == 0);
    CHECK_TEXT(z->solid[z->parcels.of[z->mesh[0].parcel_begin].solid].name, "rock");
    CHECK_TEXT(z->solid[z->parcels.of[z->mesh[1].parcel_begin].solid].name, "fault");
    check_stored(m, 0.02);
    /* a cube that is laid anew leaves the other one as it is */
    double *stress[2];
    size_t count;
    stress[0] = column(m, "stress", &count);
    tl_zone_name name = {m->blocks.id[0], 3};
    scene_ok(m, tl_zones_solid(m, &name, 1, "fault"));
    check_tables(m);
    stress[1] = column(m, "stress", &count);
    CHECK(memcmp(stress[0], stress[1], count * sizeof **stress) == 0);
    run(m, 30);
    tl_energy energy;
    scene_ok(m, tl_model_energy(m, &energy));
    CHECK(fabs(energy.balance) < 2e-3);
    free(rows);
    free(stress[0]);
    free(stress[1]);
    tl_model_destroy(m);
}

/* A solid that changes: its zones store what their stress is worth to it now. */
TEST(a_solid_that_changes_stores_another_energy)
{
    tl_model *m = two_cubes(1, 0.5);
    swing(m, 0.1);
    run(m, 30);
    scene_ok(m, elastic(m, "rock", 5e8, 0.1));
    check_stored(m, 1e-12);
    for (int n = 0; n < 10; n++) {
        run(m, 10);
        tl_energy energy;
        scene_ok(m, tl_model_energy(m, &energy));
        CHECK(fabs(energy.balance) < 2e-3);
    }
    check_stored(m, 0.02);
    tl_model_destroy(m);
}

TEST(bad_solids_are_refused)
{
    tl_model *m = two_cubes(1, 1);
    char before[33], after[33];
    scene_box(m, tl_v3(20, 0, 0), tl_v3(21, 1, 1));
    scene_ok(m, tl_state_hash(m, before));
    tl_zone_name names[2] = {{1, 0}, {1, 1000000}};
    tl_block_set set = tl_block_set_default();
    CHECK_INT(tl_zones_solid(m, names, 1, "basalt"), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "there is no solid 'basalt'");
    CHECK_INT(tl_zones_solid(m, names, 2, "fault"), TL_E_STALE);
    CHECK_CONTAINS(tl_model_error(m)->text, "block 1 has no zone 1000000");
    set.solid = "fault";
    set.group = "other";
    CHECK_INT(tl_blocks_set(m, m->blocks.id, 3, &set), TL_E_STATE);
    CHECK_CONTAINS(tl_model_error(m)->text, "block 3 has no solid: it is rigid");
    set.density = 1000;
    CHECK(tl_blocks_set(m, m->blocks.id, 1, &set) != TL_OK);
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(after, before);
    tl_model_destroy(m);
    m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    set.density = NAN;
    CHECK_INT(tl_blocks_set(m, m->blocks.id, 1, &set), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "there is no solid 'fault'");
    tl_model_destroy(m);
}

TEST_MAIN(each_zone_has_the_stress_of_its_solid(), zones_change_between_steps(), states_of_the_same_names_stay(),
          blocks_change_as_they_lie(), a_solid_that_changes_stores_another_energy(), bad_solids_are_refused())
