/* run.c - cycle, solve and generate: callbacks into Lua, and the line that tells how it goes.
 *
 * No Lua error may jump over the kernel's frames. Callbacks run in protected calls, and an error is kept
 * on the stack. The run ends after the step, and only then is the error raised again, as it was. */
#include "lua/run.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/history.h"
#include "lua/interrupt.h"
#include "lua/item.h"
#include "lua/living.h"
#include "lua/try_stiffer.h"
#include "lua/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <talus/elementary.h>
#include <talus/number.h>
#include <time.h>
#include <unistd.h>

/* Constant: s. */
#define NANOSECOND 1e-9

/* Seconds of a clock that never goes back, from a start of its own: only differences mean something. */
static double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + NANOSECOND * (double)t.tv_nsec;
}

/* ---------------------------------------------------------------- the progress line -------
 *
 * How a run or a generator goes: one line on a terminal that is written anew, in a log a line now and then.
 *
 * It goes to standard error, and asks nothing that could make the kernel compute: a run gives the same bits with it
 * and without. So dt is the mean step since the last line. Limit: the time left is guessed from the trend so far. */

/* Constant: seconds between two lines on a terminal and in a log, unless TALUS_PROGRESS says. */
#define TERMINAL_PERIOD 0.1
#define LOG_PERIOD 5.0
/* Constant: counting contacts takes at most this share of the time. */
#define COUNTING 0.02
/* Widest line of a log. */
#define LOG_COLUMNS 160
/* Tolerance: a trend of the logarithm of the ratio that is less than this in the time looked at is none. */
#define TREND 0.1

/* Ratios kept for their trend. */
#define KEPT 64

typedef struct progress {
    bool on, terminal;
    bool drawn;                              /* a line stands on the terminal */
    double period, began, shown, next_count; /* s, of the clock */
    int64_t shown_cycle;                     /* when the line was last written */
    double first_time, shown_time;           /* s, of the model */
    tl_contact_counts counts;
    double at[KEPT], log_ratio[KEPT];
    int kept;
} progress;

/* The period that the environment asks for, s, or NaN. */
static double read_period(lua_State *L)
{
    const char *text = getenv("TALUS_PROGRESS");
    if (!text || !text[0])
        return NAN;
    const char *end;
    double period = tl_number_read(text, &end);
    if (end == text || *end || !(period >= 0) || !isfinite(period))
        tl_lua_fail(L, "the environment's TALUS_PROGRESS = '%s' is not a number of seconds >= 0", text);
    return period;
}

static void progress_begin(lua_State *L, progress *p, const tl_model *model)
{
    *p = (progress){.on = !tl_lua_options_of(L)->quiet};
    if (!p->on)
        return;
    p->terminal = isatty(STDERR_FILENO) == 1;
    double period = read_period(L);
    p->period = !isnan(period) ? period : p->terminal ? TERMINAL_PERIOD : LOG_PERIOD;
    p->began = p->shown = clock_seconds();
    p->shown_cycle = tl_model_cycles(model);
    p->first_time = p->shown_time = tl_model_time(model);
}

static void progress_clear(progress *p)
{
    if (p->drawn)
        fputs("\r\033[K", stderr);
    p->drawn = false;
}

/* ---------------------------------------------------------------- runs that are saved as they go ---
 *
 * `talus run --autosave MINUTES SCRIPT` saves the model that runs, from time to time, in a file beside the script.
 * After `talus run --resume SCRIPT` talus.resumed() gives it back. When a save happens goes by the clock. That is no
 * harm: saving does not change a run. */

static void autosave(tl_lua_options *options, tl_model *model)
{
    if (!(options->autosave > 0) || !options->save_path)
        return;
    double now = clock_seconds();
    if (options->save_due == 0) /* the first step of all */
        options->save_due = now + options->autosave;
    if (now < options->save_due)
        return;
    options->save_due = now + options->autosave;
    /* The run is worth more than its save: a failure is told only. */
    if (tl_model_save(model, options->save_path) != TL_OK) {
        char text[TL_ERROR_TEXT + 32];
        snprintf(text, sizeof text, "autosave: %s", tl_model_error(model)->text);
        tl_lua_log(options, text);
    }
}

/* ---------------------------------------------------------------- a line ----------------- */

