/* deformable.c - how many zones and contact points of deformable blocks a step takes in a second. Run as
 *
 *     ./bootstrap bench deformable
 *
 *   zones    elastic zones: a cube of 3000, in cache, and 400 of 2500, out of it; whole steps
 *   plastic  zones of mohr_coulomb and other solids that all yield, on a plane, an edge or at the tensile strength
 *   jointed  cubes with segments between them: points of these, and whole steps of all
 *
 * Steps and the bare loop (bare_zones.h) run in turn, so both see the same machine, busy or not. A row tells a rate, and
 * as "of_bare" the median of its ratios to the bare loop's, which is compiled for the very machine. Memory is what
 * zones take more than blocks, over the zones. */
#include "bare_zones.h"
#include "segment/act.h"
#include "zone/deform.h"
#include "zone/life.h"
#include "zone/solids.h"

#include <stdio.h>
#include <talus/plugins.h>
#include <talus/talus.h>
#include <time.h>

#define YOUNG 1e9
#define POISSON 0.25
#define MOST_ROUNDS 15

static int rounds = MOST_ROUNDS;

static void ok(tl_model *m, tl_status status)
{
    if (status == TL_OK)
        return;
    fprintf(stderr, "deformable: %s\n", m ? tl_model_error(m)->text : "out of memory");
    exit(1);
}

/* Of one thread the processor time, which other programs disturb less; of several the clock. */
static double seconds(const tl_model *m)
{
    struct timespec t;
    clock_gettime(tl_pool_threads(m->pool) == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *of, int count)
{
    qsort(of, (size_t)count, sizeof *of, compare);
    return of[count / 2];
}

static void quiet(void *user, const char *text)
{
    (void)user, (void)text;
}

/* ---------------------------------------------------------------- scenes ----------------- */

/* What there is of a scene beside its blocks. */
typedef struct scene {
    const char *workload, *size, *solid;
    tl_value parameter[3];
    size_t parameters;
    int side[3];        /* cubes of 1 m along x, y and z */
    double apart, edge; /* m: between the cubes, and of their zones */
    unsigned threads;
    double rate[3][3]; /* of velocity, 1/s, that all gridpoints are held to; 0: they are free */
    uint32_t flag;     /* that all zones shall have in each step, or 0 */
    int64_t before;    /* steps until they have it */
} scene;

/* Cubes in a row, a wall or a heap. */
static void add_cubes(tl_model *m, const scene *s)
{
    const size_t count = (size_t)(s->side[0] * s->side[1] * s->side[2]);
    double(*place)[2][3] = calloc(count, sizeof *place);
    tl_value(*values)[3] = calloc(count, sizeof *values);
    tl_args *args = calloc(count, sizeof *args);
    size_t n = 0;
    for (int k = 0; k < s->side[2]; k++)
        for (int j = 0; j < s->side[1]; j++)
            for (int i = 0; i < s->side[0]; i++, n++) {
                const int at[3] = {i, j, k};
                for (int c = 0; c < 3; c++) {
                    place[n][0][c] = (1 + s->apart) * at[c];
                    place[n][1][c] = place[n][0][c] + 1;
                }
                values[n][0] = (tl_value){.key = "min", .type = TL_VALUE_NUMBERS, .data = place[n][0], .count = 3};
                values[n][1] = (tl_value){.key = "max", .type = TL_VALUE_NUMBERS, .data = place[n][1], .count = 3};
                values[n][2] = tl_arg_number("density", 2500);
                args[n] = (tl_args){values[n], 3};
            }
    ok(m, tl_generate_list(m, "box", args, count, NULL));
    free(place);
    free(values);
    free(args);
}

static void set_solid(tl_model *m, const scene *s)
{
    tl_value values[5] = {tl_arg_number("young", YOUNG), tl_arg_number("poisson", POISSON)};
    memcpy(values + 2, s->parameter, sizeof s->parameter);
    const tl_args args = {values, 2 + s->parameters};
    const tl_kind *kind = tl_plugin_find(TL_KIND_SOLID, s->solid);
    if (!kind) {
        fprintf(stderr, "deformable: there is no solid '%s'\n", s->solid);
        exit(1);
    }
    ok(m, tl_zones_begin(m));
    ok(m, tl_solid_set(m, "rock", kind, &args));
}

/* Free gridpoints get small velocities, each its own; held ones those of a field. */
static void set_velocities(tl_model *m, const scene *s)
{
    tl_gridpoints *p = &m->zones->points;
    uint64_t random = 1;
    for (size_t row = 0; row < p->table.rows; row++)
        for (int i = 0; i < 3; i++) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            if (s->flag == 0) {
                p->v[i][row] = 1e-6 * ((double)(random >> 40) / (1 << 24) - 0.5);
                continue;
            }
            p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
            p->v[i][row] =
                s->rate[i][0] * p->ref[0][row] + s->rate[i][1] * p->ref[1][row] + s->rate[i][2] * p->ref[2][row];
        }
    m->constraints++;
}

