/* test_zones.c - zones of a deformable body: uniform strain, energy, momentum, frequencies, the same bits on any threads. */
#include "segment/segments.h"
#include "zone/columns.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/solids.h"
#include "zone_scene.h"
#include <talus/zones.h>

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- a box of zones --------- */

/* A box of n[0] x n[1] x n[2] cells, each of six zones about its diagonal, which are a cluster. */
typedef struct box {
    tl_vec3 *point;
    uint32_t (*zone)[4], *start, *list;
    tl_surface_part *part;
    tl_grid grid;
} box;

static box box_of(const int n[3], tl_vec3 min, tl_vec3 max, double density)
{
    const size_t points = (size_t)((n[0] + 1) * (n[1] + 1) * (n[2] + 1)), cells = (size_t)(n[0] * n[1] * n[2]);
    box b = {.point = calloc(points, sizeof *b.point),
             .zone = calloc(6 * cells, sizeof *b.zone),
             .start = calloc(cells + 1, sizeof *b.start),
             .list = calloc(6 * cells, sizeof *b.list)};
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    size_t p = 0, c = 0;
    for (int k = 0; k <= n[2]; k++)
        for (int j = 0; j <= n[1]; j++)
            for (int i = 0; i <= n[0]; i++)
                b.point[p++] = tl_v3(min.x + (max.x - min.x) * i / n[0], min.y + (max.y - min.y) * j / n[1],
                                     min.z + (max.z - min.z) * k / n[2]);
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++, c++) {
                b.start[c + 1] = (uint32_t)(6 * (c + 1));
                for (int t = 0; t < 6; t++) {
                    int at[3] = {i, j, k};
                    uint32_t *z = b.zone[6 * c + (size_t)t];
                    for (int a = 0; a < 4; a++) {
                        z[a] = (uint32_t)(at[0] + (n[0] + 1) * (at[1] + (n[1] + 1) * at[2]));
                        if (a < 3)
                            at[order[t][a]]++;
                    }
                    if (t >= 3) { /* odd: turned inside out */
                        const uint32_t swap = z[1];
                        z[1] = z[2];
                        z[2] = swap;
                    }
                    b.list[6 * c + (size_t)t] = (uint32_t)(6 * c) + (uint32_t)t;
                }
            }
    b.grid = (tl_grid){.point = b.point,
                       .point_count = points,
                       .zone = (const uint32_t(*)[4])b.zone,
                       .zone_count = 6 * cells,
                       .cluster_start = b.start,
                       .cluster_zone = b.list,
                       .cluster_count = cells,
                       .density = density};
    return b;
}

/* Lists the triangles of the surface: the faces of `shape` tell which is which. */
static void box_surface(box *b, const tl_poly *shape, tl_vec3 centre, tl_id block)
{
    tl_surface_part *list = calloc(4 * b->grid.zone_count, sizeof *list);
    size_t count = 0;
    for (uint32_t f = 0; f < shape->face_count; f++)
        for (size_t z = 0; z < b->grid.zone_count; z++)
            for (int a = 0; a < 4; a++) {
                static const int side[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
                tl_surface_part part = {.face = f, .block = block};
                bool on = true;
                for (int k = 0; k < 3; k++) {
                    part.corner[k] = b->zone[z][side[a][k]];
                    part.apex = b->zone[z][a];
                    const tl_vec3 x = tl_v3_sub(b->point[part.corner[k]], centre);
                    on = on && fabs(tl_v3_dot(shape->plane[f].normal, x) - shape->plane[f].offset) < 1e-9;
                }
                if (on)
                    list[count++] = part;
            }
    b->part = list;
    b->grid.part = list;
    b->grid.part_count = count;
}

static void box_free(box *b)
{
    free(b->part);
    free(b->point);
    free(b->zone);
    free(b->start);
    free(b->list);
}

/* Gives a block that is a box zones. */
static void zone_box(tl_model *m, tl_id block, const int n[3], tl_vec3 min, tl_vec3 max, double density)
{
    box b = box_of(n, tl_v3_sub(min, m->origin), tl_v3_sub(max, m->origin), density);
    box_surface(&b, m->blocks.shape[block - 1], tl_v3_sub(tl_v3_scale(0.5, tl_v3_add(min, max)), m->origin), block);
    scene_ok(m, tl_zones_add(m, block, &b.grid, 0));
    box_free(&b);
}

/* A box of zones, alone. */
static tl_model *zoned(const int n[3], tl_vec3 size, double young, double poisson, double density, unsigned threads)
{
    tl_model *m = scene_model(threads);
    const tl_vec3 half = tl_v3_scale(0.5, size);
    scene_box(m, tl_v3_neg(half), half);
    scene_solid(m, young, poisson);
    zone_box(m, 1, n, tl_v3_neg(half), half, density);
    return m;
}

static void run(tl_model *m, int64_t steps)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, steps, &result));
}

