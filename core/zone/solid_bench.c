/* solid_bench.c - a solid on one zone: any path of held stresses and driven strains (talus/solid_test.h).
 *
 * The solid gets a batch of TL_LANES zones. The first makes the step; the others make it with a little more of one
 * held strain each, so that one call gives the stresses and their derivatives J. With r the stresses that are
 * missing at the held components, each pass of a step adds
 *
 *     d eps = (J^T J + m I)^-1 J^T r
 *
 * to the held strains (Levenberg 1944). m is small, and decides between strains that do not change the stresses: on an
 * edge of a yield surface it takes the least ones. A pass that brings r no nearer is halved, then replaced by one of
 * the elastic moduli. Work is summed by the trapezoidal rule. */
#include "base/solid_columns.h"
#include "plugin/loader.h"
#include "zone/solid.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <talus/solid_test.h>

/* Tolerance: stress missing at a held component that counts as none, relative to the largest stress, and as a strain of
 * the constrained modulus. Both are far above rounding. */
#define STRESS_ERROR 1e-12
#define STRAIN_ERROR 1e-19
/* Tolerance: the little more of a strain, relative to the step's: it may cross a kink of the solid's, and then the next
 * pass is off by as much. */
#define LITTLE 1e-3
/* Tolerance: m over the largest square of J: what solids of full stiffness do not notice. */
#define DAMPED 1e-12
/* Limit: passes of a step, and halvings of one. Most steps take two or three passes. */
#define MOST_PASSES 200
#define MOST_HALVINGS 4
/* Limit: steps of the elastic moduli in the place of a pass that leads nowhere; each brings r nearer by a share of the
 * stiffness that is left. */
#define WEIGHTS_MIXED 2

/* Zones of a batch. */
typedef struct sample {
    _Alignas(TL_ALIGN) double c[TL_ZONE_AT_COUNT][TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
} sample;

typedef struct bench {
    const tl_solid_test *test;
    tl_solid solid;
    tl_error *error;
    sample now;       /* as the last step has left it */
    size_t leg;       /* counted from 1; 0: the start */
    double strain[6]; /* so far */
    double wanted[6]; /* stress at the end of the step, of the held */
    bool held[6];
    int list[6], many; /* the held components */
    double dt, work, heat;
} bench;

static double part_of(const tl_sym3 *s, int k)
{
    const double parts[6] = {s->xx, s->yy, s->zz, s->xy, s->yz, s->zx};
    return parts[k];
}

static const char *const names[6] = {"xx", "yy", "zz", "xy", "yz", "zx"};

/* Where the test is, for a sentence. */
static const char *place(const bench *b, char text[40])
{
    if (b->leg == 0)
        return "start of the path";
    snprintf(text, 40, "path[%zu]", b->leg);
    return text;
}

/* ---------------------------------------------------------------- the solid -------------- */

/* The solid after an increment of strain, in the first lane, and with `little` more of the k-th held component in lane
 * k + 1. */
static tl_status try_strain(const bench *b, const double d[6], double little, sample *out)
{
    double *state[TL_SOLID_COLUMNS];
    char where[40];
    *out = b->now;
    for (int k = 0; k < 6; k++)
        for (uint32_t l = 0; l < TL_LANES; l++)
            out->c[TL_ZONE_AT_STRAIN + k][l] = d[k];
    for (int k = 0; k < b->many; k++)
        out->c[TL_ZONE_AT_STRAIN + b->list[k]][k + 1] += little;
    tl_solid_batch batch = tl_solid_batch_of(out->c[0], TL_LANES, out->flags, state, TL_SOLID_COLUMNS);
    batch.count = TL_LANES;
    batch.dt = b->dt;
    tl_report report;
    tl_status status = tl_solid_update(&b->solid, &batch, &report);
    if (status != TL_OK)
        return tl_fail(b->error, status, "solid_test, %s: solid '%s': %s", place(b, where), b->solid.kind->name,
                       tl_report_text(&report, status));
    double sum = 0;
    for (uint32_t k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_STATE + b->solid.columns; k++)
        sum += 0 * out->c[k][0];
    if (!isfinite(sum))
        return tl_fail(b->error, TL_E_NUMERIC,
                       "solid_test, %s: solid '%s' gives a stress, state or energy that is not a finite number",
                       place(b, where), b->solid.kind->name);
    return TL_OK;
}

static double stress_of(const sample *s, int k, int lane)
{
    return s->c[TL_ZONE_AT_STRESS + k][lane];
}

/* Stress that is missing at the held components, and its largest. */
static double missing(const bench *b, const sample *s, double r[6])
{
    double largest = 0;
    for (int k = 0; k < b->many; k++) {
        r[k] = b->wanted[b->list[k]] - stress_of(s, b->list[k], 0);
        largest = fmax(largest, fabs(r[k]));
    }
    return largest;
}

/* What counts as none. */
static double enough(const bench *b, const sample *s)
{
    double largest = 0;
    for (int k = 0; k < 6; k++)
        largest = fmax(largest, fmax(fabs(stress_of(s, k, 0)), b->held[k] ? fabs(b->wanted[k]) : 0));
    return STRESS_ERROR * largest + STRAIN_ERROR * b->solid.constrained;
}

/* ---------------------------------------------------------------- held stresses ---------- */

/* Solves a symmetric positive system in place, by Cholesky. */
static void solve(double a[6][6], double x[6], int n)
{
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < j; k++)
            for (int i = j; i < n; i++)
                a[i][j] -= a[i][k] * a[j][k];
        double root = sqrt(a[j][j]);
        for (int i = j; i < n; i++)
            a[i][j] /= root;
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++)
            x[i] -= a[i][k] * x[k];
        x[i] /= a[i][i];
    }
    for (int i = n; i-- > 0;) {
        for (int k = i + 1; k < n; k++)
            x[i] -= a[k][i] * x[k];
        x[i] /= a[i][i];
    }
}