/* Parts of a line in their order; where there is no room for all, those of the lowest rank are left out. */
enum { PARTS = 12, PART_TEXT = 48 };

typedef struct line {
    char part[PARTS][PART_TEXT];
    int rank[PARTS]; /* 0: the most important */
    int count;
} line;

static void add(line *l, int rank, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(l->part[l->count], PART_TEXT, format, arguments);
    va_end(arguments);
    l->rank[l->count++] = rank;
}

static int columns(const progress *p)
{
    struct winsize size;
    if (!p->terminal)
        return LOG_COLUMNS;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2)
        return 79;
    return size.ws_col - 1 < LOG_COLUMNS ? size.ws_col - 1 : LOG_COLUMNS;
}

static size_t length_of(const line *l, int least)
{
    size_t length = 0;
    for (int i = 0; i < l->count; i++)
        if (l->rank[i] <= least)
            length += (length ? 2 : 0) + strlen(l->part[i]);
    return length;
}

static void write_line(progress *p, const line *l)
{
    char text[PARTS * (PART_TEXT + 2)] = "";
    int width = columns(p), least = PARTS;
    while (least > 0 && length_of(l, least) > (size_t)width)
        least--;
    for (int i = 0; i < l->count; i++)
        if (l->rank[i] <= least) {
            strcat(text, text[0] ? "  " : "");
            strcat(text, l->part[i]);
        }
    fprintf(stderr, p->terminal ? "\r\033[K%.*s" : "talus: %.*s\n", width, text);
    fflush(stderr);
    p->drawn = p->terminal;
    p->shown = clock_seconds();
}

static void add_time_left(line *l, double seconds)
{
    static const struct {
        double below, unit;
        const char *format;
    } units[] = {{100, 1, "%.0f s left"},
                 {6000, 60, "%.0f min left"},
                 {172800, 3600, "%.1f h left"},
                 {1e9, 86400, "%.1f days left"}};
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (seconds < units[i].below) {
            add(l, 1, units[i].format, seconds / units[i].unit);
            return;
        }
}

/* ---------------------------------------------------------------- runs -------------------- */

/* Places on the Lua stack during a run. */
enum {
    AT_MODEL = TL_LUA_AT_MODEL,
    AT_ARGS,
    AT_ANCHOR,
    AT_STOP,
    AT_PROGRESS,
    AT_ERROR = TL_LUA_AT_ERROR,
    AT_REASONS,
    AT_RESULT,
    AT_FAILING, /* of a relaxation */
    AT_DIRECTION
};

typedef struct run {
    tl_lua_running running;
    tl_lua_model *owner;
    tl_lua_options *options;
    tl_solve limits; /* what ends it */
    progress line;
    tl_relax_result result; /* of other runs only the first part */
} run;

/* ---------------------------------------------------------------- results ---------------- */

/* Writes numbers into the table at the top of the stack. */
static void set_numbers(lua_State *L, const tl_solve_result *result)
{
    tl_lua_set_count(L, "cycles", (size_t)result->cycles);
    TL_LUA_SET_NUMBERS(L, {"ratio", result->ratio}, {"ratio_maximum", result->ratio_maximum},
                       {"ratio_local", result->ratio_local}, {"time", result->time}, {"wall", result->wall},
                       {"max_velocity", result->max_velocity});
}

/* Fields of a result that are blocks. */
static const char *const result_blocks[] = {"failing", "worst"};

/* Pushes a table for a result, with a place for each field. The model's userdata is at `model_index`. */
static void push_empty_result(lua_State *L, int model_index, int32_t measure)
{
    const tl_solve_result none = {0};
    model_index = lua_absindex(L, model_index);
    lua_newtable(L);
    set_numbers(L, &none);
    tl_lua_set_text(L, "measure", tl_ratio_measure_name((tl_ratio_measure)measure));
    for (size_t i = 0; i < sizeof result_blocks / sizeof result_blocks[0]; i++) {
        tl_lua_item_push_name(L, &tl_lua_block_kind, model_index, &(tl_id){TL_NO_ID});
        lua_setfield(L, -2, result_blocks[i]);
    }
}