/* ---------------------------------------------------------------- tests ------------------ */

/* A linear velocity field strains every zone alike: the stress is uniform to rounding, whatever clusters share. */
TEST(a_uniform_strain_is_uniform)
{
    const int n[3] = {3, 4, 2};
    tl_model *m = zoned(n, tl_v3(1, 2, 1.5), 1e9, 0.25, 2500, 1);
    tl_gridpoints *p = &m->zones->points;
    const double rate[3][3] = {{1e-3, 2e-4, -3e-4}, {5e-4, -2e-3, 1e-4}, {3e-4, 6e-4, 7e-4}};
    for (size_t row = 0; row < p->table.rows; row++) {
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
        for (int i = 0; i < 3; i++)
            p->v[i][row] = rate[i][0] * p->ref[0][row] + rate[i][1] * p->ref[1][row] + rate[i][2] * p->ref[2][row];
    }
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-3}));
    run(m, 2);
    const double g = 1e9 / 2.5, l = g * 0.5 / 0.5;
    const double trace = rate[0][0] + rate[1][1] + rate[2][2];
    const double right[6] = {2 * g * rate[0][0] + l * trace, 2 * g * rate[1][1] + l * trace,
                             2 * g * rate[2][2] + l * trace, g * (rate[0][1] + rate[1][0]),
                             g * (rate[1][2] + rate[2][1]),  g * (rate[2][0] + rate[0][2])};
    const tl_zone_table *t = &m->zones->zones;
    for (size_t row = 0; row < t->table.rows; row++)
        for (int j = 0; j < 6; j++)
            CHECK_NEAR(t->stress[j][row], 1e-3 * right[j], 1e-3 * 1e6 * 3e-6);
    for (size_t row = 1; row < t->table.rows; row++)
        for (int j = 0; j < 6; j++)
            CHECK_NEAR(t->stress[j][row], t->stress[j][0], 1e-9);
    tl_model_destroy(m);
}

/* A box that swings freely keeps its energy and its momentum. */
TEST(a_swinging_box_makes_no_energy)
{
    const int n[3] = {4, 4, 4};
    tl_model *m = zoned(n, tl_v3(1, 1, 1), 1e9, 0.3, 2500, 2);
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0)
            for (int i = 0; i < 3; i++)
                p->v[i][row] = sin(7.0 * p->ref[(i + 1) % 3][row] + i) + 0.3 * i;
    tl_energy energy;
    double most = 0;
    for (int k = 0; k < 60; k++) {
        run(m, 10);
        scene_ok(m, tl_model_energy(m, &energy));
        most = fmax(most, fabs(energy.balance));
    }
    CHECK(most < 2e-3);
    tl_zone_energy zones;
    scene_ok(m, tl_model_zone_energy(m, &zones));
    CHECK(zones.strain > 0.05 * energy.kinetic);
    CHECK(fabs(zones.plastic) < 1e-9 * energy.kinetic);
    CHECK(energy.stored == 0 && energy.friction == 0);
    tl_model_destroy(m);
}

/* What zones lose by yielding is heat of theirs, no friction, and closes the balance. */
TEST(zones_that_yield_turn_motion_to_heat)
{
    const tl_value values[] = {{.key = "young", .type = TL_VALUE_NUMBER, .number = 1e9},
                               {.key = "poisson", .type = TL_VALUE_NUMBER, .number = 0.25},
                               {.key = "cohesion", .type = TL_VALUE_NUMBER, .number = 1e5},
                               {.key = "friction", .type = TL_VALUE_NUMBER, .number = 20}};
    const tl_args args = {values, 4};
    const int n[3] = {4, 4, 4};
    tl_error error = {0};
    tl_model *m = zoned(n, tl_v3(1, 1, 1), 1e9, 0.25, 2500, 2);
    tl_gridpoints *p = &m->zones->points;
    if (!tl_plugin_find(TL_KIND_SOLID, "mohr_coulomb"))
        CHECK_INT(tl_plugin_load(TALUS_TEST_PLUGIN_DIR "/solid_mohr_coulomb.so", &error), TL_OK);
    scene_ok(m, tl_solid_set(m, "rock", tl_plugin_find(TL_KIND_SOLID, "mohr_coulomb"), &args));
    for (size_t row = 0; row < p->table.rows; row++)
        if (p->zones[row] > 0)
            p->v[0][row] = 3 * p->ref[1][row];
    tl_energy energy;
    tl_zone_energy zones;
    double before = 0, most = 0;
    for (int k = 0; k < 40; k++) {
        run(m, 10);
        scene_ok(m, tl_model_energy(m, &energy));
        scene_ok(m, tl_model_zone_energy(m, &zones));
        CHECK(zones.plastic >= before && zones.strain > 0);
        before = zones.plastic;
        most = fmax(most, fabs(energy.balance));
    }
    CHECK(most < 2e-3);
    CHECK(zones.plastic > 0.5 * energy.kinetic);
    CHECK(energy.stored == 0 && energy.friction == 0);
    tl_model_destroy(m);
}

