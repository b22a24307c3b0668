/* damping.c - the conformance check of dampings.
 *
 * With each set of parameters 64 bodies of random masses go through random motions under random forces; a few rest. Every
 * step is computed as a whole, in parts and body by body. */
#include "check/check.h"

#include "base/inside.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BODIES 64
/* Bodies behind the batch that nobody may write to, and the number there. */
#define GUARD TL_LANES
#define MOST (BODIES + TL_LANES + GUARD)
#define UNTOUCHED (-7.25e77)
#define STEPS 24
#define DT 1e-4
/* Power that may seem to be given, relative to |F||v|: rounding. */
#define ROUNDING 1e-12

enum { RUNS, REPEATS, ALONE, SPLIT, WRITES, FINITE, BRAKES, RESTS, FACTOR, STATES };

const tl_check_rule tl_check_damping_rules[] = {
    [RUNS] = {"runs", "begin() and update() return TL_OK, always when never_fails is set"},
    [REPEATS] = {"repeats", "the same call gives the same bits"},
    [ALONE] = {"one by one", "a body alone gets the bits that it gets in a batch"},
    [SPLIT] = {"split", "batches of other sizes and orders give the same bits"},
    [WRITES] = {"writes",
                "nothing is written but damping forces, moments and alpha; states in begin()"},
    [FINITE] = {"finite", "forces, moments, alpha and states are finite numbers"},
    [BRAKES] = {"brakes", "alpha is not negative, and no body is given power"},
    [RESTS] = {"rests", "a body without velocity is given no force"},
    [FACTOR] = {"step factor", "step_factor() is in (0, 1]"},
    [STATES] = {"states", "each declared state is written"},
    {NULL, NULL},
};

/* Columns: what is given, then what the damping writes. */
enum {
    VELOCITY,
    SPIN = VELOCITY + 3,
    FORCE = SPIN + 3,
    MOMENT = FORCE + 3,
    FORCE_BEFORE = MOMENT + 3,
    MOMENT_BEFORE = FORCE_BEFORE + 3,
    MASS = MOMENT_BEFORE + 3,
    INERTIA,
    OUT,
    OUT_FORCE = OUT,
    OUT_MOMENT = OUT_FORCE + 3,
    OUT_ALPHA = OUT_MOMENT + 3,
    COLUMNS
};

typedef struct bodies {
    double c[COLUMNS][BODIES];
} bodies;

typedef struct buffer {
    _Alignas(TL_ALIGN) double c[COLUMNS][MOST];
} buffer;

typedef struct trial {
    tl_checker *c;
    const tl_damping_ops *ops;
    const void *self;
    uint32_t columns;
    double state[TL_STATE_COLUMNS + 1]; /* one more, which is not declared */
    double *at[2 * TL_STATE_COLUMNS];
    bodies in, out;
    uint32_t written;
} trial;

static tl_vec3 vec(const bodies *b, int column, size_t i)
{
    return tl_v3(b->c[column][i], b->c[column + 1][i], b->c[column + 2][i]);
}

static void put(bodies *b, int column, size_t i, tl_vec3 v)
{
    b->c[column][i] = v.x;
    b->c[column + 1][i] = v.y;
    b->c[column + 2][i] = v.z;
}

/* Random bodies in random motion; every eighth rests. */
static void next_motion(trial *t, int step)
{
    static const double low[] = {-4, -4, 2, 2}, high[] = {1, 1, 6, 6};
    bodies before = t->in;
    for (size_t i = 0; i < BODIES; i++) {
        uint64_t key = tl_key(tl_key(tl_key(1980, (uint64_t)t->c->set), (uint64_t)step), i);
        uint64_t body = tl_key(1981, i);
        for (int k = 0; k < 4; k++) {
            uint64_t own = tl_key(key, (uint64_t)k);
            double size = tl_check_scale(tl_key(own, 9), low[k], high[k]);
            bool rests = k < 2 && i % 8 == 7;
            put(&t->in, VELOCITY + 3 * k, i,
                tl_v3_scale(rests ? 0 : size, tl_check_direction(own)));
        }
        for (int k = 0; k < 6; k++)
            t->in.c[FORCE_BEFORE + k][i] = step ? before.c[FORCE + k][i] : 0;
        t->in.c[MASS][i] = tl_check_scale(tl_key(body, 1), 1, 6);
        t->in.c[INERTIA][i] = t->in.c[MASS][i] * tl_check_scale(tl_key(body, 2), -1, 1);
        for (int k = OUT; k < COLUMNS; k++)
            t->in.c[k][i] = 0;
    }
}

/* ---------------------------------------------------------------- one call --------------- */

static void note_failure(trial *t, const char *function, tl_report *report, tl_status status)
{
    if (status != TL_OK)
        tl_check_note(t->c, RUNS, "%s() fails%s: %s", function,
                      t->ops->never_fails ? ", though never_fails is set" : "",
                      tl_report_text(report, status));
}