/* Fills the table at the top of the stack, made for it, without needing memory. */
static void set_result(lua_State *L, const tl_solve_result *result)
{
    set_numbers(L, result);
    tl_lua_item_rename(L, result_blocks[0], result->failing);
    tl_lua_item_rename(L, result_blocks[1], result->worst);
}

/* All memory for what a run will answer is had before the first step: a call that fails for want of it makes none. */
static void push_empty_answer(lua_State *L, int32_t measure)
{
    lua_settop(L, AT_ERROR);
    lua_newtable(L);
    for (int reason = 0; reason <= TL_SOLVE_REST; reason++) {
        lua_pushstring(L, tl_solve_reason_name((tl_solve_reason)reason));
        lua_rawseti(L, AT_REASONS, reason + 1);
    }
    push_empty_result(L, AT_MODEL, measure);
    lua_pushboolean(L, false);
    lua_setfield(L, AT_RESULT, "reason");
}

/* ---------------------------------------------------------------- the trend -------------- */

static double logarithm(double x)
{
    const double ln_2 = 0.6931471805599453;
    int exponent;
    double mantissa = frexp(x, &exponent);
    return exponent * ln_2 + tl_log1p(mantissa - 1);
}

/* Keeps the ratio; of many, fewer and fewer. */
static void keep_ratio(progress *p, double at, double ratio)
{
    if (!(ratio > 0) || !isfinite(ratio))
        return;
    if (p->kept == KEPT) {
        p->kept /= 2;
        for (int i = 0; i < p->kept; i++) {
            p->at[i] = p->at[2 * i + 1];
            p->log_ratio[i] = p->log_ratio[2 * i + 1];
        }
    }
    p->at[p->kept] = at;
    p->log_ratio[p->kept++] = logarithm(ratio);
}

typedef struct trend {
    double slope;  /* of the logarithm of the ratio, 1/s */
    double value;  /* that the line through them has now */
    double change; /* in the time looked at */
} trend;

/* The line through the later half of the ratios. */
static trend trend_of(const progress *p)
{
    int first = p->kept / 2, n = p->kept - first;
    double x = 0, y = 0, xx = 0, xy = 0;
    for (int i = first; i < p->kept; i++) {
        x += p->at[i] / n;
        y += p->log_ratio[i] / n;
    }
    for (int i = first; i < p->kept; i++) {
        xx += (p->at[i] - x) * (p->at[i] - x);
        xy += (p->at[i] - x) * (p->log_ratio[i] - y);
    }
    if (n < 4 || !(xx > 0))
        return (trend){NAN, NAN, NAN};
    double slope = xy / xx, last = p->at[p->kept - 1];
    return (trend){slope, y + slope * (last - x), slope * (last - p->at[first])};
}

/* ---------------------------------------------------------------- a run ------------------ */

/* The ratio that may end the run. */
static double ratio_of(const tl_solve_result *r)
{
    switch (r->measure) {
    case TL_RATIO_AVERAGE: return r->ratio;
    case TL_RATIO_MAXIMUM: return r->ratio_maximum;
    default: return r->ratio_local;
    }
}

/* The share of the run that is done by its limits of steps and of time. */
static double share_done(const progress *p, const tl_solve *limits, const tl_solve_result *result)
{
    double share = limits->max_cycles > 0 ? (double)result->cycles / (double)limits->max_cycles : 1;
    if (limits->max_time > 0)
        share = fmax(share, (result->time - p->first_time) / limits->max_time);
    return fmin(share, 1);
}

static void add_goal(line *l, progress *p, const tl_solve *limits, const tl_solve_result *result, double t)
{
    double ratio = ratio_of(result), share = share_done(p, limits, result);
    double left = share > 0 ? (t - p->began) * (1 - share) / share : INFINITY;
    keep_ratio(p, t - p->began, ratio);
    if (!(limits->ratio > 0)) {
        add(l, 0, "%.0f %%", floor(100 * share));
        add_time_left(l, left);
        return;
    }
    trend now_is = trend_of(p);
    const char *word = isnan(now_is.change)     ? ""
                       : now_is.change < -TREND ? " falling"
                       : now_is.change > TREND  ? " rising"
                                                : " steady";
    add(l, 0, "ratio %.1e%s (to %.0e)", ratio, word, limits->ratio);
    if (limits->max_time > 0)
        add(l, 2, "%.0f %% of the time", floor(100 * share));
    if (now_is.change < -TREND)
        add_time_left(l, fmin(left, fmax(0, (logarithm(limits->ratio) - now_is.value) / now_is.slope)));
}