/* The same bits on one thread and on many. */
TEST(zones_have_the_same_bits_on_any_threads)
{
    const int n[3] = {9, 9, 9};
    tl_model *m[2];
    for (int k = 0; k < 2; k++) {
        m[k] = zoned(n, tl_v3(1, 1, 1), 1e9, 0.3, 2500, k ? 3 : 1);
        tl_gridpoints *p = &m[k]->zones->points;
        for (size_t row = 0; row < p->table.rows; row++)
            if (p->zones[row] > 0)
                p->v[0][row] = sin(7.0 * p->ref[1][row]);
        run(m[k], 50);
    }
    CHECK(m[0]->zones->parcels.table.rows > 1);
    for (int i = 0; i < 3; i++) {
        const size_t bytes = m[0]->zones->points.table.rows * sizeof(double);
        CHECK(memcmp(m[0]->zones->points.u[i], m[1]->zones->points.u[i], bytes) == 0);
        CHECK(memcmp(m[0]->zones->points.force[i], m[1]->zones->points.force[i], bytes) == 0);
    }
    for (int k = 0; k < 2; k++)
        tl_model_destroy(m[k]);
}

/* A column on a held foot shortens by rho g h^2 / (2 M) under its weight, M the constrained modulus where its sides are held. */
TEST(a_column_settles_under_its_weight)
{
    const int n[3] = {2, 2, 16};
    tl_model *m = zoned(n, tl_v3(1, 1, 8), 1e9, 0.25, 2500, 1);
    tl_gridpoints *p = &m->zones->points;
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    for (size_t row = 0; row < p->table.rows; row++) {
        if (p->zones[row] > 0)
            p->fixed[row] = TL_FIX_X | TL_FIX_Y;
        if (p->zones[row] > 0 && p->ref[2][row] < m->origin.z - 3.9)
            p->fixed[row] |= TL_FIX_Z;
    }
    m->constraints++;
    tl_solve_result result;
    scene_ok(m, tl_model_damping(m, "local", NULL));
    scene_ok(m, tl_model_solve(
                    m,
                    &(tl_solve){
                        .size = sizeof(tl_solve), .ratio = 1e-6, .velocity = NAN, .max_time = NAN, .max_cycles = 20000},
                    &result));
    double low = 0;
    for (size_t row = 0; row < p->table.rows; row++)
        low = fmin(low, p->u[2][row]);
    CHECK_NEAR(low, -2500 * 10 * 64 / (2 * 1.2e9), 5e-3 * 6.7e-4);
    tl_model_destroy(m);
}

/* Ten turns of a body leave its stress as it is in the axes of the body: gradients are taken half-way. */
TEST(stress_turns_with_its_body)
{
    const int n[3] = {2, 2, 2}, turns = 10, steps[2] = {60, 600};
    const double stress[6] = {-1e6, 0, 0.5e6, 0.2e6, 0, 0};
    for (int which = 0; which < 2; which++) {
        tl_model *m = zoned(n, tl_v3(1, 1, 1), 1e10, 0.25, 2500, 1);
        tl_gridpoints *p = &m->zones->points;
        tl_zone_table *t = &m->zones->zones;
        const double dt = 1e-3, angle = 2 * TL_PI / steps[which];
        for (size_t row = 0; row < t->table.rows; row++)
            for (int j = 0; j < 6; j++)
                t->stress[j][row] = stress[j];
        for (size_t row = 0; row < p->table.rows; row++)
            p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
        m->constraints++;
        scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = dt}));
        for (int k = 1; k <= turns * steps[which]; k++) {
            const double c = cos(k * angle), s = sin(k * angle);
            for (size_t row = 0; row < p->table.rows; row++) { /* to where the turn takes it, along z */
                const double x = c * p->ref[0][row] - s * p->ref[1][row] - p->ref[0][row];
                const double y = s * p->ref[0][row] + c * p->ref[1][row] - p->ref[1][row];
                p->v[0][row] = (x - p->u[0][row]) / dt;
                p->v[1][row] = (y - p->u[1][row]) / dt;
            }
            run(m, 1);
        }
        for (size_t row = 0; row < p->table.rows; row++)
            p->v[0][row] = p->v[1][row] = 0;
        run(m, 1); /* a step begins with the stresses of the motion before it */
        double off = 0;
        for (size_t row = 0; row < t->table.rows; row++)
            for (int j = 0; j < 6; j++)
                off = fmax(off, fabs(t->stress[j][row] - stress[j]));
        CHECK(off < 1e-8 * 1e6);
        tl_model_destroy(m);
    }
}

