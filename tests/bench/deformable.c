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

#include <stdio.h>
#include <talus/plugins.h>
#include <talus/talus.h>
#include <talus/zones.h>
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

/* A scene: cubes of 1 m, `apart` from each other, of zones of an edge, m, and what their solid is given. `rate`: that
 * of velocity, 1/s, which all gridpoints are held to, so that all zones yield; 0: they are free. */
typedef struct scene {
    const char *workload, *size, *solid;
    double friction, dilation, tension; /* deg, Pa; 0: not given */
    int side[3];
    double apart, edge;
    double rate[3][3];
    unsigned threads;
} scene;

static bool yields(const scene *s)
{
    return s->rate[0][0] != 0;
}

/* Cubes in a row or a field of rows. */
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
    tl_value values[8] = {tl_arg_number("young", YOUNG), tl_arg_number("poisson", POISSON)};
    size_t n = 2;
    if (strcmp(s->solid, "hoek_brown") == 0) {
        values[n++] = tl_arg_number("sigma_ci", 1e5);
        values[n++] = tl_arg_number("mb", 2);
        values[n++] = tl_arg_number("s", 0.01);
        values[n++] = tl_arg_number("a", 0.51);
    } else if (yields(s)) {
        values[n++] = tl_arg_number("cohesion", 1e4);
        values[n++] = tl_arg_number("friction", s->friction);
    }
    if (s->dilation > 0)
        values[n++] = tl_arg_number("dilation", s->dilation);
    if (s->tension > 0)
        values[n++] = tl_arg_number("tension", s->tension);
    const tl_args args = {values, n};
    ok(m, tl_model_solid(m, "rock", s->solid, &args));
}

/* Free gridpoints get small velocities, each its own. Held ones get those of a field. Cubes that touch are held as they
 * press on each other: each is larger by some share. */
static void set_velocities(tl_model *m, const scene *s)
{
    tl_gridpoints *p = &m->zones->points;
    const bool touch = s->apart == 0;
    uint64_t random = 1;
    for (size_t row = 0; row < p->table.rows; row++) {
        const tl_vec3 centre = tl_body_place(&m->bodies, m->zones->mesh[p->mesh[row]].row);
        const double at[3] = {centre.x, centre.y, centre.z};
        for (int i = 0; i < 3; i++) {
            random = random * 6364136223846793005u + 1442695040888963407u;
            const double field =
                s->rate[i][0] * p->ref[0][row] + s->rate[i][1] * p->ref[1][row] + s->rate[i][2] * p->ref[2][row];
            p->v[i][row] = touch ? 0 : yields(s) ? field : 1e-6 * ((double)(random >> 40) / (1 << 24) - 0.5);
            p->u[i][row] += touch ? 1e-6 * (p->ref[i][row] - at[i]) : 0;
        }
        if (touch || yields(s))
            p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
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
    tl_zoned made;
    tl_zoning how = tl_zoning_default();
    tl_solve_result result;
    ok(NULL, tl_model_create(&config, &m, NULL));
    tl_model_log(m, quiet, NULL);
    add_cubes(m, s);
    ok(m, tl_joint_law(m, "*", "coulomb", &law));
    set_solid(m, s);
    const double before = (double)tl_model_memory(m).total;
    how.edge = s->edge;
    how.solid = "rock";
    ok(m, tl_blocks_deform(m, m->blocks.id, m->blocks.table.rows, &how, &made));
    *zones = made.zones;
    *bytes = ((double)tl_model_memory(m).total - before) / (double)made.zones;
    set_velocities(m, s);
    if (yields(s) || s->apart == 0)
        ok(m, tl_model_timestep(m, &(tl_timestep){.size = sizeof(tl_timestep), .fraction = NAN, .dt = 1e-6}));
    ok(m, tl_model_cycle(m, yields(s) ? 100 : 2, &result));
    return m;
}

/* Zones that have not yielded in the last step. */
static size_t elastic(const tl_model *m)
{
    const tl_zone_table *t = &m->zones->zones;
    size_t out = 0;
    for (size_t row = 0; row < t->table.rows; row++)
        out += t->number[row] != TL_NO_ROW && (t->flags[row] & (TL_ZONE_SHEAR | TL_ZONE_TENSION)) == 0;
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
    bare b = bare_of(m->zones, m->dt, YOUNG, POISSON, yields(s));
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
    if (yields(s) && elastic(m) > 0)
        fprintf(stderr, "deformable: %s: %zu of %zu zones do not yield\n", s->workload, elastic(m), zones);
    row(s, s->solid, zones, (double)zones * (double)steps / median(taken, rounds), "zones/s", median(share, rounds),
        !yields(s) ? bytes : 0);
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

static const scene scenes[] = {
    {.workload = "zones", .size = "in cache", .solid = "elastic", .side = {1, 1, 1}, .apart = 1, .edge = 0.139},
    {.workload = "zones", .size = "out of cache", .solid = "elastic", .side = {20, 20, 1}, .apart = 1, .edge = 0.131},
    {.workload = "plastic plane", .solid = "mohr_coulomb", .friction = 30, .dilation = 10, .rate = PLANE},
    {.workload = "plastic edge", .solid = "mohr_coulomb", .friction = 30, .dilation = 10, .rate = EDGE},
    {.workload = "plastic torn", .solid = "mohr_coulomb", .friction = 30, .tension = 1e3, .rate = TORN},
    {.workload = "plastic", .solid = "hoek_brown", .dilation = 10, .rate = PLANE},
    {.workload = "plastic", .solid = "drucker_prager", .friction = 30, .dilation = 10, .rate = PLANE},
    {.workload = "jointed", .size = "in cache", .solid = "elastic", .side = {2, 1, 1}, .edge = 0.07},
    {.workload = "jointed", .size = "out of cache", .solid = "elastic", .side = {1000, 1, 1}, .edge = 0.23},
};

/* "deformable [quick] [WORDS]": only scenes with these words in what the rows begin with. */
int main(int count, char **words)
{
    const bool small = count > 1 && strcmp(words[1], "quick") == 0;
    const char *only = count > 1 + small ? words[1 + small] : "";
    if (small)
        rounds = 5;
    if (tl_plugins_load_default() != TL_OK)
        return 1;
    printf("workload,size,zones,threads,rate,unit,of_bare,bytes\n");
    for (unsigned threads = 1; threads <= 2; threads++)
        for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
            scene s = scenes[k];
            s.threads = threads;
            if (strcmp(s.workload, "jointed") != 0 && s.side[0] == 0) {
                s.size = "in cache";
                s.side[0] = s.side[1] = s.side[2] = 1;
                s.apart = 1;
                s.edge = 0.139;
            } else if (small && s.side[0] > 2)
                s.side[0] /= 10;
            char name[80];
            snprintf(name, sizeof name, "%s %s %s", s.workload, s.solid, s.size);
            if (strstr(name, only))
                strcmp(s.workload, "jointed") == 0 ? run_jointed(&s) : run_zones(&s);
        }
    return 0;
}
