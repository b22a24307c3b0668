/* solve.c - many steps: until a limit is met, the user interrupts, or a callback says so. */
#include "cycle/solve.h"

#include "base/clock.h"
#include "contact/detection.h"
#include "cycle/cycle.h"
#include "cycle/cycle_data.h"
#include "cycle/failing.h"
#include "cycle/meshes.h"
#include "cycle/records.h"
#include "cycle/remarks.h"
#include "cycle/rest.h"
#include "cycle/settle.h"
#include "element/steady.h"
#include "model/options.h"
#include "model/rows.h"

#include <stdatomic.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- runs -------------------- */

static const char *const reason_names[] = {
    [TL_SOLVE_RATIO] = "ratio",     [TL_SOLVE_CYCLES] = "cycles",       [TL_SOLVE_TIME] = "time",
    [TL_SOLVE_STOP] = "stop",       [TL_SOLVE_INTERRUPT] = "interrupt", [TL_SOLVE_VELOCITY] = "velocity",
    [TL_SOLVE_FAILURE] = "failure", [TL_SOLVE_OVERLAP] = "overlap",     [TL_SOLVE_REST] = "rest"};

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

/* Id of the body that is farthest from equilibrium by the local measure, or TL_NO_ID. */
static tl_id worst_body(const tl_model *m)
{
    uint32_t worst = m->cycle->sums.worst;
    return worst == TL_NO_ROW ? TL_NO_ID : m->bodies.id[worst];
}

static void measure(const tl_model *m, const progress *p)
{
    tl_solve_result *r = p->result;
    const tl_balance now = tl_model_balance(m);
    r->ratio = now.ratio;
    r->ratio_maximum = now.ratio_maximum;
    r->ratio_local = now.ratio_local;
    r->worst = worst_body(m);
    r->max_velocity = now.max_velocity;
    r->cycles = m->cycles - p->cycles_0;
    r->time = m->time;
    r->wall = tl_clock() - p->wall_0;
}

/* Calls the user's functions after a step; true when one of them ends the run. */
static bool call_back(tl_model *m, const tl_solve *s, int64_t done, tl_status *status)
{
    const bool due = s->every > 0 && done % s->every == 0;
    bool stop = false;
    m->running = true;
    if (s->each)
        *status = s->each(s->user, m);
    if (*status == TL_OK && due && s->progress)
        *status = s->progress(s->user, m);
    if (*status == TL_OK && due && s->stop)
        stop = s->stop(s->user, m);
    m->running = false;
    return stop || *status != TL_OK;
}

static bool at_rest(tl_model *m, const progress *p)
{
    const bool rests = (!m->relaxing || tl_settle_bears_all(m)) &&
                       tl_at_rest(m, (tl_ratio_measure)p->solve->measure, p->solve->ratio) && tl_steady_is_exact(m);
    p->result->worst = worst_body(m); /* where forces balance, one that still moves */
    return rests;
}

/* What blocks that were made overlapping have pushed with: those that did the most, the energy that is no longer
 * stored, and what gravity and all else have done, J. */
typedef struct overlap_push {
    tl_id a, b;
    double gave, others;
} overlap_push;

/* Whether they have given off more than all else has. */
static bool overlaps_push(const tl_model *m, overlap_push *by)
{
    const tl_ledger *l = &m->cycle->ledger;
    const tl_energy *e = &l->energy;
    *by = (overlap_push){l->overlap_a, l->overlap_b, l->overlaps - e->stored, fmax(0, e->external - e->potential)};
    return by->gave > by->others;
}