/* Makes the model of a scene. `zones`: how many it has; `bytes`: that they take more than blocks, each. */
static tl_model *make(const scene *s, size_t *zones, double *bytes)
{
    const tl_model_config config = {.size = sizeof config, .seed = 1, .threads = s->threads, .reuse_geometry = 1};
    const tl_value joint[] = {tl_arg_number("kn", 1e10), tl_arg_number("ks", 1e10), tl_arg_number("friction", 40)};
    const tl_args law = {joint, 3};
    tl_model *m;
    tl_divided made;
    tl_solve_result result;
    ok(NULL, tl_model_create(&config, &m, NULL));
    tl_model_log(m, quiet, NULL);
    add_cubes(m, s);
    ok(m, tl_joint_law(m, "*", "coulomb", &law));
    set_solid(m, s);
    const double before = (double)tl_model_memory(m).total;
    const tl_dividing how = {.edge = s->edge, .solid = "rock"};
    ok(m, tl_blocks_divide(m, m->blocks.id, m->blocks.table.rows, &how, &made));
    *zones = made.zones;
    *bytes = ((double)tl_model_memory(m).total - before) / (double)made.zones;
    set_velocities(m, s);
    if (s->flag != 0)
        ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-6}));
    ok(m, tl_model_cycle(m, s->before > 2 ? s->before : 2, &result));
    return m;
}

/* Zones without a flag that all shall have. */
static size_t without(const tl_model *m, uint32_t flag)
{
    const tl_zone_table *t = &m->zones->zones;
    size_t out = 0;
    for (size_t row = 0; row < t->table.rows; row++)
        out += t->number[row] != TL_NO_ROW && (t->flags[row] & flag) != flag;
    return out;
}

/* ---------------------------------------------------------------- rows ------------------- */

static void row(const scene *s, const char *what, size_t zones, double rate, const char *unit, double share,
                double bytes)
{
    char text[32] = "", memory[32] = "";
    if (share > 0)
        snprintf(text, sizeof text, "%.3f", share);
    if (bytes > 0)
        snprintf(memory, sizeof memory, "%.1f", bytes);
    printf("%s %s,%s,%zu,%u,%.5g,%s,%s,%s\n", s->workload, what, s->size, zones, s->threads, rate, unit, text, memory);
    fflush(stdout);
}

/* Steps that take some hundredths of a second. */
static int64_t steps_of(size_t zones)
{
    const double steps = 1.5e6 / (double)zones;
    return steps > 1 ? (int64_t)steps : 1;
}

/* Whole steps and the bare loop in turn. */
static void run_zones(const scene *s)
{
    size_t zones;
    double bytes, taken[MOST_ROUNDS], share[MOST_ROUNDS];
    tl_solve_result result;
    tl_model *m = make(s, &zones, &bytes);
    bare b = bare_of(m->zones, m->dt, YOUNG, POISSON, s->flag != 0);
    const int64_t steps = steps_of(zones);
    bare_step(&b, m->pool);
    for (int r = 0; r < rounds; r++) {
        double began = seconds(m);
        ok(m, tl_model_cycle(m, steps, &result));
        taken[r] = seconds(m) - began;
        began = seconds(m);
        for (int64_t k = 0; k < steps; k++)
            bare_step(&b, m->pool);
        share[r] = (seconds(m) - began) / taken[r];
    }
    if (s->flag != 0 && without(m, s->flag) > 0)
        fprintf(stderr, "deformable: %s: %zu of %zu zones do not yield\n", s->workload, without(m, s->flag), zones);
    row(s, s->solid, zones, (double)zones * (double)steps / median(taken, rounds), "zones/s", median(share, rounds),
        s->flag == 0 ? bytes : 0);
    bare_free(&b);
    tl_model_destroy(m);
}