static tl_status call(trial *t, buffer *b, size_t count)
{
    tl_damping_batch batch = {.size = sizeof batch,
                              .count = (uint32_t)count,
                              .dt = DT,
                              .mass = b->c[MASS],
                              .inertia = b->c[INERTIA],
                              .alpha = b->c[OUT_ALPHA],
                              .state = t->at};
    for (int k = 0; k < 3; k++) {
        batch.velocity[k] = b->c[VELOCITY + k];
        batch.angular_velocity[k] = b->c[SPIN + k];
        batch.force[k] = b->c[FORCE + k];
        batch.moment[k] = b->c[MOMENT + k];
        batch.force_before[k] = t->ops->before ? b->c[FORCE_BEFORE + k] : NULL;
        batch.moment_before[k] = t->ops->before ? b->c[MOMENT_BEFORE + k] : NULL;
        batch.damping_force[k] = b->c[OUT_FORCE + k];
        batch.damping_moment[k] = b->c[OUT_MOMENT + k];
    }
    tl_report report = {.size = sizeof report};
    tl_enter(t->c->kind, "update");
    tl_status status = t->ops->update(t->self, &batch, &report);
    tl_leave();
    note_failure(t, "update", &report, status);
    return status;
}

/* Calls the damping on some bodies, as the host would: the batch is padded, with bodies that rest. */
static bool run(trial *t, bodies *out, const size_t *order, size_t begin, size_t count)
{
    buffer now, before;
    double state[TL_STATE_COLUMNS + 1];
    size_t padded = (count + TL_LANES - 1) / TL_LANES * TL_LANES;
    for (size_t l = 0; l < MOST; l++)
        for (int k = 0; k < COLUMNS; k++) {
            size_t i = l < count ? (order ? order[begin + l] : begin + l) : 0;
            double rest = k == MASS || k == INERTIA ? 1 : 0;
            now.c[k][l] = l < count ? t->in.c[k][i] : l < padded ? rest : UNTOUCHED;
        }
    before = now;
    memcpy(state, t->state, sizeof state);
    if (call(t, &now, padded) != TL_OK)
        return false;
    for (int k = 0; k < COLUMNS; k++) {
        size_t from = k < OUT ? 0 : padded, bytes = (MOST - from) * sizeof now.c[k][0];
        if (memcmp(now.c[k] + from, before.c[k] + from, bytes) != 0)
            tl_check_note(t->c, WRITES, "update() writes to %s",
                          k < OUT ? "a column of what it is given" : "what lies behind the batch");
    }
    if (memcmp(state, t->state, sizeof state) != 0)
        tl_check_note(t->c, WRITES, "update() writes to the states, which is for begin()");
    for (size_t l = 0; l < count; l++)
        for (int k = OUT; k < COLUMNS; k++)
            out->c[k][order ? order[begin + l] : begin + l] = now.c[k][l];
    return true;
}

static bool run_parts(trial *t, bodies *out, const size_t *order, const size_t *parts, size_t most)
{
    size_t begin = 0;
    for (size_t k = 0; begin < BODIES; begin += parts[k++ % most])
        if (!run(t, out, order, begin, parts[k % most]))
            return false;
    return true;
}

static void compare(trial *t, int check, const bodies *other, const char *how)
{
    for (int k = OUT; k < COLUMNS; k++)
        for (size_t i = 0; i < BODIES; i++)
            if (memcmp(&t->out.c[k][i], &other->c[k][i], sizeof(double)) != 0)
                tl_check_note(t->c, check, "%s %.17g in a batch of 64 bodies, %.17g %s",
                              k == OUT_ALPHA ? "alpha is" : "a damping force is", t->out.c[k][i],
                              other->c[k][i], how);
}

/* ---------------------------------------------------------------- one step --------------- */

static void begin_step(trial *t, int step)
{
    tl_damping_totals totals = {.size = sizeof totals, .dt = DT};
    tl_report report = {.size = sizeof report};
    double before[TL_STATE_COLUMNS + 1];
    memcpy(before, t->state, sizeof before);
    for (size_t i = 0; i < BODIES; i++) {
        tl_vec3 v = vec(&t->in, VELOCITY, i), w = vec(&t->in, SPIN, i);
        totals.power_unit +=
            t->in.c[MASS][i] * tl_v3_dot(v, v) + t->in.c[INERTIA][i] * tl_v3_dot(w, w);
        totals.power += tl_v3_dot(v, vec(&t->in, FORCE, i)) + tl_v3_dot(w, vec(&t->in, MOMENT, i));
    }
    totals.kinetic = 0.5 * totals.power_unit;
    totals.kinetic_rate =
        totals.kinetic / DT * tl_check_between(tl_key(7, (uint64_t)step), -0.01, 0.01);
    if (t->ops->begin) {
        tl_enter(t->c->kind, "begin");
        note_failure(t, "begin", &report, t->ops->begin(t->self, &totals, t->at, &report));
        tl_leave();
    }
    for (uint32_t k = 0; k < t->columns; k++) {
        t->written |= t->state[k] != before[k] ? 1u << k : 0u;
        if (!isfinite(t->state[k]))
            tl_check_note(t->c, FINITE, "state '%s' is %g", t->c->kind->states[k].name,
                          t->state[k]);
    }
    if (memcmp(t->state + t->columns, before + t->columns,
               (TL_STATE_COLUMNS + 1 - t->columns) * sizeof before[0]) != 0)
        tl_check_note(t->c, WRITES, "begin() writes to a state that the damping does not declare");
}