/* Stress of a body that does not move keeps its bits, zone by zone. */
TEST(stress_without_motion_stays)
{
    const int n[3] = {2, 2, 2};
    tl_model *m = zoned(n, tl_v3(1, 1, 1), 1e10, 0.25, 2500, 1);
    tl_gridpoints *p = &m->zones->points;
    tl_zone_table *t = &m->zones->zones;
    size_t same = 0;
    for (size_t row = 0; row < t->table.rows; row++)
        for (int j = 0; j < 6; j++)
            t->stress[j][row] = 1e6 / (3.0 + (double)(t->number[row] % 7) + j);
    for (size_t row = 0; row < p->table.rows; row++)
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    m->constraints++;
    run(m, 20);
    for (size_t row = 0; row < t->table.rows; row++)
        for (int j = 0; j < 6 && t->number[row] != TL_NO_ROW; j++)
            same += t->stress[j][row] == 1e6 / (3.0 + (double)(t->number[row] % 7) + j);
    CHECK_INT(same, 6 * m->zones->row_of_count);
    tl_model_destroy(m);
}

/* A free beam of four zones deep bends at the frequency of Timoshenko's, whatever Poisson's ratio (30.506 and 30.396 Hz):
 * it is not locked. */
TEST(a_beam_does_not_lock)
{
    const int n[3] = {4, 4, 32};
    const double nu[2] = {0.25, 0.49}, hertz[2] = {30.506024229117163, 30.396161198699314}, length = 8,
                 kl = 4.730040745;
    for (int which = 0; which < 2; which++) {
        tl_model *m = zoned(n, tl_v3(1, 1, length), 1e10, nu[which], 2500, 2);
        tl_gridpoints *p = &m->zones->points;
        for (size_t row = 0; row < p->table.rows; row++) { /* the shape of Bernoulli's first mode */
            const double z = p->ref[2][row] + m->origin.z, k = kl / length;
            p->v[0][row] = p->zones[row] > 0 ? 1e-3 * (cos(k * z) / cos(kl / 2) + cosh(k * z) / cosh(kl / 2)) : 0;
        }
        double last = 0, before = 0, first = 0, period = 0;
        for (int crossings = 0; crossings < 3 && m->cycles < 20000;) {
            run(m, 5);
            double u = 0, mass = 0;
            for (size_t row = 0; row < p->table.rows; row++)
                if (p->zones[row] > 0 && fabs(p->ref[2][row] + m->origin.z) < 0.3) {
                    u += p->mass[row] * p->u[0][row];
                    mass += p->mass[row];
                }
            u /= mass;
            if (last * u < 0) {
                const double when = before + (m->time - before) * last / (last - u);
                first = ++crossings == 1 ? when : first;
                period = when - first;
            }
            last = u;
            before = m->time;
        }
        CHECK_NEAR(1 / period, hertz[which], 0.065 * hertz[which]);
        tl_model_destroy(m);
    }
}

/* Two columns on each other, of other meshes, held at the foot and pressed by a uniform load: each part shortens by
 * p h / M with its sides held, and the joint closes by p / kn. */
TEST(columns_on_a_joint_shorten_in_series)
{
    const int n[2][3] = {{2, 2, 4}, {3, 3, 3}};
    const double young = 1e9, poisson = 0.25, modulus = 1.2e9, kn = 1e9, p = 1e5;
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 2));
    scene_box(m, tl_v3(0, 0, 2), tl_v3(1, 1, 4));
    scene_law(m, "coulomb", kn, kn, 30);
    scene_solid(m, young, poisson);
    zone_box(m, 1, n[0], tl_v3(0, 0, 0), tl_v3(1, 1, 2), 2500);
    zone_box(m, 2, n[1], tl_v3(0, 0, 2), tl_v3(1, 1, 4), 2500);
    tl_gridpoints *g = &m->zones->points;
    const double foot = -m->origin.z, top = 4 - m->origin.z;
    CHECK(tl_gridpoints_hold_loads(g));
    for (size_t row = 0; row < g->table.rows; row++) {
        if (g->zones[row] == 0)
            continue;
        g->fixed[row] = TL_FIX_X | TL_FIX_Y | (g->ref[2][row] < foot + 1e-9 ? TL_FIX_Z : 0);
    }
    for (size_t k = 0; k < m->zones->part_count;
         k++) { /* a third of the load on each corner of the triangles at the top */
        const uint32_t *c = m->zones->part[k].corner;
        if (g->ref[2][c[0]] < top - 1e-9 || g->ref[2][c[1]] < top - 1e-9 || g->ref[2][c[2]] < top - 1e-9)
            continue;
        const tl_vec3 x = tl_gridpoint_place(g, c[0]), a = tl_v3_sub(tl_gridpoint_place(g, c[1]), x);
        const tl_vec3 area = tl_v3_scale(0.5, tl_v3_cross(a, tl_v3_sub(tl_gridpoint_place(g, c[2]), x)));
        for (int i = 0; i < 3; i++)
            g->load[2][c[i]] -= p * area.z / 3;
    }
    m->constraints++;
    tl_solve_result result;
    scene_ok(m, tl_model_damping(m, "local", NULL));
    scene_ok(m, tl_model_solve(
                    m,
                    &(tl_solve){
                        .size = sizeof(tl_solve), .ratio = 1e-8, .velocity = NAN, .max_time = NAN, .max_cycles = 20000},
                    &result));
    CHECK_INT(m->segments->meet_count, 1);
    const double right = p * (2 / modulus), joint = p / kn;
    for (size_t row = 0; row < g->table.rows; row++) {
        if (g->zones[row] == 0)
            continue;
        const double z = g->ref[2][row] - foot;
        const bool above = g->mesh[row] == 1;
        CHECK_NEAR(g->u[2][row], -p * z / modulus - (above ? joint : 0), 1e-3 * (right + joint));
    }
    tl_energy energy;
    scene_ok(m, tl_model_energy(m, &energy));
    CHECK(fabs(energy.balance) < 1e-3);
    tl_model_destroy(m);
}

