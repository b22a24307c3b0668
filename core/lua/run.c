/* run.c - cycle and solve: callbacks into Lua.
 *
 * No Lua error may jump over the kernel's frames: callbacks run in protected calls, an error is kept
 * on the stack, the run ends after the step, and only then is the error raised again, as it was. */
#include "front.h"
#include "progress.h"

/* Places on the Lua stack during a run. */
enum {
    AT_MODEL = TL_LUA_AT_MODEL,
    AT_ARGS,
    AT_ANCHOR,
    AT_STOP,
    AT_PROGRESS,
    AT_ERROR = TL_LUA_AT_ERROR,
    AT_REASONS,
    AT_RESULT
};

typedef struct run {
    tl_lua_running running;
    lua_State *L;
    tl_model *model;
    const tl_lua_model *owner;
    tl_lua_options *options;
    tl_lua_watch watch;
    tl_solve limits; /* what is run */
    tl_lua_progress line;
    tl_solve_result result;
} run;

static void run_begin(run *r, lua_State *L, tl_model *model)
{
    *r = (run){.L = L, .model = model};
    r->owner = lua_touserdata(L, AT_MODEL);
    r->options = tl_lua_options_of(L);
    tl_lua_histories_due(L, AT_MODEL);
    tl_lua_progress_begin(L, &r->line, model);
    r->watch = tl_lua_watch_begin(L);
    tl_lua_running_begin(&r->running, L);
}

static void run_end(run *r)
{
    tl_lua_running_end(&r->running);
    tl_lua_progress_clear(&r->line);
}

/* ---------------------------------------------------------------- results ---------------- */

/* Writes numbers into the table at the top of the stack. */
static void set_numbers(lua_State *L, const tl_solve_result *result)
{
    const struct {
        const char *name;
        double number;
    } numbers[] = {{"ratio", result->ratio},
                   {"ratio_maximum", result->ratio_maximum},
                   {"ratio_local", result->ratio_local},
                   {"time", result->time},
                   {"wall", result->wall},
                   {"max_velocity", result->max_velocity}};
    lua_pushinteger(L, (lua_Integer)result->cycles);
    lua_setfield(L, -2, "cycles");
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        tl_lua_set_number(L, numbers[i].name, numbers[i].number);
    }
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
        tl_lua_item_push(L, TL_LUA_BLOCK, model_index, TL_NO_ID);
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

/* All memory for what a run will answer is had before the first step: a call that fails for want of it has made none. */
static void push_empty_answer(lua_State *L, int32_t measure)
{
    lua_settop(L, AT_ERROR);
    lua_newtable(L);
    for (int reason = 0; reason <= TL_SOLVE_OVERLAP; reason++) {
        lua_pushstring(L, tl_solve_reason_name((tl_solve_reason)reason));
        lua_rawseti(L, AT_REASONS, reason + 1);
    }
    push_empty_result(L, AT_MODEL, measure);
    lua_pushboolean(L, false);
    lua_setfield(L, AT_RESULT, "reason");
}

/* ---------------------------------------------------------------- callbacks -------------- */

/* Runs protected: on_progress(model, result). Arguments: function, model, run. */
static int call_progress(lua_State *L)
{
    const run *r = lua_touserdata(L, 3);
    lua_settop(L, 2);
    push_empty_result(L, 2, r->result.measure);
    set_result(L, &r->result);
    lua_call(L, 2, 0);
    return 0;
}

/* After every step: the line, the samples that are due, and then a save, which has them. */
static tl_status on_each(void *user, tl_model *model)
{
    run *r = user;
    if (r->running.failed) /* a drive's function */
        return TL_E_CANCELLED;
    tl_lua_progress_run(&r->line, model, &r->limits, &r->result);
    if (tl_model_cycles(model) >= r->owner->next_sample &&
        !tl_lua_histories_sample(r->L, AT_MODEL)) {
        tl_lua_run_keep_error();
        return TL_E_CANCELLED;
    }
    if (!r->owner->probe)
        tl_lua_autosave(r->options, model);
    if (r->owner->view && !tl_lua_view_step(r->L, 0)) {
        tl_lua_run_keep_error();
        return TL_E_CANCELLED;
    }
    return TL_OK;
}

/* Before every step: those who look at the model, if it is seen, may want something. */
static tl_status on_between(void *user, tl_model *model)
{
    (void)model;
    run *r = user;
    if (r->running.failed)
        return TL_E_CANCELLED;
    if (tl_lua_view_between(r->L))
        return TL_OK;
    tl_lua_run_keep_error();
    return TL_E_CANCELLED;
}