static void count_contacts(progress *p, const tl_model *model, double t)
{
    if (p->period > 0 && t < p->next_count)
        return;
    p->counts = tl_model_contact_counts(model);
    double after = clock_seconds();
    p->next_count = after + (after - t) / COUNTING;
}

/* After a step: writes the line when it is time to. `limits`: what ends the run. */
static void progress_run(progress *p, const tl_model *model, const tl_solve *limits, const tl_solve_result *result)
{
    if (!p->on)
        return;
    double t = clock_seconds(), time = tl_model_time(model);
    int64_t cycle = tl_model_cycles(model), steps = cycle - p->shown_cycle;
    if (t - p->shown < p->period || steps == 0)
        return;
    count_contacts(p, model, t);
    line l = {.count = 0};
    add_goal(&l, p, limits, result, t);
    add(&l, 8, "cycle %lld", (long long)cycle);
    add(&l, 3, "t %.4g s", time);
    add(&l, 9, "dt %.2g s", (time - p->shown_time) / (double)steps);
    add(&l, 4, "v %.1e m/s", result->max_velocity);
    add(&l, 5, "%zu sliding", p->counts.slipping);
    add(&l, 6, "%zu open", p->counts.open);
    if (t > p->began)
        add(&l, 7, "%.*f/s", (double)result->cycles < 10 * (t - p->began) ? 1 : 0,
            (double)result->cycles / (t - p->began));
    write_line(p, &l);
    p->shown_cycle = cycle;
    p->shown_time = time;
}

/* ---------------------------------------------------------------- callbacks -------------- */

/* Runs protected: on_progress(model, result). Arguments: function, model, run. */
static int call_progress(lua_State *L)
{
    const run *r = lua_touserdata(L, 3);
    lua_settop(L, 2);
    push_empty_result(L, 2, r->result.run.measure);
    set_result(L, &r->result.run);
    lua_call(L, 2, 0);
    return 0;
}

/* Ends the run: with the error on the top of the stack, when it has failed. */
static tl_status status_of(bool good)
{
    if (!good)
        tl_lua_run_keep_error();
    return good ? TL_OK : TL_E_CANCELLED;
}

/* After every step: the line, the samples that are due, and then a save, which has them. */
static tl_status on_each(void *user, tl_model *model)
{
    run *r = user;
    if (r->running.failed) /* a drive's function */
        return TL_E_CANCELLED;
    progress_run(&r->line, model, &r->limits, &r->result.run);
    if (tl_model_cycles(model) >= r->owner->next_sample && !tl_lua_histories_sample(r->running.L, AT_MODEL))
        return status_of(false);
    if (!r->owner->probe)
        autosave(r->options, model);
    return status_of(!r->owner->view || tl_lua_view_step(r->running.L, 0));
}

/* Before every step: those who look at the model, if it is seen, may want something. */
static tl_status on_between(void *user, tl_model *model)
{
    (void)model;
    run *r = user;
    if (r->running.failed)
        return TL_E_CANCELLED;
    return status_of(tl_lua_view_between(r->running.L));
}

static tl_status on_progress(void *user, tl_model *model)
{
    (void)model;
    run *r = user;
    lua_State *L = r->running.L;
    if (r->running.failed)
        return TL_E_CANCELLED;
    progress_clear(&r->line); /* the function may print */
    lua_pushcfunction(L, call_progress);
    lua_pushvalue(L, AT_PROGRESS);
    lua_pushvalue(L, AT_MODEL);
    lua_pushlightuserdata(L, r);
    return status_of(lua_pcall(L, 3, 0, 0) == LUA_OK);
}

static bool on_stop(void *user, tl_model *model)
{
    (void)model;
    run *r = user;
    lua_State *L = r->running.L;
    if (r->running.failed)
        return true;
    lua_pushvalue(L, AT_STOP);
    lua_pushvalue(L, AT_MODEL);
    if (lua_pcall(L, 1, 1, 0) != LUA_OK) {
        tl_lua_run_keep_error();
        return true;
    }
    bool stop = lua_toboolean(L, -1);
    lua_pop(L, 1);
    return stop;
}