/* Half the blocks of a pair are zoned: a rigid cube on a zoned base, or a zoned cube on a rigid one, or both. */
static tl_model *pair(int which, double friction, double young)
{
    const int n[3] = {3, 3, 2}, base[3] = {8, 4, 2};
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(-2, -1, -1), tl_v3(2, 1, 0));
    scene_box(m, tl_v3(-1.5, -0.4, 0), tl_v3(-0.7, 0.4, 0.6));
    scene_law(m, "coulomb", 1e9, 1e9, friction);
    const tl_id floor = 1;
    scene_solid(m, young, 0.25);
    if (which & 1)
        zone_box(m, 1, base, tl_v3(-2, -1, -1), tl_v3(2, 1, 0), 2500);
    else
        scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    if (which & 2)
        zone_box(m, 2, n, tl_v3(-1.5, -0.4, 0), tl_v3(-0.7, 0.4, 0.6), 2500);
    tl_gridpoints *g = &m->zones->points;
    for (size_t row = 0; row < g->table.rows; row++)
        if (which & 1 && g->zones[row] > 0 && g->mesh[row] == 0 && g->ref[2][row] + m->origin.z < -1 + 1e-9)
            g->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    m->constraints++;
    return m;
}

static tl_vec3 moved(const tl_model *m, int which)
{
    return m->bodies.pose[which].u;
}

static void settle(tl_model *m)
{
    tl_solve_result result;
    const tl_solve solve = {.size = sizeof solve, .ratio = 1e-6, .velocity = NAN, .max_time = NAN, .max_cycles = 20000};
    scene_ok(m, tl_model_solve(m, &solve, &result));
    CHECK_INT(result.reason, TL_SOLVE_RATIO);
}

static void incline(tl_model *m, double degrees)
{
    const double a = degrees * TL_PI / 180;
    scene_ok(m, tl_model_set_gravity(m, tl_v3(10 * sin(a), 0, -10 * cos(a))));
}

/* On a plane that is tilted slowly it stays, and then slides with g (sin a - cos a tan phi). No energy is made. */
TEST(a_cube_rests_and_slides_on_zones)
{
    for (int which = 1; which <= 3; which++) {
        tl_model *m = pair(which, 20, 1e9);
        tl_energy energy;
        scene_ok(m, tl_model_damping(m, "local", NULL));
        for (int degrees = 0; degrees <= 15; degrees++) {
            incline(m, degrees);
            settle(m);
        }
        CHECK(fabs(moved(m, 1).x) < 1e-3);
        tl_damping_clear(m);
        incline(m, 30);
        const double begun = m->time, x = moved(m, 1).x;
        double most = 0;
        while (m->time < begun + 0.5) {
            run(m, 20);
            scene_ok(m, tl_model_energy(m, &energy));
            most = fmax(most, fabs(energy.balance));
        }
        const double t = m->time - begun, a = 5 - 10 * sqrt(0.75) * tan(20 * TL_PI / 180);
        CHECK_NEAR(moved(m, 1).x - x, 0.5 * a * t * t, 0.01 * 0.5 * a * t * t);
        CHECK(most < 1e-3);
        tl_model_destroy(m);
    }
}