static tl_status on_progress(void *user, tl_model *model)
{
    (void)model;
    run *r = user;
    lua_State *L = r->L;
    if (r->running.failed)
        return TL_E_CANCELLED;
    tl_lua_progress_clear(&r->line); /* the function may print */
    lua_pushcfunction(L, call_progress);
    lua_pushvalue(L, AT_PROGRESS);
    lua_pushvalue(L, AT_MODEL);
    lua_pushlightuserdata(L, r);
    if (lua_pcall(L, 3, 0, 0) == LUA_OK)
        return TL_OK;
    tl_lua_run_keep_error();
    return TL_E_CANCELLED;
}

static bool on_stop(void *user, tl_model *model)
{
    (void)model;
    run *r = user;
    lua_State *L = r->L;
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

const tl_lua_key tl_lua_cycle_keys[] = {
    {"on_progress", "function(model, result)", "called every `every` steps"},
    {NULL, NULL, NULL},
};

const tl_lua_key tl_lua_solve_keys[] = {
    {"stop", "function(model)", "called every `every` steps; ends the run when it answers true"},
    {"on_progress", "function(model, result)", "called every `every` steps"},
    {NULL, NULL, NULL},
};

/* Pushes the function of that key, or nil; true when there is one. */
static bool push_callback(lua_State *L, const char *what, const char *key)
{
    if (!lua_istable(L, AT_ARGS)) {
        lua_pushnil(L);
        return false;
    }
    int type = lua_getfield(L, AT_ARGS, key);
    if (type != LUA_TNIL && type != LUA_TFUNCTION)
        tl_lua_fail(L, "%s: %s must be a function, not %s", what, key, tl_lua_describe(L, -1));
    return type == LUA_TFUNCTION;
}

static int finish(lua_State *L, run *r, const char *what, tl_status status)
{
    if (r->owner->view && !r->running.failed && !tl_lua_view_step(L, r->result.wall))
        tl_lua_run_keep_error();
    run_end(r);
    tl_lua_watch_end_run(L, &r->watch, what);
    if (r->running.failed) {
        lua_settop(L, AT_ERROR);
        return lua_error(L);
    }
    tl_lua_ok(L, r->model, status);
    lua_settop(L, AT_RESULT);
    set_result(L, &r->result);
    lua_rawgeti(L, AT_REASONS, (int)r->result.reason + 1);
    lua_setfield(L, AT_RESULT, "reason");
    return 1;
}

int tl_lua_solve(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "solve");
    tl_lua_arity(L, 2, "solve");
    lua_settop(L, 2);
    luaL_checkstack(L, LUA_MINSTACK, "too many values");
    tl_solve solve = tl_solve_default();
    tl_lua_spec spec = tl_lua_spec_of("solve", tl_lua_solve_keys);
    tl_lua_read(L, AT_ARGS, &spec, false, &solve);
    lua_settop(L, AT_ANCHOR);
    bool stop = push_callback(L, "solve", "stop");
    bool progress = push_callback(L, "solve", "on_progress");
    push_empty_answer(L, solve.measure);
    run r;
    run_begin(&r, L, model);
    solve.each = on_each;
    solve.between = on_between;
    solve.progress = progress ? on_progress : NULL;
    solve.stop = stop ? on_stop : NULL;
    solve.user = &r;
    r.limits = solve;
    return finish(L, &r, "solve", tl_model_solve(model, &solve, &r.result));
}

/* cycle(cycles, {every =, on_progress =}) */
int tl_lua_cycle(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "cycle");
    tl_lua_arity(L, 3, "cycle");
    lua_settop(L, 3);
    luaL_checkstack(L, LUA_MINSTACK, "too many values");
    tl_cycle_args args;
    tl_lua_spec spec = tl_lua_spec_of("cycle", tl_lua_cycle_keys);
    tl_lua_read_one(L, 2, &spec, "cycles", &args);
    lua_settop(L, 3);
    lua_remove(L, 2); /* as in solve the table of arguments is at index 2 */
    spec.params++;    /* besides the first, which was given alone */
    spec.count--;
    tl_lua_read(L, AT_ARGS, &spec, false, &args);
    tl_solve calls = {.each = on_each, .every = args.every, .max_cycles = args.cycles};
    lua_settop(L, AT_ANCHOR);
    push_callback(L, "cycle", "stop"); /* nil: it takes none */
    calls.progress = push_callback(L, "cycle", "on_progress") ? on_progress : NULL;
    push_empty_answer(L, TL_RATIO_LOCAL);
    run r;
    run_begin(&r, L, model);
    calls.user = &r;
    calls.between = on_between;
    r.limits = calls;
    return finish(L, &r, "cycle", tl_model_cycle_calling(model, args.cycles, &calls, &r.result));
}
