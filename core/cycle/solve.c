/* solve.c - many steps: until a limit is met, the user interrupts, or a callback says so. */
#include "cycle/cycle_data.h"

#include "model/options.h"

#include "base/clock.h"

static const char *const reason_names[] = {
    [TL_SOLVE_RATIO] = "ratio",         [TL_SOLVE_CYCLES] = "cycles",
    [TL_SOLVE_TIME] = "time",           [TL_SOLVE_STOP] = "stop",
    [TL_SOLVE_INTERRUPT] = "interrupt", [TL_SOLVE_VELOCITY] = "velocity",
    [TL_SOLVE_FAILURE] = "failure",     [TL_SOLVE_OVERLAP] = "overlap"};

const char *tl_solve_reason_name(tl_solve_reason reason)
{
    return reason_names[reason];
}

typedef struct progress {
    const tl_solve *solve;
    tl_solve_result *result;
    int64_t cycles_0;
    double time_0, wall_0;
} progress;

static void measure(const tl_model *m, const progress *p)
{
    tl_solve_result *r = p->result;
    r->ratio = tl_unbalanced_ratio(m, TL_RATIO_AVERAGE);
    r->ratio_maximum = tl_unbalanced_ratio(m, TL_RATIO_MAXIMUM);
    r->ratio_local = tl_unbalanced_ratio(m, TL_RATIO_LOCAL);
    r->worst = tl_worst_body(m);
    r->max_velocity = sqrt(m->cycle->sums.max_speed2);
    r->cycles = m->cycles - p->cycles_0;
    r->time = m->time;
    r->wall = tl_clock() - p->wall_0;
}

/* Calls the user's functions; true when one of them ends the run. */
static bool call_back(tl_model *m, const progress *p, tl_status *status)
{
    const tl_solve *s = p->solve;
    bool stop = false;
    m->running = true;
    if (s->progress)
        *status = s->progress(s->user, m);
    if (*status == TL_OK && s->stop)
        stop = s->stop(s->user, m);
    m->running = false;
    p->result->reason = TL_SOLVE_STOP;
    return stop || *status != TL_OK;
}

static bool at_rest(tl_model *m, const progress *p)
{
    bool rests = tl_at_rest(m, (tl_ratio_measure)p->solve->measure, p->solve->ratio);
    p->result->worst = tl_worst_body(m); /* where forces balance, one that still moves */
    return rests;
}

/* Calls the function of every step; false when it ends the run. */
static bool call_each(tl_model *m, const progress *p, tl_status *status)
{
    if (!p->solve->each)
        return true;
    m->running = true;
    *status = p->solve->each(p->solve->user, m);
    m->running = false;
    return *status == TL_OK;
}

/* True when the run is over; sets the reason. */
static bool ended(tl_model *m, const progress *p, tl_status *status)
{
    const tl_solve *s = p->solve;
    int64_t done = m->cycles - p->cycles_0;
    tl_solve_reason *reason = &p->result->reason;
    if (!call_each(m, p, status)) {
        *reason = TL_SOLVE_STOP;
        return true;
    }
    if ((s->progress || s->stop) && s->every > 0 && done % s->every == 0 && call_back(m, p, status))
        return true;
    if (tl_model_interrupted(m))
        *reason = TL_SOLVE_INTERRUPT;
    else if (s->ratio > 0 && at_rest(m, p))
        *reason = TL_SOLVE_RATIO;
    else if (done > 1 && p->result->max_velocity < s->velocity) /* from rest the first is zero */
        *reason = TL_SOLVE_VELOCITY;
    else if (s->stop_at_failure && p->result->failing)
        *reason = tl_energy_pushed(m, &(tl_overlap_push){0}) ? TL_SOLVE_OVERLAP : TL_SOLVE_FAILURE;
    else if (done >= s->max_cycles)
        *reason = TL_SOLVE_CYCLES;
    else if (m->time - p->time_0 >= s->max_time)
        *reason = TL_SOLVE_TIME;
    else
        return false;
    return true;
}

/* Calls the function before a step; false when the run is over. What it makes or takes away is watched anew. */
static bool call_between(tl_model *m, const progress *p, tl_watch **watch, tl_status *status)
{
    uint64_t structure = m->structure;
    *status = p->solve->between(p->solve->user, m);
    if (*status == TL_OK && *watch && m->structure != structure) {
        tl_watch_end(*watch);
        *watch = tl_watch_begin(m);
        *status = *watch ? TL_OK : tl_fail_memory(&m->error);
    }
    if (*status == TL_OK && !tl_model_interrupted(m))
        return true;
    p->result->reason = *status == TL_OK ? TL_SOLVE_INTERRUPT : TL_SOLVE_STOP;
    return false;
}

static void say_failure(tl_model *m, const tl_solve_result *r)
{
    uint32_t row = tl_block_row_quiet(m, r->failing);
    double speed = row == TL_NO_ROW ? 0 : tl_v3_norm(m->bodies.v[m->blocks.body[row]]);
    tl_overlap_push push;
    if (tl_energy_pushed(m, &push)) {
        tl_model_say(
            m,
            "solve: an overlap pushes the model apart: blocks that were made overlapping have "
            "given off %.3g J, "
            "most of it blocks %u and %u, and gravity and loads %.3g J; block %u moves on at %.3g "
            "m/s; "
            "that is no word on whether it stands: make them apart, or with smaller overlaps",
            push.gave, push.a, push.b, push.others, r->failing, speed);
        return;
    }
    tl_model_say(m,
                 "solve: the model fails: block %u moves on at %.3g m/s without slowing down "
                 "(unbalanced force ratio: local %.3g, average %.3g)",
                 r->failing, speed, r->ratio_local, r->ratio);
}