/* A cube of 1 m, turned, above a rigid floor, whose own zones are on request. */
static tl_model *falling(bool deforms, tl_quat turn, tl_vec3 velocity)
{
    const int n[3] = {3, 3, 3};
    const tl_vec3 place = {0, 0, 1};
    const tl_id floor = 1;
    tl_model *m = scene_model(2);
    scene_box(m, tl_v3(-4, -4, -2), tl_v3(4, 4, 0));
    scene_block(m, scene_box_shape(1, 1, 1), turn, place);
    scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_model_set_gravity(m, tl_v3(0, 0, -10)));
    m->bodies.v[1] = velocity;
    if (!deforms)
        return m;
    scene_solid(m, 1e10, 0.2);
    box b = box_of(n, tl_v3(-0.5, -0.5, -0.5), tl_v3(0.5, 0.5, 0.5), 2000);
    for (size_t k = 0; k < b.grid.point_count; k++)
        b.point[k] = tl_v3_sub(tl_v3_add(tl_q_rotate(turn, b.point[k]), place), m->origin);
    box_surface(&b, m->blocks.shape[1], tl_v3_sub(place, m->origin), 2);
    scene_ok(m, tl_zones_add(m, 2, &b.grid, 0));
    box_free(&b);
    m->bodies.v[1] = tl_v3(0, 0, 0);
    tl_gridpoints *g = &m->zones->points;
    for (size_t row = 0; row < g->table.rows; row++)
        for (int k = 0; k < 3 && g->zones[row] > 0; k++)
            g->v[k][row] = k == 0 ? velocity.x : k == 1 ? velocity.y : velocity.z;
    return m;
}

/* A stiff cube that falls on a corner, and on an edge, goes as a rigid one does. What differs by its inertia, more by
 * 2/9 with three zones an edge, shows later. No energy is made. */
TEST(a_stiff_cube_falls_as_a_rigid_one)
{
    const tl_vec3 axis[3] = {{1, 1, 0}, {1, 0.3, 0.2}, {0, 1, 0}};
    const double angle[3] = {0.95, 0.6, 0.7}, until[3] = {0.16, 0.19, 0.21};
    for (int k = 0; k < 3; k++) {
        const tl_quat turn = scene_turn(tl_v3_unit(axis[k]), angle[k]);
        tl_model *m[2] = {falling(false, turn, tl_v3(0.3, 0, -1)), falling(true, turn, tl_v3(0.3, 0, -1))};
        for (int which = 0; which < 2; which++)
            while (m[which]->time < until[k])
                run(m[which], 1);
        CHECK_INT(m[1]->detect->contacts.table.rows, 1);
        tl_energy energy;
        scene_ok(m[1], tl_model_energy(m[1], &energy));
        CHECK(fabs(energy.balance) < 1e-4);
        const tl_vec3 apart = tl_v3_sub(moved(m[0], 1), moved(m[1], 1));
        CHECK(tl_v3_norm(apart) < 0.03 * tl_v3_norm(moved(m[0], 1)));
        for (int which = 0; which < 2; which++)
            tl_model_destroy(m[which]);
    }
}

/* It comes to rest on a face: on its corner, on its edge by zones that carry them, on the face by segments. */
TEST(a_cube_comes_to_rest_on_a_face)
{
    const tl_vec3 axis[2] = {{1, 0.3, 0.2}, {0, 1, 0}};
    const double angle[2] = {0.6, 0.7};
    for (int k = 0; k < 2; k++) {
        tl_model *m = falling(true, scene_turn(tl_v3_unit(axis[k]), angle[k]), tl_v3(0, 0, 0));
        tl_solve_result result;
        tl_energy energy;
        const tl_solve solve = {
            .size = sizeof solve, .ratio = 1e-5, .velocity = NAN, .max_time = NAN, .max_cycles = 200000};
        scene_ok(m, tl_model_damping(m, "local", NULL));
        scene_ok(m, tl_model_solve(m, &solve, &result));
        CHECK_INT(result.reason, TL_SOLVE_RATIO);
        CHECK_INT(m->segments->meet_count, 1);
        CHECK_NEAR(m->segments->meet[0].area, 1, 1e-3);
        CHECK_NEAR(m->bodies.pose[1].u.z, -0.5 - 2e-4, 1e-5); /* it closes by its weight over kn */
        scene_ok(m, tl_model_energy(m, &energy));
        CHECK(fabs(energy.balance) < 2e-3);
        tl_model_destroy(m);
    }
}

