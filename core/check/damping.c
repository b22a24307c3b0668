/* damping.c - the conformance check of dampings.
 *
 * With each set of parameters 64 bodies of random masses go through random motions under random forces; a few rest.
 * Every step is computed as a whole, in parts and body by body. */
#include "check/damping.h"

#include "base/inside.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BODIES TL_CHECK_POINTS
/* Bodies behind the batch that nobody may write to. */
#define GUARD TL_LANES
#define MOST (BODIES + TL_LANES + GUARD)
/* States that a damping may look for: twice as many as there may be. */
#define STATES_MOST (2 * TL_STATE_COLUMNS)
#define STEPS 24
/* Constant: s, of a step. */
#define DT 1e-4
/* Tolerance: power that may seem to be given, relative to |F||v|: rounding. */
#define ROUNDING 1e-12
/* Tolerance: relative error of forces that turn with the bodies or grow with the masses. Test: unit/test_check. */
#define SAME 1e-9

enum { RUNS, REPEATS, ALONE, SPLIT, WRITES, READS, FINITE, BRAKES, RESTS, TURNED, MASSES, FACTOR, STATES, PARAMETERS };

static const tl_check_rule rules[] = {
    [RUNS] = {"runs", "begin() and update() return TL_OK, always when never_fails is set"},
    [REPEATS] = {"repeats", "the same call gives the same bits"},
    [ALONE] = {"one by one", "a body alone gets the bits that it gets in a batch"},
    [SPLIT] = {"split", "batches of other sizes and orders give the same bits"},
    [WRITES] = {"writes", "nothing is written but damping forces, moments and alpha; states in begin()"},
    [READS] = {"reads", "nothing depends on states that are not declared or on what lies behind the batch"},
    [FINITE] = {"finite", "forces, moments, alpha and states are finite numbers"},
    [BRAKES] = {"brakes", "alpha is not negative, and no body is given power"},
    [RESTS] = {"rests", "a body without velocity is given no force"},
    [TURNED] = {"turned", "bodies turned to other axes get the turned forces"},
    [MASSES] = {"masses", "twice the masses and forces get twice the damping force"},
    [FACTOR] = {"step factor", "step_factor() is in (0, 1], and allows for damping forces that grow "
                               "with the unbalanced ones"},
    [STATES] = {"states", "each declared state is written and read"},
    [PARAMETERS] = {"parameters", "each parameter has an effect"},
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
    MOVING_MASS,
    MOVING_INERTIA,
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
    void *self;
    uint32_t columns;
    double state[STATES_MOST]; /* those behind the declared ones are nobody's */
    double *at[STATES_MOST];
    bodies in, out;
    double began[STATES_MOST]; /* states before begin() */
    tl_damping_totals totals;  /* of the step */
    double amplified;          /* by how much the unbalanced forces grow by those of damping, at the most */
    bool other;                /* what is nobody's holds other numbers than usually */
    bool looks_back;           /* at the forces of the step before */
    uint32_t written, read;    /* bit k: state k has been */
    bool matters[TL_CHECK_PARAMS];
} trial;

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
            tl_check_put(t->in.c[VELOCITY + 3 * k], i, tl_v3_scale(rests ? 0 : size, tl_check_direction(own)));
        }
        for (int k = 0; k < 6; k++)
            t->in.c[FORCE_BEFORE + k][i] = step ? before.c[FORCE + k][i] : 0;
        t->in.c[MASS][i] = tl_check_scale(tl_key(body, 1), 1, 6);
        t->in.c[INERTIA][i] = t->in.c[MASS][i] * tl_check_scale(tl_key(body, 2), -1, 1);
        /* as by mass scaling, which every fourth does not need */
        for (int k = 0; k < 2; k++) {
            double scale = i % 4 == 0 ? 1 : tl_check_scale(tl_key(body, 3 + (uint64_t)k), k == 0 ? -1 : 0, 2);
            t->in.c[MOVING_MASS + k][i] = t->in.c[MASS + k][i] * scale;
        }
        for (int k = OUT; k < COLUMNS; k++)
            t->in.c[k][i] = 0;
    }
}