/* At rest, but not where the run began: what slid until it met something may be no equilibrium of what was asked for. */
static void say_gone(tl_model *m, const tl_watch *watch)
{
    double way = 0, size = 0;
    tl_id gone = tl_watch_gone(watch, m, &way, &size);
    if (gone != TL_NO_ID)
        tl_model_say(m,
                     "solve: at rest, but not where it began: block %u has moved by %.3g m in this "
                     "run, %.2g times its size",
                     gone, way, way / size);
}

/* Neither at rest nor failing: of a run that was to find out which. */
static void say_undecided(tl_model *m, const tl_solve *solve, const tl_solve_result *r)
{
    bool cycles = r->reason == TL_SOLVE_CYCLES;
    double ratio = tl_unbalanced_ratio(m, (tl_ratio_measure)solve->measure);
    if (tl_model_says(m, TL_REMARK_UNDECIDED))
        tl_model_say(m,
                     "solve: ended by %s = %.9g, neither at rest (ratio %.3g, asked for %.3g) nor "
                     "failing: that is no word on whether it stands",
                     cycles ? "max_cycles" : "max_time",
                     cycles ? (double)solve->max_cycles : solve->max_time, ratio, solve->ratio);
}

/* What the end of a run means for whether the model stands. A stop function has its own reason. */
static void say_end(tl_model *m, const tl_solve *solve, const tl_watch *watch,
                    const tl_solve_result *r)
{
    bool rests = r->reason == TL_SOLVE_RATIO || r->reason == TL_SOLVE_VELOCITY;
    bool limit = r->reason == TL_SOLVE_CYCLES || r->reason == TL_SOLVE_TIME;
    if (r->failing && r->reason != TL_SOLVE_STOP)
        say_failure(m, r);
    else if (rests && watch)
        say_gone(m, watch);
    else if (limit && solve->ratio > 0 && m->damping)
        say_undecided(m, solve, r);
}

/* For who asks how the model stands. */
static void note_run(tl_model *m, const tl_solve *solve, const tl_solve_result *r)
{
    m->cycle->failing = r->failing;
    if (solve->ratio > 0)
        m->cycle->rest_ratio = solve->ratio;
}

static tl_status run(tl_model *m, const tl_solve *solve, tl_solve_result *wanted)
{
    tl_solve_result unread, *const result = wanted ? wanted : &unread;
    tl_rows_tidy(m);
    *result =
        (tl_solve_result){.reason = TL_SOLVE_CYCLES, .time = m->time, .measure = solve->measure};
    if (m->running || m->reading)
        return tl_fail(&m->error, TL_E_STATE,
                       "cycle and solve cannot be called from a function that a run has called");
    progress p = {solve, result, m->cycles, m->time, tl_clock()};
    tl_watch *watch = NULL;
    if ((solve->ratio > 0 || solve->stop_at_failure) && !(watch = tl_watch_begin(m)))
        return tl_fail_memory(&m->error);
    atomic_store(&m->interrupted, false);
    tl_remark_units(m);
    tl_status status = TL_OK;
    while (result->cycles < solve->max_cycles) {
        if (solve->between && !call_between(m, &p, &watch, &status))
            break;
        status = tl_step(m);
        if (status != TL_OK)
            break;
        measure(m, &p);
        result->failing = watch ? tl_watch_step(watch, m) : TL_NO_ID;
        if (watch)
            note_run(m, solve, result);
        if (ended(m, &p, &status))
            break;
    }
    if (status == TL_OK)
        say_end(m, solve, watch, result);
    tl_watch_end(watch);
    return status;
}

tl_status tl_model_solve(tl_model *m, const tl_solve *given, tl_solve_result *result)
{
    tl_solve solve;
    tl_status status = TL_OPTIONS_READ(tl_solve, given, &solve, &m->error);
    if (status != TL_OK)
        return status;
    if (!m->damping && tl_model_says(m, TL_REMARK_UNDAMPED))
        tl_model_say(m,
                     "solve: the model has no damping and may never come to rest; %s or another "
                     "one helps",
                     tl_words(m, "model:damping(\"local\")", "tl_model_damping() with \"local\""));
    return run(m, &solve, result);
}

tl_status tl_model_cycle_calling(tl_model *m, int64_t cycles, const tl_solve *calls,
                                 tl_solve_result *result)
{
    if (cycles < 0)
        return tl_fail(&m->error, TL_E_ARGUMENT, "cycle: %lld must be >= 0", (long long)cycles);
    const tl_solve silent = tl_solve_default();
    calls = calls ? calls : &silent;
    const tl_solve plain = {.max_cycles = cycles,
                            .max_time = NAN,
                            .velocity = NAN,
                            .measure = TL_RATIO_LOCAL,
                            .every = calls->every,
                            .each = calls->each,
                            .progress = calls->progress,
                            .stop = calls->stop,
                            .user = calls->user,
                            .between = calls->between};
    return run(m, &plain, result);
}

tl_status tl_model_cycle(tl_model *m, int64_t cycles, tl_solve_result *result)
{
    return tl_model_cycle_calling(m, cycles, &(const tl_solve){0}, result);
}

tl_balance tl_model_balance(const tl_model *m)
{
    if (!m->cycle || m->cycles == 0)
        return (tl_balance){NAN, NAN, NAN, NAN};
    return (tl_balance){.ratio = tl_unbalanced_ratio(m, TL_RATIO_AVERAGE),
                        .ratio_maximum = tl_unbalanced_ratio(m, TL_RATIO_MAXIMUM),
                        .ratio_local = tl_unbalanced_ratio(m, TL_RATIO_LOCAL),
                        .max_velocity = sqrt(m->cycle->sums.max_speed2)};
}