/* ---------------------------------------------------------------- solve and cycle -------- */

/* Keys of solve_keys that cycle does not have. */
#define KEYS_BEFORE_CYCLE 2

/* Those of cycle are the same but for the first two. */
static const tl_lua_key solve_keys[] = {
    {"try_stiffer", "true or false",
     "whether the same is tried on a copy whose joints are ten times as stiff: the result's `stiffer`"},
    {"stop", "function(model)", "called every `every` steps; ends the run when it answers true"},
    {"on_progress", "function(model, result)", "called every `every` steps"},
    {NULL, NULL, NULL},
};

/* Pushes the function of that key, or nil; true when there is one. */
static bool push_callback(lua_State *L, const char *what, const char *key)
{
    int type = tl_lua_option(L, AT_ARGS, key);
    if (type != LUA_TNIL && type != LUA_TFUNCTION)
        tl_lua_fail(L, "%s: %s must be a function, not %s", what, key, tl_lua_describe(L, -1));
    return type == LUA_TFUNCTION;
}

/* What a run makes: a number of steps, steps until a limit is met, or a relaxation. */
typedef enum run_kind { RUN_STEPS, RUN_SOLVE, RUN_RELAX } run_kind;

/* The same callbacks. */
static void call_back_to(tl_relax *relax, const tl_solve *solve)
{
    relax->each = solve->each;
    relax->progress = solve->progress;
    relax->stop = solve->stop;
    relax->user = solve->user;
    relax->between = solve->between;
}

/* Room for what a relaxation answers besides: the selection of what fails, and where it goes. */
static tl_lua_selection *push_room(lua_State *L, const tl_model *model)
{
    const size_t room = tl_block_count(model);
    lua_pushnumber(L, 0);
    lua_setfield(L, AT_RESULT, "volume");
    lua_pushboolean(L, false);
    lua_setfield(L, AT_RESULT, "direction");
    tl_lua_selection *failing = tl_lua_selection_push(L, &tl_lua_block_kind, AT_MODEL);
    failing->names = malloc((room + 1) * sizeof(tl_id));
    if (!failing->names)
        tl_lua_fail(L, "relax: out of memory");
    failing->count = room;
    tl_lua_push_numbers(L, (const double[3]){0, 0, 0}, 3);
    return failing;
}

/* Puts it into the result. */
static void set_relaxed(lua_State *L, const tl_model *model, const tl_relax_result *result, tl_lua_selection *failing)
{
    const bool fails = result->failing > 0;
    const size_t room = failing->count, found = fails ? tl_model_failing(model, failing->names, room) : 0;
    failing->count = found < room ? found : room;
    for (int i = 0; i < 3; i++) {
        lua_pushnumber(L, result->direction[i]);
        lua_rawseti(L, AT_DIRECTION, i + 1);
    }
    if (!fails) {
        lua_pushnil(L);
        lua_replace(L, AT_FAILING);
        lua_pushnil(L);
        lua_replace(L, AT_DIRECTION);
    }
    lua_setfield(L, AT_RESULT, "direction");
    lua_setfield(L, AT_RESULT, "failing");
    if (fails)
        lua_pushnumber(L, result->volume);
    else
        lua_pushnil(L);
    lua_setfield(L, AT_RESULT, "volume");
    tl_lua_set_text(L, "message", result->message);
}

/* Makes a run and pushes its result. The table of arguments is at AT_ARGS. `relax`: what a relaxation is asked for, of
 * which `solve` has what the line tells; else NULL. */