/* The strains, of the held components, by which a pass goes on. */
static void next_pass(const bench *b, const sample *s, const double r[6], double little, double step[6])
{
    double j[6][6], a[6][6], largest = 0;
    for (int k = 0; k < b->many; k++)
        for (int i = 0; i < b->many; i++)
            j[i][k] = (stress_of(s, b->list[i], k + 1) - stress_of(s, b->list[i], 0)) / little;
    for (int p = 0; p < b->many; p++) {
        step[p] = 0;
        for (int i = 0; i < b->many; i++)
            step[p] += j[i][p] * r[i];
        for (int q = 0; q < b->many; q++) {
            a[p][q] = 0;
            for (int i = 0; i < b->many; i++)
                a[p][q] += j[i][p] * j[i][q];
        }
        largest = fmax(largest, a[p][p]);
    }
    /* a solid that has lost all stiffness here is asked as if it had a little */
    double least = 1e-6 * b->solid.shear;
    for (int p = 0; p < b->many; p++)
        a[p][p] += DAMPED * fmax(largest, least * least);
    solve(a, step, b->many);
}

static tl_status not_held(const bench *b, const double r[6])
{
    char where[40];
    int worst = 0;
    for (int k = 1; k < b->many; k++)
        worst = fabs(r[k]) > fabs(r[worst]) ? k : worst;
    return tl_fail(
        b->error, TL_E_STATE,
        "solid_test, %s: solid '%s' cannot hold the stress %s = %g Pa, of which %g Pa are missing: beyond its "
        "strength only strains can be driven",
        place(b, where), b->solid.kind->name, names[b->list[worst]], b->wanted[b->list[worst]], r[worst]);
}

/* Adds a step to the held strains. */
static void add_held(const bench *b, const double from[6], double share, const double step[6], double to[6])
{
    memcpy(to, from, 6 * sizeof *to);
    for (int k = 0; k < b->many; k++)
        to[b->list[k]] += share * step[k];
}

/* The step in which the held components have their stresses. `d`: in, the driven strains, and those of the held ones
 * that are tried first; out, the strains found. */