/* Zones and gridpoints are asked by names; gridpoints are held, loaded and pushed by them. */
TEST(zones_tell_what_they_are)
{
    const int n[3] = {2, 2, 2};
    tl_model *m = zoned(n, tl_v3(1, 1, 1), 1e9, 0.25, 2500, 1);
    tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *zones, *points;
    size_t zone_count, point_count, width;
    double value[48 * 6], strain[48 * 6], volume = 0;
    scene_ok(m, tl_zones_select(m, &filter, &zones, &zone_count));
    scene_ok(m, tl_gridpoints_select(m, &filter, &points, &point_count));
    CHECK_INT(zone_count, 48);
    CHECK_INT(point_count, 27);
    tl_vec3 velocity[27];
    for (size_t k = 0; k < point_count; k++) {
        scene_ok(m, tl_gridpoints_values(m, &points[k], 1, "position", value, &width));
        velocity[k] = tl_v3(0.01 * value[0], 0, 0);
    }
    scene_ok(m, tl_gridpoints_fix(m, points, point_count, TL_FIX_X | TL_FIX_Y | TL_FIX_Z));
    scene_ok(m, tl_gridpoints_velocity(m, points, point_count, velocity));
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1}));
    run(m, 2);
    scene_ok(m, tl_zones_values(m, zones, zone_count, "stress", value, &width));
    CHECK_INT(width, 6);
    scene_ok(m, tl_zones_values(m, zones, zone_count, "strain", strain, &width));
    for (size_t k = 0; k < zone_count; k++) {
        CHECK_NEAR(value[6 * k], 1.2e9 * 0.01, 1.2e9 * 1e-4);
        CHECK_NEAR(value[6 * k + 1], 0.4e9 * 0.01, 0.4e9 * 1e-4);
        CHECK_NEAR(strain[6 * k], log(1.02), 1e-12); /* both steps have moved it; the stress is that of the first */
        CHECK_NEAR(strain[6 * k + 1], 0, 1e-12);
    }
    scene_ok(m, tl_zones_values(m, zones, zone_count, "volume", value, &width));
    for (size_t k = 0; k < zone_count; k++)
        volume += value[k];
    CHECK_NEAR(volume, 1.02, 1e-12);
    scene_ok(m, tl_zones_values(m, zones, 1, "principal", value, &width));
    CHECK(value[0] > value[1] && value[1] >= value[2]);
    CHECK_INT(tl_zones_values(m, zones, 1, "solid", value, &width), TL_E_ARGUMENT);
    CHECK_INT(tl_zones_values(m, zones, 1, "colour", value, &width), TL_E_NOT_FOUND);
    CHECK_INT(tl_zones_values(m, &(tl_zone_name){1, 48}, 1, "mean", value, &width), TL_E_STALE);
    tl_field_value field;
    size_t fields, at = 0;
    while (strcmp(tl_zone_fields(&fields)[at].name, "solid") != 0)
        at++;
    scene_ok(m, tl_zone_field(m, zones[0], at, &field));
    CHECK_TEXT(field.text, "rock");
    tl_vec3 held;
    size_t left = 0;
    for (size_t k = 0; k < point_count; k++)
        if (velocity[k].x < -1e-6) /* the face at xmin */
            points[left++] = points[k];
    scene_ok(m, tl_gridpoints_reaction(m, points, left, &held));
    CHECK_NEAR(held.x, -1.2e9 * 0.01, 1.2e9 * 0.01 * 0.03);
    CHECK_INT(tl_gridpoints_fix(m, points, 1, TL_FIX_ROTATION), TL_E_ARGUMENT);
    free(zones);
    free(points);
    tl_model_destroy(m);
}

/* A copy, and a model that was saved and restored, go on to the same bits; their hash is the same. */
TEST(zones_come_back)
{
    tl_model *m = pair(3, 20, 1e9), *copy, *again;
    tl_error error = {0};
    char text[3][33];
    scene_ok(m, tl_model_set_gravity(m, tl_v3(5, 0, -10 * sqrt(0.75))));
    run(m, 300);
    scene_ok(m, tl_model_copy(m, NULL, NULL, &copy));
    const char *path = "zones_come_back.talus";
    scene_ok(m, tl_model_save(m, path));
    CHECK_INT(tl_model_restore(path, 2, NULL, NULL, &again, &error), TL_OK);
    CHECK_INT(remove(path), 0);
    tl_model *all[3] = {m, copy, again};
    for (int k = 0; k < 3; k++) {
        run(all[k], 300);
        scene_ok(all[k], tl_state_hash(all[k], text[k]));
        CHECK_TEXT(text[k], text[0]);
        CHECK_NEAR(moved(all[k], 1).x, moved(m, 1).x, 0);
        tl_memory memory = tl_model_memory(all[k]);
        CHECK(memory.zones > 10000);
    }
    for (int k = 0; k < 3; k++)
        tl_model_destroy(all[k]);
}

/* A step that would turn a zone inside out is refused whole, and says where; made again it is refused again. With other
 * velocities the model goes on. */
TEST(a_zone_turned_inside_out_is_told)
{
    const int n[3] = {2, 2, 2};
    for (int goes = 0; goes < 2; goes++) {
        tl_model *m = zoned(n, tl_v3(1, 1, 1), 1e9, 0.25, 2500, 2);
        const tl_zone_name name = {1, 0};
        const tl_vec3 fast = {4e4, 4e4, 4e4};
        tl_solve_result result;
        tl_status status;
        char before[33], after[33];
        if (goes)
            run(m, 5);
        scene_ok(m, tl_gridpoints_velocity(m, &name, 1, &fast));
        for (int step = 0; step < 4; step++) {
            scene_ok(m, tl_state_hash(m, before));
            if ((status = tl_model_cycle(m, 1, &result)) != TL_OK)
                break;
        }
        for (int again = 0; again < 3; again++) {
            CHECK_INT(status, TL_E_NUMERIC);
            CHECK(strstr(m->error.text, "of block 1: zone ") && strstr(m->error.text, "would be turned inside out"));
            scene_ok(m, tl_state_hash(m, after));
            CHECK_TEXT(before, after);
            status = tl_model_cycle(m, 1, &result);
        }
        scene_ok(m, tl_gridpoints_velocity(m, &name, 1, &(tl_vec3){0, 0, 0}));
        run(m, 10);
        tl_model_destroy(m);
    }
}