static int make_run(lua_State *L, tl_model *model, const char *what, tl_solve *solve, run_kind kind, tl_relax *relax)
{
    run r = {.running = {.L = L}, .owner = lua_touserdata(L, AT_MODEL), .options = tl_lua_options_of(L)};
    lua_settop(L, AT_ANCHOR);
    solve->stop = push_callback(L, what, "stop") ? on_stop : NULL;
    solve->progress = push_callback(L, what, "on_progress") ? on_progress : NULL;
    push_empty_answer(L, kind == RUN_STEPS ? TL_RATIO_LOCAL : solve->measure);
    if (kind != RUN_STEPS)
        tl_lua_trial_prepare(L, AT_ARGS, AT_RESULT, what);
    tl_lua_selection *failing = relax ? push_room(L, model) : NULL;
    solve->each = on_each;
    solve->between = on_between;
    solve->user = &r;
    if (relax)
        call_back_to(relax, solve);
    r.limits = *solve;
    r.owner->next_sample = 0; /* the first step finds it */
    progress_begin(L, &r.line, model);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_lua_running *outer = tl_lua_running_set(&r.running);
    tl_status status = kind == RUN_STEPS   ? tl_model_cycle_calling(model, solve->max_cycles, solve, &r.result.run)
                       : kind == RUN_SOLVE ? tl_model_solve(model, solve, &r.result.run)
                                           : tl_model_relax(model, relax, &r.result);
    if (r.owner->view && !r.running.failed && !tl_lua_view_step(L, r.result.run.wall))
        tl_lua_run_keep_error();
    tl_lua_running_set(outer);
    progress_clear(&r.line);
    tl_lua_watch_end_run(L, &watch, what);
    if (r.running.failed) {
        lua_settop(L, AT_ERROR);
        return lua_error(L);
    }
    tl_lua_ok(L, model, status);
    lua_rawgeti(L, AT_REASONS, (int)r.result.run.reason + 1);
    lua_setfield(L, AT_RESULT, "reason");
    lua_settop(L, failing ? AT_DIRECTION : AT_RESULT);
    lua_pushvalue(L, AT_RESULT);
    set_result(L, &r.result.run);
    lua_pop(L, 1);
    if (failing)
        set_relaxed(L, model, &r.result, failing);
    if (kind != RUN_STEPS)
        tl_lua_trial_run(L, AT_ARGS, AT_RESULT, solve_keys, what);
    return 1;
}

static int model_solve(lua_State *L, tl_model *model)
{
    tl_solve solve = tl_solve_default();
    tl_lua_read_function(L, AT_ARGS, "solve", solve_keys, &solve);
    return make_run(L, model, "solve", &solve, RUN_SOLVE, NULL);
}

static int model_relax(lua_State *L, tl_model *model)
{
    tl_relax relax = tl_relax_default();
    tl_lua_read_function(L, AT_ARGS, "relax", solve_keys, &relax);
    tl_solve solve = tl_solve_default();
    solve.ratio = relax.ratio;
    solve.measure = relax.measure;
    solve.max_cycles = relax.max_cycles;
    return make_run(L, model, "relax", &solve, RUN_RELAX, &relax);
}

/* cycle(cycles, {every =, on_progress =}) */
static int model_cycle(lua_State *L, tl_model *model)
{
    tl_cycle_args args;
    tl_lua_spec spec = tl_lua_spec_of("cycle", solve_keys + KEYS_BEFORE_CYCLE);
    tl_lua_read_one(L, 2, &spec, "cycles", &args);
    lua_settop(L, 3);
    lua_remove(L, 2); /* as in solve the table of arguments is at index 2 */
    spec.params++;    /* besides the first, which was given alone */
    spec.count--;
    tl_lua_read(L, AT_ARGS, &spec, false, &args);
    tl_solve steps = {.every = args.every, .max_cycles = args.cycles};
    return make_run(L, model, "cycle", &steps, RUN_STEPS, NULL);
}

/* ---------------------------------------------------------------- a generator ------------ */

static void progress_generate(void *user, const tl_generate_progress *done)
{
    progress *p = user;
    double t = p->on ? clock_seconds() : 0;
    if (!p->on || t - p->shown < p->period)
        return;
    line l = {.count = 0};
    add(&l, 0, "%s", done->generator);
    if (done->share > 0)
        add(&l, 0, "%.0f %%", floor(100 * fmin(done->share, 1)));
    if (done->entries > 1)
        add(&l, 2, "entry %zu of %zu", done->entry, done->entries);
    add(&l, 3, "%zu cuts", done->cuts);
    add(&l, 2, "%zu blocks", done->blocks);
    if (done->share > 0 && done->share <= 1)
        add_time_left(&l, (t - p->began) * (1 - done->share) / done->share);
    write_line(p, &l);
}