/* Forces of segments at the present places, again and again, and whole steps. */
static void run_jointed(const scene *s)
{
    size_t zones, points = 0;
    double bytes, taken[MOST_ROUNDS], whole[MOST_ROUNDS];
    tl_solve_result result;
    tl_failure failure = {.error = {0}};
    tl_model *m = make(s, &zones, &bytes);
    for (size_t k = 0; k < m->segments->table.table.rows; k++)
        points += m->segments->table.of[k].meet != TL_NO_ROW ? TL_SEGMENT_POINTS : 0;
    const int64_t steps = steps_of(zones), passes = steps_of(points / 4 + 1);
    for (int r = 0; r < rounds; r++) {
        double began = seconds(m);
        ok(m, tl_model_cycle(m, steps, &result));
        whole[r] = seconds(m) - began;
        began = seconds(m);
        for (int64_t k = 0; k < passes; k++)
            ok(m, tl_segments_apply(m, &failure));
        taken[r] = seconds(m) - began;
    }
    row(s, "segments", points, (double)points * (double)passes / median(taken, rounds), "points/s", 0, 0);
    row(s, "steps", zones, (double)zones * (double)steps / median(whole, rounds), "zones/s", 0, 0);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- workloads -------------- */

/* Strain rates in which all zones soon yield, on a plane: three principal stresses that differ, along no axis of the
 * model. On an edge two of them are the same. */
#define PLANE                                                                                                          \
    {                                                                                                                  \
        {3, 1, 0.5}, {-0.4, 0.5, 2},                                                                                   \
        {                                                                                                              \
            1.5, -1, -4                                                                                                \
        }                                                                                                              \
    }
#define EDGE                                                                                                           \
    {                                                                                                                  \
        {2, 0, 0}, {0, 2, 0},                                                                                          \
        {                                                                                                              \
            0, 0, -4.5                                                                                                 \
        }                                                                                                              \
    }
#define TORN                                                                                                           \
    {                                                                                                                  \
        {2, 0.4, 0}, {0, -0.3, 0.2},                                                                                   \
        {                                                                                                              \
            0, 0, -0.4                                                                                                 \
        }                                                                                                              \
    }

static void run(scene s, unsigned threads, bool jointed)
{
    s.threads = threads;
    (jointed ? run_jointed : run_zones)(&s);
}

int main(int count, char **words)
{
    const bool small = count > 1 && strcmp(words[1], "quick") == 0;
    const char *only = count > 2 ? words[2] : "";
    if (small)
        rounds = 5;
    if (tl_plugins_load_default() != TL_OK)
        return 1;
    const tl_value weak = tl_arg_number("cohesion", 1e4), steep = tl_arg_number("friction", 30);
    const tl_value soft = tl_arg_number("tension", 1e3), flat = tl_arg_number("dilation", 10);
    const scene zones[] = {
        {"zones", "in cache", "elastic", {{0}}, 0, {1, 1, 1}, 1, 0.139, 1, {{0}}, 0, 2},
        {"zones", "out of cache", "elastic", {{0}}, 0, {20, small ? 2 : 20, 1}, 1, 0.131, 1, {{0}}, 0, 2},
        {"plastic plane",
         "in cache",
         "mohr_coulomb",
         {weak, steep, flat},
         3,
         {1, 1, 1},
         1,
         0.139,
         1,
         PLANE,
         TL_ZONE_SHEAR,
         100},
        {"plastic edge",
         "in cache",
         "mohr_coulomb",
         {weak, steep, flat},
         3,
         {1, 1, 1},
         1,
         0.139,
         1,
         EDGE,
         TL_ZONE_SHEAR,
         100},
        {"plastic torn",
         "in cache",
         "mohr_coulomb",
         {weak, steep, soft},
         3,
         {1, 1, 1},
         1,
         0.139,
         1,
         TORN,
         TL_ZONE_TENSION,
         100},
    };
    const scene jointed[] = {
        {"jointed", "in cache", "elastic", {{0}}, 0, {2, 1, 1}, 0, 0.07, 1, {{0}}, 0, 2},
        {"jointed", "out of cache", "elastic", {{0}}, 0, {10, 10, small ? 1 : 10}, 0, 0.23, 1, {{0}}, 0, 2},
    };
    printf("workload,size,zones,threads,rate,unit,of_bare,bytes\n");
    for (unsigned threads = 1; threads <= 2; threads++) {
        for (size_t k = 0; k < sizeof zones / sizeof *zones; k++)
            if (strstr(zones[k].workload, only))
                run(zones[k], threads, false);
        for (size_t k = 0; k < sizeof jointed / sizeof *jointed; k++)
            if (strstr(jointed[k].workload, only))
                run(jointed[k], threads, true);
    }
    return 0;
}