/* True when the run is over; sets the reason. */
static bool ended(tl_model *m, const progress *p, tl_status *status)
{
    const tl_solve *s = p->solve;
    int64_t done = m->cycles - p->cycles_0;
    tl_solve_reason *reason = &p->result->reason;
    if (call_back(m, s, done, status))
        *reason = TL_SOLVE_STOP;
    else if (tl_model_interrupted(m))
        *reason = TL_SOLVE_INTERRUPT;
    else if (s->ratio > 0 && at_rest(m, p))
        *reason = TL_SOLVE_RATIO;
    else if (done > 1 && p->result->max_velocity < s->velocity) /* from rest the first is zero */
        *reason = TL_SOLVE_VELOCITY;
    else if (s->stop_at_failure && p->result->failing)
        *reason = overlaps_push(m, &(overlap_push){0}) ? TL_SOLVE_OVERLAP : TL_SOLVE_FAILURE;
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

/* The call that a remark is of. */
static const char *run_name(const tl_model *m)
{
    return m->relaxing ? "relax" : "solve";
}

static void say_failure(tl_model *m, const tl_solve_result *r)
{
    uint32_t row = tl_block_row_quiet(m, r->failing);
    double speed = row == TL_NO_ROW ? 0 : tl_body_speed(m, m->blocks.body[row]);
    overlap_push push;
    if (overlaps_push(m, &push)) {
        tl_model_say(m,
                     "%s: an overlap pushes the model apart: blocks that were made overlapping have given off %.3g "
                     "J, most of it blocks %u and %u, and gravity and loads %.3g J; block %u moves on at %.3g m/s; "
                     "that is no word on whether it stands: make them apart, or let %s take them as fitting before the "
                     "first step",
                     run_name(m), push.gave, push.a, push.b, push.others, r->failing, speed,
                     tl_words(m, "model:seat{}", "tl_model_seat()"));
        return;
    }
    char at[40] = ""; /* by the masses of a relaxation a speed means nothing */
    if (!m->relaxing)
        tl_text_print(at, sizeof at, " at %.3g m/s", speed);
    tl_model_say(m,
                 "%s: the model fails: block %u moves on%s without slowing down (unbalanced force ratio: local %.3g, "
                 "average %.3g)",
                 run_name(m), r->failing, at, r->ratio_local, r->ratio);
}

/* At rest, but not where the run began: what slid until it met something may be no equilibrium of what was asked for.
 * What moved by a hundredth of its size may rest only because its joints are that soft, or that stiff. Names the body
 * that has gone the farthest over its size, of those that touched something then. */
static void say_gone(tl_model *m, const tl_watch *w)
{
    const tl_gone gone = tl_watch_gone(w, m), moved = tl_watch_moved(w, m);
    if (gone.body != TL_NO_ROW)
        tl_model_say(
            m, "%s: at rest, but not where it began: block %u has moved by %.3g m in this run, %.2g times its size",
            run_name(m), m->bodies.id[gone.body], gone.way, gone.share);
    else if (moved.body != TL_NO_ROW && tl_model_says(m, TL_REMARK_MOVED))
        tl_model_say(
            m,
            "%s: at rest, but that may hang on how stiff the joints are: block %u has moved by %.3g m, %.2g %% "
            "of its size of %.3g m; see whether it rests with ten times the stiffness, too: %s",
            run_name(m), m->bodies.id[moved.body], moved.way, 100 * moved.share, moved.way / moved.share,
            tl_words(m, "try_stiffer = true", "tl_joints_stiffen() of a copy"));
}

/* Neither at rest nor failing: of a run that was to find out which. */
static void say_undecided(tl_model *m, const tl_solve *solve, const tl_solve_result *r)
{
    bool cycles = r->reason == TL_SOLVE_CYCLES;
    const tl_balance now = tl_model_balance(m);
    const double of[] = {now.ratio, now.ratio_maximum, now.ratio_local}; /* by tl_ratio_measure */
    if (tl_model_says(m, TL_REMARK_UNDECIDED))
        tl_model_say(m,
                     "%s: ended by %s = %.9g, neither at rest (ratio %.3g, asked for %.3g) nor failing: that is no "
                     "word on whether it stands",
                     run_name(m), cycles ? "max_cycles" : "max_time",
                     cycles ? (double)solve->max_cycles : solve->max_time, of[solve->measure], solve->ratio);
}

/* What the end of a run means for whether the model stands. A stop function has its own reason. */
static void say_end(tl_model *m, const tl_solve *solve, const tl_watch *watch, const tl_solve_result *r)
{
    bool rests = r->reason == TL_SOLVE_RATIO || r->reason == TL_SOLVE_VELOCITY;
    bool limit = r->reason == TL_SOLVE_CYCLES || r->reason == TL_SOLVE_TIME;
    if (r->failing && r->reason != TL_SOLVE_STOP)
        say_failure(m, r);
    else if (rests && watch)
        say_gone(m, watch);
    else if (limit && solve->ratio > 0 && tl_is_damped(m))
        say_undecided(m, solve, r);
}

tl_status tl_solve_run(tl_model *m, const tl_solve *solve, tl_solve_result *wanted)
{
    tl_solve_result unread, *const result = wanted ? wanted : &unread;
    tl_rows_tidy(m);
    *result = (tl_solve_result){.reason = TL_SOLVE_CYCLES, .time = m->time, .measure = solve->measure};
    if (m->running || m->reading)
        return tl_fail(&m->error, TL_E_STATE, "cycle and solve cannot be called from a function that a run has called");
    const tl_status records = tl_records_check(m);
    if (records != TL_OK)
        return records;
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
        if (result->cycles == 0)
            tl_records_remark(m);
        measure(m, &p);
        if (watch)
            m->cycle->failing = result->failing = tl_watch_step(watch, m);
        if (solve->ratio > 0)
            m->cycle->rest_ratio = solve->ratio;
        if (ended(m, &p, &status))
            break;
    }
    if (status == TL_OK && result->failing && watch)
        status = tl_watch_list(watch, m);
    if (status == TL_OK)
        say_end(m, solve, watch, result);
    tl_watch_end(watch);
    return status;
}

/* Other steps than those of a relaxation that a save was made in. */
static void end_relaxation(tl_model *m)
{
    if (m->relaxing && !m->running && !m->reading)
        tl_settle_end(m);
}

tl_status tl_model_solve(tl_model *m, const tl_solve *given, tl_solve_result *result)
{
    tl_solve solve;
    tl_status status = TL_OPTIONS_READ(tl_solve, given, &solve, &m->error);
    if (status != TL_OK)
        return status;
    const bool waits_for_rest = solve.ratio > 0 || solve.velocity > 0;
    if (!m->damping && waits_for_rest && tl_model_says(m, TL_REMARK_UNDAMPED))
        tl_model_say(
            m,
            "solve: the model has no damping and may never come to rest; %s finds where it rests, %s damps its motion",
            tl_words(m, "model:relax{}", "tl_model_relax()"),
            tl_words(m, "model:damping(\"local\")", "tl_model_damping() with \"local\""));
    end_relaxation(m);
    return tl_solve_run(m, &solve, result);
}

tl_status tl_model_cycle_calling(tl_model *m, int64_t cycles, const tl_solve *calls, tl_solve_result *result)
{
    if (cycles < 0)
        return tl_fail(&m->error, TL_E_ARGUMENT, "cycle: %lld must be >= 0", (long long)cycles);
    tl_solve plain = calls ? *calls : tl_solve_default();
    plain.max_cycles = cycles;
    plain.max_time = plain.velocity = NAN;
    plain.measure = TL_RATIO_LOCAL;
    plain.ratio = plain.stop_at_failure = 0;
    end_relaxation(m);
    return tl_solve_run(m, &plain, result);
}

tl_status tl_model_cycle(tl_model *m, int64_t cycles, tl_solve_result *result)
{
    return tl_model_cycle_calling(m, cycles, NULL, result);
}