/* Writes a summary into the table at the top of the stack. */
static void set_summary(lua_State *L, const tl_generate_summary *s)
{
    TL_LUA_SET_COUNTS(L, {"before", s->before}, {"after", s->after}, {"cuts", s->cuts}, {"refused", s->refused},
                      {"coincident", s->coincident}, {"slivers", s->slivers});
    TL_LUA_SET_NUMBERS(L, {"smallest_volume", s->smallest_volume}, {"smallest_edge", s->smallest_edge},
                       {"smallest_face", s->smallest_face}, {"volume_error", s->volume_error});
}

/* Gives the summary its field `report`: what is noted of the whole, and a list of the objects. */
static int set_report(lua_State *L)
{
    size_t count;
    const tl_generate_note *note = tl_generate_notes(lua_touserdata(L, 2), &count);
    lua_settop(L, 1);
    lua_newtable(L);
    for (size_t i = 0; i < count; i++) {
        bool same =
            i > 0 && (note[i].object == note[i - 1].object ||
                      (note[i].object && note[i - 1].object && strcmp(note[i].object, note[i - 1].object) == 0));
        if (!note[i].object) {
            lua_pushvalue(L, 2);
        } else if (same) {
            lua_rawgeti(L, 2, (lua_Integer)lua_rawlen(L, 2));
        } else {
            lua_newtable(L);
            lua_pushstring(L, note[i].object);
            lua_setfield(L, -2, "name");
            lua_pushvalue(L, -1);
            lua_rawseti(L, 2, (lua_Integer)lua_rawlen(L, 2) + 1);
        }
        if (note[i].text)
            lua_pushstring(L, note[i].text);
        else
            lua_pushnumber(L, note[i].number);
        lua_setfield(L, -2, note[i].key);
        lua_pop(L, 1);
    }
    if (count)
        lua_setfield(L, 1, "report");
    return 0;
}

/* The number of tables in the list at index 3; 0 when it is none. */
static size_t entry_count(lua_State *L, const char *generator)
{
    if (!lua_istable(L, 3) || lua_rawgeti(L, 3, 1) != LUA_TTABLE)
        return 0;
    size_t count = lua_rawlen(L, 3);
    for (lua_pushnil(L); lua_next(L, 3); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING)
            tl_lua_fail(L, "generate '%s': give a list of parameter tables, or parameters by name, not both",
                        generator);
    tl_lua_check_list(L, 3, lua_pushfstring(L, "generate '%s': the list of parameter tables", generator), count);
    return count;
}

/* Reads the list of parameter tables at index 3; what they point to hangs on a table that is pushed. */
static const tl_args *read_entries(lua_State *L, const char *generator, size_t count)
{
    lua_newtable(L);
    int anchor = lua_gettop(L);
    tl_args *list = lua_newuserdatauv(L, count * sizeof *list, 0);
    lua_rawseti(L, anchor, 0);
    for (size_t i = 0; i < count; i++) {
        const char *context = lua_pushfstring(L, "generate '%s', entry %I", generator, (lua_Integer)i + 1);
        lua_rawgeti(L, 3, (lua_Integer)i + 1);
        if (!lua_istable(L, -1))
            tl_lua_fail(L, "%s: the parameters must be a table, not %s", context, tl_lua_describe(L, -1));
        tl_lua_args(L, -1, context, NULL, &list[i]);
        lua_rawseti(L, anchor, (lua_Integer)i + 1);
        lua_settop(L, anchor);
    }
    return list;
}

int tl_lua_model_generate(lua_State *L, tl_model *model)
{
    const char *generator = tl_lua_text(L, 2, "generate", "the generator's name");
    size_t count = entry_count(L, generator); /* of a list */
    lua_settop(L, 3);
    tl_args one;
    const tl_args *args = &one;
    if (count)
        args = read_entries(L, generator, count);
    else
        tl_lua_args(L, 3, lua_pushfstring(L, "generate '%s'", generator), NULL, &one);
    const char *what = lua_pushfstring(L, "generator '%s'", generator);
    tl_generate_summary summary = {0};
    lua_newtable(L);
    /* All memory is had before blocks are made: a call that fails changes nothing. */
    set_summary(L, &summary);
    progress p;
    progress_begin(L, &p, model);
    tl_model_watch_generate(model, progress_generate, &p);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_status status = count ? tl_generate_list(model, generator, args, count, &summary)
                             : tl_generate(model, generator, args, &summary);
    tl_model_watch_generate(model, NULL, NULL);
    progress_clear(&p);
    tl_lua_ok(L, model, tl_lua_watch_end(L, &watch, status, what, "the model is as it was"));
    set_summary(L, &summary);
    lua_pushcfunction(L, set_report);
    lua_pushvalue(L, -2);
    lua_pushlightuserdata(L, model);
    if (lua_pcall(L, 2, 0, 0) != LUA_OK) /* the blocks are made: without memory there is no report */
        lua_pop(L, 1);
    return 1;
}