static tl_status balance(const bench *b, double d[6], sample *out)
{
    double r[6], size = 0;
    for (int k = 0; k < 6; k++) {
        double less = b->held[k] ? fabs(b->wanted[k] - stress_of(&b->now, k, 0)) / b->solid.constrained : fabs(d[k]);
        size = fmax(size, less);
    }
    const double little = LITTLE * fmax(size, STRAIN_ERROR);
    tl_status status = try_strain(b, d, little, out);
    if (status != TL_OK)
        return status;
    double off = missing(b, out, r);
    for (int pass = 0; pass < MOST_PASSES && off > enough(b, out); pass++) {
        double step[6], tried[6], r_tried[6], off_tried = INFINITY, share = 1;
        sample next;
        next_pass(b, out, r, little, step);
        for (int k = 0; k <= MOST_HALVINGS + WEIGHTS_MIXED && !(off_tried < off); k++, share *= 0.5) {
            if (k == MOST_HALVINGS + 1) /* by the moduli instead */
                for (int i = 0; i < b->many; i++)
                    step[i] = r[i] / b->solid.constrained / share;
            add_held(b, d, share, step, tried);
            status = try_strain(b, tried, little, &next);
            if (status != TL_OK)
                return status;
            off_tried = missing(b, &next, r_tried);
        }
        memcpy(d, tried, sizeof tried);
        memcpy(r, r_tried, sizeof r);
        *out = next;
        off = off_tried;
    }
    return off <= enough(b, out) ? TL_OK : not_held(b, r);
}

/* ---------------------------------------------------------------- path ------------------- */

static int64_t steps_of(const tl_solid_test *test, const tl_solid_leg *leg)
{
    return leg->steps > 0 ? leg->steps : test->steps;
}

tl_status tl_solid_test_points(const tl_solid_test *test, size_t *points, tl_error *error)
{
    double steps = 0;
    *points = 1;
    if (test->count == 0)
        return tl_fail(error, TL_E_ARGUMENT,
                       "solid_test: path has no legs: give some, as in path = {{strain = {zz = -0.01}}}");
    for (size_t k = 0; k < test->count; k++) {
        const tl_solid_leg *leg = &test->path[k];
        for (int i = 0; i < 6; i++)
            if (!isnan(part_of(&leg->strain, i)) && !isnan(part_of(&leg->stress, i)))
                return tl_fail(error, TL_E_ARGUMENT,
                               "solid_test, path[%zu]: %s has both a stress and a strain: leave one of them out", k + 1,
                               names[i]);
        steps += (double)steps_of(test, leg);
        if (steps > TL_SOLID_TEST_STEPS)
            return tl_fail(error, TL_E_ARGUMENT, "solid_test, path[%zu]: the test has more than %d steps: give fewer",
                           k + 1, TL_SOLID_TEST_STEPS);
        *points += (size_t)((steps_of(test, leg) + test->every - 1) / test->every);
    }
    return TL_OK;
}

static void note(const bench *b, tl_solid_point *out)
{
    *out = (tl_solid_point){
        .work = b->work, .stored = b->now.c[TL_ZONE_AT_STORED][0], .dissipated = b->heat, .flags = b->now.flags[0]};
    for (int k = 0; k < 6; k++) {
        out->strain[k] = b->strain[k];
        out->stress[k] = stress_of(&b->now, k, 0);
    }
    for (uint32_t k = 0; k < b->solid.columns; k++)
        out->state[k] = b->now.c[TL_ZONE_AT_STATE + k][0];
}

/* A zone as the first lane of a sample has it, in all lanes. */
static void spread(sample *s)
{
    for (int k = TL_ZONE_AT_STRESS; k < TL_ZONE_AT_COUNT; k++)
        for (uint32_t l = 1; l < TL_LANES; l++)
            s->c[k][l] = s->c[k][0];
    for (uint32_t l = 1; l < TL_LANES; l++)
        s->flags[l] = s->flags[0];
}

/* A step of the strains `d`, of which those of the held components are sought. */
static tl_status make_step(bench *b, double d[6])
{
    sample next;
    tl_status status = balance(b, d, &next);
    if (status != TL_OK)
        return status;
    spread(&next);
    for (int k = 0; k < 6; k++) {
        double mean = 0.5 * (stress_of(&b->now, k, 0) + stress_of(&next, k, 0));
        b->work += (k < 3 ? 1 : 2) * mean * d[k];
        b->strain[k] += d[k];
    }
    b->heat += next.c[TL_ZONE_AT_DISSIPATED][0];
    b->now = next;
    return TL_OK;
}