static void check_numbers(trial *t)
{
    for (size_t i = 0; i < BODIES; i++) {
        tl_vec3 v = vec(&t->in, VELOCITY, i), f = vec(&t->out, OUT_FORCE, i);
        tl_vec3 w = vec(&t->in, SPIN, i), m = vec(&t->out, OUT_MOMENT, i);
        double alpha = t->out.c[OUT_ALPHA][i], power = tl_v3_dot(v, f), turning = tl_v3_dot(w, m);
        bool rests = tl_v3_norm(v) == 0 && tl_v3_norm(w) == 0;
        for (int k = OUT; k < COLUMNS; k++)
            if (!isfinite(t->out.c[k][i]))
                tl_check_note(t->c, FINITE, "%s is %g",
                              k == OUT_ALPHA ? "alpha" : "a damping force", t->out.c[k][i]);
        if (alpha < 0)
            tl_check_note(t->c, BRAKES, "alpha = %g 1/s gives energy", alpha);
        if (power > ROUNDING * tl_v3_norm(v) * tl_v3_norm(f) ||
            turning > ROUNDING * tl_v3_norm(w) * tl_v3_norm(m))
            tl_check_note(t->c, BRAKES, "a body gets %g W of its damping force, %g W of the moment",
                          power, turning);
        if (rests && (tl_v3_norm(f) != 0 || tl_v3_norm(m) != 0))
            tl_check_note(t->c, RESTS, "a body at rest gets %g N and %g N m", tl_v3_norm(f),
                          tl_v3_norm(m));
    }
}

static void run_trial(trial *t)
{
    static const size_t one[] = {1}, parts[] = {8, 3, 40, 13};
    double factor = t->ops->step_factor(t->self);
    if (!(factor > 0 && factor <= 1))
        tl_check_note(t->c, FACTOR, "step_factor() = %g", factor);
    for (int step = 0; step < STEPS; step++) {
        bodies other;
        size_t order[BODIES];
        next_motion(t, step);
        begin_step(t, step);
        for (size_t i = 0; i < BODIES; i++)
            order[i] = (i * 37 + (size_t)step) % BODIES;
        if (!run(t, &t->out, NULL, 0, BODIES))
            return;
        if (run_parts(t, &other, NULL, one, 1))
            compare(t, ALONE, &other, "alone");
        if (run_parts(t, &other, order, parts, sizeof parts / sizeof *parts))
            compare(t, SPLIT, &other, "in batches of 8, 3, 40 and 13 in another order");
        if (run(t, &other, NULL, 0, BODIES))
            compare(t, REPEATS, &other, "when called again");
        check_numbers(t);
    }
}

/* ---------------------------------------------------------------- all of it -------------- */

static tl_status open_damping(trial *t, tl_checker *c, void *params)
{
    tl_report report = {.size = sizeof report};
    t->c = c;
    t->ops = c->kind->ops;
    t->self = params;
    t->columns = c->kind->state_count;
    for (uint32_t k = 0; k < TL_STATE_COLUMNS + 1; k++)
        t->state[k] = k < t->columns ? c->kind->states[k].initial : UNTOUCHED;
    for (uint32_t k = 0; k < 2 * TL_STATE_COLUMNS; k++)
        t->at[k] = &t->state[k < t->columns ? k : TL_STATE_COLUMNS];
    if (!t->ops->create)
        return TL_OK;
    void *self = NULL;
    tl_status status = t->ops->create(params, &self, &report);
    if (status != TL_OK)
        return tl_fail(c->error, status, "'%s' cannot be tried: %s", c->kind->name,
                       tl_report_text(&report, status));
    t->self = self;
    return TL_OK;
}

tl_status tl_check_damping_kind(tl_checker *c)
{
    trial *t = calloc(1, sizeof *t);
    void *params = malloc(c->kind->params_size + 1), *held;
    int tried = 0, most = 8 * TL_CHECK_SETS;
    tl_status status = t && params ? TL_OK : tl_fail_memory(c->error);
    for (int set = 0; status == TL_OK && set < most && tried < TL_CHECK_SETS; set++) {
        tl_status read = tl_check_params(c, set, params, &held);
        if (read == TL_OK && (read = open_damping(t, c, params)) == TL_OK) {
            run_trial(t);
            if (t->ops->destroy)
                t->ops->destroy((void *)(uintptr_t)t->self);
            tried++;
        }
        free(held);
        if (set == 0 && c->args && c->args->count > 0)
            status = read;
    }
    if (status == TL_OK && tried == 0)
        status = TL_E_ARGUMENT; /* with the sentence of the last attempt */
    for (uint32_t k = 0; status == TL_OK && k < t->columns; k++) {
        c->params_text[0] = '\0';
        if (!(t->written >> k & 1) && !tl_check_failed(c, RUNS))
            tl_check_note(c, STATES, "state '%s' is declared and was never written",
                          c->kind->states[k].name);
    }
    free(t);
    free(params);
    return status;
}