/* ---------------------------------------------------------------- one call --------------- */

static void note_failure(trial *t, const char *function, tl_report *report, tl_status status)
{
    if (status != TL_OK)
        tl_check_note(t->c, RUNS, "%s() fails%s: %s", function,
                      t->ops->never_fails ? ", though never_fails is set" : "", tl_report_text(report, status));
}

static tl_status call(trial *t, buffer *b, size_t count)
{
    tl_damping_batch batch = {.size = sizeof batch,
                              .count = (uint32_t)count,
                              .dt = DT,
                              .mass = b->c[MASS],
                              .inertia = b->c[INERTIA],
                              .alpha = b->c[OUT_ALPHA],
                              .state = t->at,
                              .moving_mass = b->c[MOVING_MASS],
                              .moving_inertia = b->c[MOVING_INERTIA]};
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
static bool run(trial *t, const bodies *in, bodies *out, const size_t *order, size_t begin, size_t count)
{
    buffer now, before;
    double state[STATES_MOST];
    size_t padded = (count + TL_LANES - 1) / TL_LANES * TL_LANES;
    const tl_check_batch of = {order, begin, count, padded, MOST};
    for (int k = 0; k < COLUMNS; k++)
        tl_check_fill(&of, now.c[k], in->c[k], k >= MASS && k < OUT ? 1 : 0, tl_check_nobodys(k, t->other));
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
            out->c[k][tl_check_entry(&of, l)] = now.c[k][l];
    return true;
}

static bool run_parts(trial *t, bodies *out, const size_t *order, const size_t *parts, size_t most)
{
    size_t begin = 0;
    for (size_t k = 0; begin < BODIES; begin += parts[k++ % most])
        if (!run(t, &t->in, out, order, begin, parts[k % most]))
            return false;
    return true;
}

static void compare(trial *t, int check, const bodies *other, const char *how)
{
    for (int k = OUT; k < COLUMNS; k++)
        for (size_t i = 0; i < BODIES; i++)
            if (memcmp(&t->out.c[k][i], &other->c[k][i], sizeof(double)) != 0)
                tl_check_note(t->c, check, "%s %.17g in a batch of 64 bodies, %.17g %s",
                              k == OUT_ALPHA ? "alpha is" : "a damping force is", t->out.c[k][i], other->c[k][i], how);
}

/* ---------------------------------------------------------------- one step --------------- */

static void call_begin(trial *t)
{
    tl_report report = {.size = sizeof report};
    if (!t->ops->begin)
        return;
    tl_enter(t->c->kind, "begin");
    note_failure(t, "begin", &report, t->ops->begin(t->self, &t->totals, t->at, &report));
    tl_leave();
}

static void begin_step(trial *t, int step)
{
    tl_damping_totals totals = {.size = sizeof totals, .dt = DT};
    double before[STATES_MOST];
    memcpy(before, t->state, sizeof before);
    memcpy(t->began, t->state, sizeof t->began);
    for (size_t i = 0; i < BODIES; i++) {
        tl_vec3 v = tl_check_vec(t->in.c[VELOCITY], i), w = tl_check_vec(t->in.c[SPIN], i);
        totals.power_unit += t->in.c[MASS][i] * tl_v3_dot(v, v) + t->in.c[INERTIA][i] * tl_v3_dot(w, w);
        totals.power += tl_v3_dot(v, tl_check_vec(t->in.c[FORCE], i)) + tl_v3_dot(w, tl_check_vec(t->in.c[MOMENT], i));
    }
    totals.kinetic = 0.5 * totals.power_unit;
    totals.kinetic_rate = totals.kinetic / DT * tl_check_between(tl_key(7, (uint64_t)step), -0.01, 0.01);
    t->totals = totals;
    call_begin(t);
    for (uint32_t k = 0; k < t->columns; k++) {
        t->written |= t->state[k] != before[k] ? 1u << k : 0u;
        if (!isfinite(t->state[k]))
            tl_check_note(t->c, FINITE, "state '%s' is %g", t->c->kind->states[k].name, t->state[k]);
    }
    if (memcmp(t->state + t->columns, before + t->columns, (STATES_MOST - t->columns) * sizeof before[0]) != 0)
        tl_check_note(t->c, WRITES, "begin() writes to a state that the damping does not declare");
}

static void check_numbers(trial *t)
{
    for (size_t i = 0; i < BODIES; i++) {
        tl_vec3 v = tl_check_vec(t->in.c[VELOCITY], i), f = tl_check_vec(t->out.c[OUT_FORCE], i);
        tl_vec3 w = tl_check_vec(t->in.c[SPIN], i), m = tl_check_vec(t->out.c[OUT_MOMENT], i);
        double alpha = t->out.c[OUT_ALPHA][i], power = tl_v3_dot(v, f), turning = tl_v3_dot(w, m);
        bool rests = tl_v3_norm(v) == 0 && tl_v3_norm(w) == 0;
        for (int k = OUT; k < COLUMNS; k++)
            if (!isfinite(t->out.c[k][i]))
                tl_check_note(t->c, FINITE, "%s is %g", k == OUT_ALPHA ? "alpha" : "a damping force", t->out.c[k][i]);
        if (alpha < 0)
            tl_check_note(t->c, BRAKES, "alpha = %g 1/s gives energy", alpha);
        if (power > ROUNDING * tl_v3_norm(v) * tl_v3_norm(f) || turning > ROUNDING * tl_v3_norm(w) * tl_v3_norm(m))
            tl_check_note(t->c, BRAKES, "a body gets %g W of its damping force, %g W of the moment", power, turning);
        if (rests && (tl_v3_norm(f) != 0 || tl_v3_norm(m) != 0))
            tl_check_note(t->c, RESTS, "a body at rest gets %g N and %g N m", tl_v3_norm(f), tl_v3_norm(m));
    }
}

/* ---------------------------------------------------------------- other steps ------------ */

/* Another order of the axes for each body, two of them the other way round. */
static void turn(bodies *b)
{
    static const int vectors[] = {VELOCITY, SPIN, FORCE, MOMENT, FORCE_BEFORE, MOMENT_BEFORE, OUT_FORCE, OUT_MOMENT};
    static const double signs[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    for (size_t v = 0; v < sizeof vectors / sizeof *vectors; v++)
        for (size_t i = 0; i < BODIES; i++) {
            double was[3];
            for (int k = 0; k < 3; k++)
                was[k] = b->c[vectors[v] + k][i];
            for (size_t k = 0; k < 3; k++)
                b->c[vectors[v] + (int)k][i] = signs[i / 3 % 4][k] * was[(k + i % 3) % 3];
        }
}

/* Compares with what was expected, column by column. */
static void expect(trial *t, int check, const bodies *expected, const bodies *is, const char *how)
{
    for (size_t i = 0; i < BODIES; i++)
        for (int k = OUT; k < COLUMNS; k++) {
            int first = k < OUT_ALPHA ? k - (k - OUT) % 3 : k;
            double size = k < OUT_ALPHA ? tl_v3_norm(tl_check_vec(expected->c[first], i)) : expected->c[k][i];
            if (fabs(expected->c[k][i] - is->c[k][i]) > SAME * (fabs(size) + fabs(is->c[k][i])))
                tl_check_note(t->c, check, "%s is %g, not %g, %s", k == OUT_ALPHA ? "alpha" : "a damping force",
                              is->c[k][i], expected->c[k][i], how);
        }
}

static void check_turned(trial *t)
{
    bodies in = t->in, out, expected = t->out;
    turn(&in);
    turn(&expected);
    if (run(t, &in, &out, NULL, 0, BODIES))
        expect(t, TURNED, &expected, &out, "for a body that is turned to other axes");
}

static void check_masses(trial *t)
{
    bodies in = t->in, out, expected = t->out;
    for (int k = FORCE; k < OUT_ALPHA; k++)
        for (size_t i = 0; i < BODIES; i++) {
            in.c[k][i] *= 2;
            expected.c[k][i] *= 2;
        }
    if (run(t, &in, &out, NULL, 0, BODIES))
        expect(t, MASSES, &expected, &out, "with twice the mass, inertia, force and moment");
}

static double share_of(const trial *t, const bodies *in, const bodies *out, int given, int made, size_t i)
{
    tl_vec3 more = tl_v3_sub(tl_check_vec(in->c[given], i), tl_check_vec(t->in.c[given], i));
    tl_vec3 adds = tl_v3_sub(tl_check_vec(out->c[made], i), tl_check_vec(t->out.c[made], i));
    double size = tl_v3_norm(more);
    return size > 0 ? tl_v3_norm(adds) / size : 0;
}

/* A damping force that grows with the unbalanced one makes the model stiffer. */
static void check_factor(trial *t, double factor)
{
    bodies in = t->in, out;
    for (int k = FORCE; k < MASS; k++)
        for (size_t i = 0; i < BODIES; i++)
            in.c[k][i] *= 2;
    if (!run(t, &in, &out, NULL, 0, BODIES))
        return;
    for (size_t i = 0; i < BODIES; i++) {
        t->amplified = fmax(t->amplified, share_of(t, &in, &out, FORCE, OUT_FORCE, i));
        t->amplified = fmax(t->amplified, share_of(t, &in, &out, MOMENT, OUT_MOMENT, i));
    }
    double most = 1 / sqrt(1 + t->amplified);
    if (factor > most * (1 + SAME))
        tl_check_note(t->c, FACTOR,
                      "step_factor() = %g, but damping forces grow by %g of the unbalanced ones, which "
                      "allows for 1 / sqrt(1 + %g) = %g",
                      factor, t->amplified, t->amplified, most);
}

/* Whether the step gives other forces than it did, from such bodies and the present states. */
static bool gives_other_forces(trial *t, const bodies *in)
{
    bodies out;
    return run(t, in, &out, NULL, 0, BODIES) &&
           memcmp(t->out.c[OUT], out.c[OUT], (COLUMNS - OUT) * sizeof out.c[0]) != 0;
}

/* Goes from states before begin() through the step once more; whether it gave something else. The states are then what
 * they were after the step. */
static bool gives_other(trial *t, const double began[STATES_MOST])
{
    double after[STATES_MOST];
    memcpy(after, t->state, sizeof after);
    memcpy(t->state, began, sizeof after);
    call_begin(t);
    bool other = memcmp(after, t->state, t->columns * sizeof after[0]) != 0;
    other |= gives_other_forces(t, &t->in);
    memcpy(t->state, after, sizeof after);
    return other;
}

/* With other numbers in what is nobody's. */
static void check_reads(trial *t)
{
    double began[STATES_MOST];
    memcpy(began, t->began, sizeof began);
    for (uint32_t k = t->columns; k < STATES_MOST; k++)
        began[k] = tl_check_nobodys((int)k, true);
    t->other = true;
    if (gives_other(t, began))
        tl_check_note(t->c, READS,
                      "what the damping gives depends on a state that it does not declare, or on what "
                      "lies behind the batch");
    t->other = false;
}

/* States that something depends on: another state, the bodies or itself; from before begin() or after it. */
static void see_states(trial *t)
{
    for (uint32_t k = 0; k < t->columns; k++) {
        double began[STATES_MOST], is = t->state[k];
        if (t->read >> k & 1)
            continue;
        memcpy(began, t->began, sizeof began);
        began[k] = 1.5 * began[k] + 0.25;
        bool other = gives_other(t, began);
        t->state[k] = 1.5 * is + 0.25;
        other |= gives_other_forces(t, &t->in);
        t->state[k] = is;
        t->read |= other ? 1u << k : 0;
    }
}

/* What it gives contacts, s. */
static double beta_of(const trial *t, const void *self)
{
    double beta = 0;
    if (t->ops->contact)
        t->ops->contact(self, &beta);
    return beta;
}

/* The same step of a damping with another value of one parameter. */
static void see_param(trial *t, uint32_t k, void *params)
{
    void *held = NULL, *own = t->self;
    char text[sizeof t->c->params_text];
    memcpy(text, t->c->params_text, sizeof text);
    if (tl_check_params(t->c, t->c->set, (int)k, params, &held) == TL_OK &&
        tl_check_create(t->c, t->ops->create, params, &t->self) == TL_OK) {
        t->matters[k] = gives_other(t, t->began) || beta_of(t, own) != beta_of(t, t->self);
        if (t->ops->destroy)
            t->ops->destroy(t->self);
    }
    t->self = own;
    memcpy(t->c->params_text, text, sizeof text);
    free(held);
}

/* Force and moment of the step before, which are only there for those that ask. */
static void see_before(trial *t)
{
    bodies in = t->in;
    for (int k = FORCE_BEFORE; k < MASS; k++)
        for (size_t i = 0; i < BODIES; i++)
            in.c[k][i] = t->in.c[k][(i + 1) % BODIES];
    t->looks_back |= gives_other_forces(t, &in);
}

static void see_params(trial *t)
{
    void *params = malloc(t->c->kind->params_size + 1);
    for (uint32_t k = 0; params && k < t->c->kind->param_count && k < TL_CHECK_PARAMS; k++)
        if (!t->matters[k])
            see_param(t, k, params);
    free(params);
}

/* ---------------------------------------------------------------- all of it -------------- */

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
        if (!run(t, &t->in, &t->out, NULL, 0, BODIES))
            return;
        if (run_parts(t, &other, NULL, one, 1))
            compare(t, ALONE, &other, "alone");
        if (run_parts(t, &other, order, parts, sizeof parts / sizeof *parts))
            compare(t, SPLIT, &other, "in batches of 8, 3, 40 and 13 in another order");
        if (run(t, &t->in, &other, NULL, 0, BODIES))
            compare(t, REPEATS, &other, "when called again");
        check_numbers(t);
        check_turned(t);
        check_masses(t);
        check_factor(t, factor);
        check_reads(t);
        see_states(t);
        see_params(t);
        see_before(t);
    }
}