/* The whole path of a value over a leg of `steps`, after k of them. */
static double part(double from, double to, int64_t k, int64_t steps)
{
    return k == steps ? to : from + (to - from) * ((double)k / (double)steps);
}

/* Walks a leg; the points go from `*points` on. */
static tl_status walk(bench *b, const tl_solid_leg *leg, tl_solid_point **points)
{
    int64_t steps = steps_of(b->test, leg);
    double from[6], to[6], d[6] = {0};
    b->many = 0;
    for (int k = 0; k < 6; k++) {
        double strain = part_of(&leg->strain, k), stress = part_of(&leg->stress, k);
        b->held[k] = isnan(strain);
        from[k] = b->held[k] ? stress_of(&b->now, k, 0) : b->strain[k];
        to[k] = b->held[k] ? (isnan(stress) ? from[k] : stress) : strain;
        if (b->held[k])
            b->list[b->many++] = k;
    }
    b->dt = 1 / (double)steps;
    for (int64_t n = 1; n <= steps; n++) {
        for (int k = 0; k < 6; k++) {
            double next = part(from[k], to[k], n, steps);
            b->wanted[k] = next;
            if (!b->held[k])
                d[k] = next - b->strain[k];
        }
        tl_status status = make_step(b, d);
        if (status != TL_OK)
            return status;
        for (int k = 0; k < 6; k++)
            if (!b->held[k]) /* without the roundings of a sum */
                b->strain[k] = b->wanted[k];
        if (n % b->test->every == 0 || n == steps)
            note(b, (*points)++);
    }
    return TL_OK;
}

/* The zone under the stress of the start; heat and work count from there. */
static tl_status begin(bench *b)
{
    sample *now = &b->now;
    double d[6] = {0};
    uint32_t column = TL_ZONE_AT_STATE;
    for (uint32_t k = 0; k < b->solid.kind->state_count; k++) {
        const tl_state *state = tl_kind_state(b->solid.kind, k);
        for (uint32_t c = tl_state_width(state->kind); c > 0; c--)
            now->c[column++][0] = state->initial;
    }
    for (int k = 0; k < 6; k++)
        now->c[TL_ZONE_AT_STRESS + k][0] = part_of(&b->test->stress, k);
    for (uint32_t l = 0; l < TL_LANES; l++) {
        now->c[TL_ZONE_AT_VOLUME][l] = 1;
        now->c[TL_ZONE_AT_EXTENT][l] = b->test->extent;
    }
    spread(now);
    tl_status status = make_step(b, d);
    b->work = now->c[TL_ZONE_AT_STORED][0];
    b->heat = 0;
    return status;
}

tl_status tl_solid_test_run(const tl_solid_test *test, tl_solid_point *points, size_t *ends, const tl_kind **solid,
                            tl_error *error)
{
    size_t count;
    char context[TL_ERROR_TEXT / 2];
    bench b = {.test = test, .error = error};
    tl_status status = tl_solid_test_points(test, &count, error);
    if (status != TL_OK)
        return status;
    const tl_kind *kind = tl_plugin_find(TL_KIND_SOLID, test->solid);
    if (!kind)
        return tl_kind_unknown(error, TL_KIND_SOLID, test->solid);
    snprintf(context, sizeof context, "solid_test, solid '%.40s'", kind->name);
    status = tl_solid_make(kind, test->params, NULL, context, error, &b.solid);
    if (status != TL_OK)
        return status;
    tl_solid_point *at = points;
    status = begin(&b);
    if (status == TL_OK)
        note(&b, at++);
    for (size_t k = 0; k < test->count && status == TL_OK; k++) {
        b.leg = k + 1;
        status = walk(&b, &test->path[k], &at);
        if (ends)
            ends[k] = (size_t)(at - points) - 1;
    }
    tl_solid_clear(&b.solid);
    if (solid)
        *solid = kind;
    return status;
}