/* A slab of 2 m, 1 m and 0.2 m, flush on a plate, whose gridpoints are driven up by `bow` x^2 m/s and apart by `strain` x
 * m/s. A cube may stand with an edge just over it. */
static tl_model *bent(double bow, double strain, bool near)
{
    tl_model *m = scene_model(2);
    const tl_id others[2] = {2, 3};
    scene_box(m, tl_v3(-1, -0.5, -0.2), tl_v3(1, 0.5, 0));
    scene_box(m, tl_v3(-1, -0.5, -0.4), tl_v3(1, 0.5, -0.2));
    scene_block(m, scene_box_shape(1, 1, 1), scene_turn(tl_v3(0, 1, 0), TL_PI / 4),
                tl_v3(0, 0, sqrt(0.5) + (near ? 1e-4 : 2)));
    scene_ok(m, tl_blocks_fix(m, others, 2, TL_FIX_ALL));
    scene_law(m, "coulomb", 1e6, 1e6, 0);
    scene_solid(m, 1e6, 0.2);
    scene_divide(m, 0, 1, 0.2);
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; row < p->table.rows; row++) {
        const double x = p->ref[0][row] + m->origin.x;
        p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
        p->v[0][row] = strain * x;
        p->v[2][row] = bow * x * x;
    }
    m->constraints++;
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-4}));
    return m;
}

/* A slab that has bent by more than 5 % of its size, where another block may touch it by an edge, ends the run with a
 * sentence, and nothing has changed. With nothing near but the plate that it lies on, less bent, or strained as a whole
 * it goes on. */
TEST(a_slab_that_has_bent_is_told)
{
    static const struct {
        double bow, strain; /* m of each, in 256 steps */
        bool near, ends;
    } all[] = {{0.04, 0, true, false}, {0.12, 0, true, true}, {0.12, 0, false, false}, {0, 0.2, true, false}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        tl_model *m = bent(all[k].bow / 0.0256, all[k].strain / 0.0256, all[k].near);
        tl_solve_result result;
        char before[33], after[33];
        run(m, 256);
        CHECK(tl_blocks_meet(m, 0, 1));
        scene_ok(m, tl_state_hash(m, before));
        for (int again = 0; again < 2; again++) {
            const tl_status status = tl_model_cycle(m, 1, &result);
            CHECK_INT(status, all[k].ends ? TL_E_NUMERIC : TL_OK);
            if (!all[k].ends)
                continue;
            CHECK(strstr(m->error.text, "cycle 257: block 1 has bent") && strstr(m->error.text, "and join them"));
            scene_ok(m, tl_state_hash(m, after));
            CHECK_TEXT(before, after);
        }
        tl_model_destroy(m);
    }
}

/* The stiffness of all gridpoints, of their zones alone. */
static double stiffness_of_zones(const tl_model *m)
{
    double sum = 0;
    for (size_t row = 0; row < m->zones->points.table.rows; row++)
        sum += m->zones->points.stiffness[row];
    return sum;
}

/* What carries a contact is no stiffer step after step. */
TEST(carried_contacts_count_once)
{
    tl_model *m = falling(true, scene_turn(tl_v3(0, 1, 0), 0.7), tl_v3(0, 0, -0.5));
    double first = 0;
    for (int k = 0; k < 20000 && first == 0; k++) {
        run(m, 1);
        first = m->detect->contacts.table.rows > 0 && m->detect->contacts.carrier[0] ? stiffness_of_zones(m) : 0;
    }
    CHECK(first > 0);
    for (int k = 0; k < 7; k++) {
        run(m, 1);
        CHECK_NEAR(stiffness_of_zones(m), first, 1e-6 * first);
    }
    tl_model_destroy(m);
}

TEST_MAIN(a_uniform_strain_is_uniform(), a_swinging_box_makes_no_energy(), zones_that_yield_turn_motion_to_heat(),
          zones_have_the_same_bits_on_any_threads(), a_column_settles_under_its_weight(),
          columns_on_a_joint_shorten_in_series(), stress_turns_with_its_body(), stress_without_motion_stays(),
          a_beam_does_not_lock(), a_cube_rests_and_slides_on_zones(), a_stiff_cube_falls_as_a_rigid_one(),
          a_cube_comes_to_rest_on_a_face(), zones_come_back(), a_zone_turned_inside_out_is_told(),
          a_slab_that_has_bent_is_told(), carried_contacts_count_once(), zones_tell_what_they_are())