static void tell_unseen(const trial *t)
{
    tl_checker *c = t->c;
    c->params_text[0] = '\0';
    for (uint32_t k = 0; k < t->columns; k++)
        if (!(t->written >> k & 1))
            tl_check_note(c, STATES, "state '%s' is declared and was never written", c->kind->states[k].name);
        else if (!(t->read >> k & 1))
            tl_check_note(c, STATES, "state '%s' is written and never read: nothing depends on it",
                          c->kind->states[k].name);
    if (t->ops->before && !t->looks_back)
        tl_check_note(c, READS, "before is set, but nothing depends on the forces of the step before");
    for (uint32_t k = 0; k < c->kind->param_count && k < TL_CHECK_PARAMS; k++)
        if (!t->matters[k] && tl_check_asked(c, k))
            tl_check_note(c, PARAMETERS,
                          "parameter '%s' has no effect: another value gives the same forces, alpha and states with "
                          "all of %d sets of parameters",
                          c->kind->params[k].name, TL_CHECK_SETS);
}

static tl_status try_set(tl_checker *c, void *params, void *user)
{
    trial *t = user;
    tl_status status = tl_check_create(c, t->ops->create, params, &t->self);
    if (status != TL_OK)
        return status;
    t->amplified = 0;
    for (uint32_t k = 0; k < STATES_MOST; k++) {
        t->state[k] = k < t->columns ? c->kind->states[k].initial : tl_check_nobodys((int)k, false);
        t->at[k] = &t->state[k];
    }
    run_trial(t);
    if (t->ops->destroy)
        t->ops->destroy(t->self);
    return TL_OK;
}

static tl_status check_kind(tl_checker *c)
{
    trial *t = calloc(1, sizeof *t);
    if (!t)
        return tl_fail_memory(c->error);
    t->c = c;
    t->ops = c->kind->ops;
    t->columns = c->kind->state_count;
    tl_status status = tl_check_sets(c, try_set, t);
    if (status == TL_OK && !tl_check_failed(c, RUNS))
        tell_unseen(t);
    free(t);
    return status;
}

const tl_check_type tl_check_dampings = {rules, check_kind};
