/* law_bench.c - a joint law on one contact point: direct shear, cycles and closure tests (talus/law_test.h).
 *
 * The law gets a batch of TL_LANES points as in a step. The first has an area of 1 m2, and the others are padding. In a
 * test by normal stress s each step looks for the closure c at which
 *
 *     f_n(c) = s + K (c_start - c)
 *
 * by secants in a bracket, on copies of forces and states. The normal force must not fall while the walls close. Work
 * is summed by the trapezoidal rule. */
#include "base/inside.h"
#include "base/law_columns.h"
#include "contact/contacts.h"
#include "force/joint_laws.h"
#include "model/model.h"
#include "model/scope.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdio.h>
#include <talus/law_test.h>

/* The first point of a batch of padding. */
typedef struct sample {
    _Alignas(TL_ALIGN) double c[TL_AT_COUNT][TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
} sample;

typedef struct bench {
    const tl_law_test *test;
    tl_law law;
    tl_error *error;
    sample now;           /* as the last step has left it */
    size_t leg;           /* counted from 1; 0: the start */
    double time;          /* s */
    double shear, stress; /* of the end of the step */
    double start;         /* closure when the normal stress was there */
    double stiffness;     /* of the surroundings; 0 before */
    double work, heat;
} bench;

/* How a step moves the point. */
typedef struct motion {
    double dt, du;
} motion;

/* ---------------------------------------------------------------- the law ---------------- */

/* Where the test is, for a sentence. */
static const char *place(const bench *b, char text[40])
{
    if (b->leg == 0)
        return "start of the path";
    snprintf(text, 40, "path[%zu]", b->leg);
    return text;
}

/* The law after a motion to `closure`, from the present point. */
static tl_status try_closure(const bench *b, const motion *by, double closure, sample *out)
{
    const tl_law_ops *ops = b->law.kind->ops;
    double *state[TL_STATE_COLUMNS];
    char where[40];
    *out = b->now;
    out->c[TL_AT_DU_N][0] = out->c[TL_AT_CLOSURE][0] - closure;
    out->c[TL_AT_CLOSURE][0] = out->c[TL_AT_EDGE][0] = closure;
    out->c[TL_AT_DU_S][0] = by->du;
    out->c[TL_AT_STORED][0] = out->c[TL_AT_DISSIPATED][0] = 0;
    tl_law_batch batch = tl_law_batch_of(out->c[0], TL_LANES, out->flags, state, TL_STATE_COLUMNS);
    batch.count = TL_LANES;
    batch.dt = by->dt;
    tl_report report = {.size = sizeof report};
    tl_enter(b->law.kind, "update");
    tl_status status = ops->update(b->law.self, &batch, &report);
    tl_leave();
    if (status != TL_OK)
        return tl_fail(b->error, status, "law_test, %s: law '%s': %s", place(b, where), b->law.kind->name,
                       tl_report_text(&report, status));
    double sum = 0;
    for (uint32_t k = TL_AT_F_N; k < TL_AT_STATE + b->law.columns; k++)
        sum += 0 * out->c[k][0];
    if (!isfinite(sum))
        return tl_fail(b->error, TL_E_NUMERIC,
                       "law_test, %s: law '%s' gives a force, state or energy that is not a finite number at the shear "
                       "displacement %g m and the closure %g m",
                       place(b, where), b->law.kind->name, b->shear, closure);
    return TL_OK;
}

/* ---------------------------------------------------------------- normal stress ---------- */

/* Tolerance: error of the normal stress that counts as none, relative to the stress, and as a closure of the stiffness
 * that the law names: both are far above the rounding of a spring. */
#define STRESS_ERROR 1e-12
#define CLOSURE_ERROR 1e-19
/* Doublings of the first trial, which the law's stiffness makes too short: up to 1e30 times it. */
#define MOST_DOUBLINGS 100
/* Secants and bisections: a bracket halved 100 times has no more numbers in it. */
#define MOST_PASSES 160

/* One end of a bracket: the closure, and by how much the law's stress is above the one that is wanted. */
typedef struct side {
    double closure, excess;
} side;

typedef struct closure_search {
    const bench *b;
    const motion *by;
    double enough;
    sample *out; /* of the last closure tried */
} closure_search;

static tl_status evaluate(const closure_search *s, double closure, side *at)
{
    const bench *b = s->b;
    tl_status status = try_closure(b, s->by, closure, s->out);
    *at = (side){closure, s->out->c[TL_AT_F_N][0] - b->stress + b->stiffness * (closure - b->start)};
    return status;
}

static tl_status not_held(const bench *b)
{
    char where[40];
    return tl_fail(b->error, TL_E_STATE,
                   "law_test, %s: law '%s' cannot hold the normal stress of %g Pa at the shear displacement %g m: has "
                   "the joint opened or broken?",
                   place(b, where), b->law.kind->name, b->stress, b->shear);
}

/* From two sides of the wanted stress to the closure that has it. */
static tl_status close_in(const closure_search *s, side low, side high)
{
    double last = 0;
    for (int pass = 0; pass < MOST_PASSES; pass++) {
        double middle = 0.5 * (low.closure + high.closure);
        double secant = low.closure - low.excess * (high.closure - low.closure) / (high.excess - low.excess);
        bool inside = secant > low.closure && secant < high.closure;
        /* every third pass halves, so that a kink does not hold one side for ever */
        double closure = inside && pass % 3 != 2 ? secant : middle;
        side at;
        if (!(closure > low.closure && closure < high.closure))
            break;
        tl_status status = evaluate(s, closure, &at);
        if (status != TL_OK || fabs(at.excess) <= s->enough)
            return status;
        last = at.excess;
        if (last < 0)
            low = at;
        else
            high = at;
    }
    /* no number is left between the sides: good enough where the law is merely stiff, not where it jumps */
    double slope = (high.excess - low.excess) / (high.closure - low.closure);
    side at;
    tl_status status = evaluate(s, -low.excess < high.excess ? low.closure : high.closure, &at);
    if (status != TL_OK)
        return status;
    return slope <= 2 * (tl_law_stiffness(&s->b->law) + s->b->stiffness) ? TL_OK : not_held(s->b);
}

/* The step at the closure that has the wanted normal stress. */
static tl_status balance(const bench *b, const motion *by, sample *out)
{
    double kn = b->law.kn + b->stiffness;
    const closure_search s = {b, by, STRESS_ERROR * fabs(b->stress) + CLOSURE_ERROR * kn, out};
    side from, to;
    tl_status status = evaluate(&s, b->now.c[TL_AT_CLOSURE][0], &from);
    if (status != TL_OK || fabs(from.excess) <= s.enough)
        return status;
    /* the stiffness is the law's largest, so this goes no farther than the closure that is sought */
    double step = kn > 0 ? -from.excess / kn : 0;
    for (int k = 0; k < MOST_DOUBLINGS && step != 0 && isfinite(from.closure + step); k++) {
        status = evaluate(&s, from.closure + step, &to);
        if (status != TL_OK || fabs(to.excess) <= s.enough)
            return status;
        if ((to.excess < 0) != (from.excess < 0))
            return from.excess < 0 ? close_in(&s, from, to) : close_in(&s, to, from);
        from = to;
        step *= 2;
    }
    return not_held(b);
}

/* ---------------------------------------------------------------- path ------------------- */

static bool by_stress(const tl_law_test *test)
{
    return !isnan(test->normal_stress);
}

static int64_t steps_of(const tl_law_test *test, const tl_law_leg *leg)
{
    return leg->steps > 0 ? leg->steps : test->steps;
}

tl_status tl_law_test_points(const tl_law_test *test, size_t *points, tl_error *error)
{
    double steps = 0;
    *points = 1;
    if (!by_stress(test) && test->stiffness > 0)
        return tl_fail(error, TL_E_ARGUMENT, "law_test: stiffness needs normal_stress, the stress at the start");
    if (test->count == 0)
        return tl_fail(error, TL_E_ARGUMENT,
                       "law_test: path has no legs: give shear displacements, as in path = {0.01, 0}");
    for (size_t k = 0; k < test->count; k++) {
        const tl_law_leg *leg = &test->path[k];
        bool ramp = !isnan(leg->normal_stress);
        bool timed = !isnan(leg->time), still = isnan(leg->shear) && isnan(leg->closure) && !ramp;
        const char *why = NULL;
        if (!isnan(leg->closure) && by_stress(test))
            why = "closure is given in a test by normal_stress; leave one of them out";
        else if (ramp && (!by_stress(test) || test->stiffness > 0))
            why = "normal_stress can change only in a test with normal_stress and without stiffness";
        else if (still && !timed)
            why = "nothing is to happen: give shear, closure, normal_stress or a time";
        else if (timed && !isnan(leg->speed))
            why = "time and speed both say how long it takes; leave one of them out";
        if (why)
            return tl_fail(error, TL_E_ARGUMENT, "law_test, path[%zu]: %s", k + 1, why);
        steps += (double)steps_of(test, leg);
        if (steps > TL_LAW_TEST_STEPS)
            return tl_fail(error, TL_E_ARGUMENT, "law_test, path[%zu]: the test has more than %d steps: give fewer",
                           k + 1, TL_LAW_TEST_STEPS);
        *points += (size_t)((steps_of(test, leg) + test->every - 1) / test->every);
    }
    return TL_OK;
}

static void note(const bench *b, tl_law_point *out)
{
    const sample *now = &b->now;
    *out = (tl_law_point){.time = b->time,
                          .shear = b->shear,
                          .shear_stress = 0 - now->c[TL_AT_F_S][0], /* and not -0 */
                          .normal_stress = now->c[TL_AT_F_N][0],
                          .closure = now->c[TL_AT_CLOSURE][0],
                          .work = b->work,
                          .stored = now->c[TL_AT_STORED][0],
                          .heat = b->heat,
                          .flags = now->flags[0]};
    for (uint32_t k = 0; k < b->law.columns; k++)
        out->state[k] = now->c[TL_AT_STATE + k][0];
}

/* A step to a closure, or to that of the wanted stress. */
static tl_status make_step(bench *b, const motion *by, double closure)
{
    sample next;
    const sample *now = &b->now;
    tl_status status = by_stress(b->test) ? balance(b, by, &next) : try_closure(b, by, closure, &next);
    if (status != TL_OK)
        return status;
    b->work +=
        0.5 * (now->c[TL_AT_F_N][0] + next.c[TL_AT_F_N][0]) * (next.c[TL_AT_CLOSURE][0] - now->c[TL_AT_CLOSURE][0]);
    b->work -= 0.5 * (now->c[TL_AT_F_S][0] + next.c[TL_AT_F_S][0]) * by->du;
    b->heat += next.c[TL_AT_DISSIPATED][0];
    b->time += by->dt;
    b->now = next;
    return TL_OK;
}

/* The whole path of a value over a leg of `steps`, after k of them. */
static double part(double from, double to, int64_t k, int64_t steps)
{
    return k == steps ? to : from + (to - from) * ((double)k / (double)steps);
}

/* Seconds a leg takes. */
static double time_of(const tl_law_test *test, const tl_law_leg *leg, double slid, double closed)
{
    double length = sqrt(slid * slid + closed * closed);
    double speed = isnan(leg->speed) ? test->speed : leg->speed;
    if (!isnan(leg->time))
        return leg->time;
    return length > 0 ? length / speed : 1;
}

/* Walks a leg; the points go from `*points` on. */
static tl_status walk(bench *b, const tl_law_leg *leg, tl_law_point **points)
{
    int64_t steps = steps_of(b->test, leg);
    double slide = b->shear, close = b->now.c[TL_AT_CLOSURE][0], press = b->stress;
    double slid = isnan(leg->shear) ? slide : leg->shear;
    double closed = isnan(leg->closure) ? close : leg->closure;
    double pressed = isnan(leg->normal_stress) ? press : leg->normal_stress;
    double time = time_of(b->test, leg, slid - slide, closed - close);
    motion by = {.dt = time / (double)steps};
    if (!isfinite(b->time + time))
        return tl_fail(b->error, TL_E_ARGUMENT,
                       "law_test: a leg takes %g s, too long to be told: give a higher speed or a shorter time", time);
    for (int64_t k = 1; k <= steps; k++) {
        double shear = part(slide, slid, k, steps);
        by.du = shear - b->shear;
        b->shear = shear;
        b->stress = part(press, pressed, k, steps);
        tl_status status = make_step(b, &by, part(close, closed, k, steps));
        if (status != TL_OK)
            return status;
        if (k % b->test->every == 0 || k == steps)
            note(b, (*points)++);
    }
    return TL_OK;
}

/* The point as a contact is born, and then under the normal stress; heat and work count from there. */
static tl_status begin(bench *b)
{
    sample *now = &b->now;
    now->c[TL_AT_AREA][0] = 1;
    for (size_t l = 0; l < TL_LANES; l++)
        now->c[TL_AT_NORMAL + 2][l] = 1;
    uint32_t column = 0;
    for (uint32_t k = 0; k < b->law.kind->state_count && b->law.columns > 0; k++) {
        const tl_state *state = tl_kind_state(b->law.kind, k);
        for (uint32_t c = tl_state_width(state->kind); c > 0; c--)
            now->c[TL_AT_STATE + column++][0] = state->initial;
    }
    b->stress = by_stress(b->test) ? b->test->normal_stress : 0;
    tl_status status = make_step(b, &(motion){0, 0}, 0);
    b->start = now->c[TL_AT_CLOSURE][0];
    b->stiffness = b->test->stiffness > 0 ? b->test->stiffness : 0;
    b->work = now->c[TL_AT_STORED][0];
    b->heat = 0;
    return status;
}

tl_status tl_law_test_run(const tl_law_test *test, tl_law_point *points, size_t *ends, const tl_kind **law,
                          tl_error *error)
{
    size_t count;
    char context[TL_ERROR_TEXT / 2];
    bench b = {.test = test, .error = error};
    tl_status status = tl_law_test_points(test, &count, error);
    if (status != TL_OK)
        return status;
    const tl_kind *kind = tl_plugin_find(TL_KIND_LAW, test->law);
    if (!kind)
        return tl_kind_unknown(error, TL_KIND_LAW, test->law);
    snprintf(context, sizeof context, "law_test, law '%.40s'", kind->name);
    status = tl_law_make(kind, test->params, context, error, &b.law);
    if (status != TL_OK)
        return status;
    tl_law_point *at = points;
    status = begin(&b);
    if (status == TL_OK)
        note(&b, at++);
    for (size_t k = 0; k < test->count && status == TL_OK; k++) {
        b.leg = k + 1;
        status = walk(&b, &test->path[k], &at);
        if (ends)
            ends[k] = (size_t)(at - points) - 1;
    }
    tl_law_clear(&b.law);
    if (law)
        *law = kind;
    return status;
}