#define STIFFER_RESULT                                                                                                 \
    {                                                                                                                  \
        "stiffer", "",                                                                                                 \
            "table of the same of the trial, with try_stiffer; `differs` tells whether the one rests and the other "   \
            "fails, `message` says so, or that one came to a limit before; reason \"error\" of a trial that failed"    \
    }

static const tl_lua_key run_results[] = {
    {"reason", "",
     "why it ended: \"ratio\", \"velocity\", \"failure\", \"overlap\" (blocks that were made overlapping push it "
     "apart), \"cycles\", \"time\", \"stop\" or \"interrupt\" (Ctrl-C at the prompt; in a script it raises an error)"},
    {"ratio", "", "mean unbalanced force over mean contact force"},
    {"ratio_maximum", "", "largest unbalanced force over mean contact force"},
    {"ratio_local", "",
     "largest unbalanced force of a block over its own contact forces, or its weight and load where these are more"},
    {"measure", "", "the measure that may end the run"},
    {"worst", "",
     "the block farthest from rest by the measure \"local\": nil when there is none that can move, or no force on any"},
    {"failing", "",
     "a block that fails steadily: it moves on in one direction without slowing down, and the "
     "force that pushes it stays; nil when none does"},
    {"cycles", "", "steps of this call"},
    {"time", "", "the model's time at the end, s"},
    {"wall", "", "seconds it took"},
    {"max_velocity", "", "largest speed of a block that forces move, m/s"},
    STIFFER_RESULT,
    {NULL, NULL, NULL},
};

static const tl_lua_key relax_results[] = {
    {"reason", "",
     "why it ended: \"rest\", \"failure\", \"overlap\" (blocks that were made overlapping push it apart), "
     "\"cycles\", \"stop\" or \"interrupt\" (Ctrl-C at the prompt; in a script it raises an error)"},
    {"message", "", "what that means, in words; of a run that is not at rest what still moves, and why it is slow"},
    {"failing", "", "the selection of blocks that fail; nil when none does"},
    {"volume", "", "their volume, m3; nil when none fails"},
    {"direction", "", "{x, y, z} of length 1: where they go; nil when none fails"},
    {"worst", "", "the block farthest from rest by the measure \"local\""},
    {"ratio", "", "mean unbalanced force over mean contact force"},
    {"ratio_maximum", "", "largest unbalanced force over mean contact force"},
    {"ratio_local", "", "as in solve"},
    {"measure", "", "the measure that may end it"},
    {"cycles", "", "steps of this call"},
    {"time", "", "the model's time, which stands still, s"},
    {"wall", "", "seconds it took"},
    {"max_velocity", "", "largest speed of a block in the last step, by the masses of the relaxation, m/s"},
    STIFFER_RESULT,
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_run_topics[] = {
    {.name = "cycle",
     .usage = "result = model:cycle(1000)  or  model:cycle(1000, {every = 100, on_progress = f})",
     .function = "cycle",
     .keys = solve_keys + KEYS_BEFORE_CYCLE,
     .title = "Fields of the result",
     .verbs = run_results,
     .arguments = 2,
     .method = model_cycle},
    {.name = "solve",
     .usage = "result = model:solve{ratio = 1e-5, ...}",
     .function = "solve",
     .keys = solve_keys,
     .title = "Fields of the result",
     .verbs = run_results,
     .arguments = 1,
     .method = model_solve},
    {.name = "relax",
     .usage = "result = model:relax{ratio = 1e-5, ...}",
     .function = "relax",
     .keys = solve_keys,
     .title = "Fields of the result",
     .verbs = relax_results,
     .arguments = 1,
     .method = model_relax},
    {.name = NULL},
};
