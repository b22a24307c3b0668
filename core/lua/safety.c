/* safety.c - factors of safety by dividing strengths: model:factor_of_safety and model:safety_map. */
#include "lua/safety.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/interrupt.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>

/* Where a search keeps its arguments, and the function that is called after each trial. */
enum { AT_ARGS = 2, AT_TRIAL = 3 };

typedef struct caller {
    lua_State *L;
    tl_lua_model *owner;
    bool failed; /* the function has, and its error is at the top of the stack */
} caller;

/* ---------------------------------------------------------------- arguments -------------- */

static const tl_lua_key safety_keys[] = {
    {"joints", "text in quotes or list of names",
     "joints whose laws are divided: they must have laws of their own; all when left out"},
    {"on_trial", "function(trial)", "called after each trial with {F =, holds =, undecided =, cycles =, why =}"},
    {NULL, NULL, NULL},
};

/* Reads the names of joints, which stay valid as long as the table of arguments. Pushes what holds the list. */
static void read_joints(lua_State *L, const char *what, tl_safety *options)
{
    const int type = tl_lua_option(L, AT_ARGS, "joints");
    if (type == LUA_TNIL)
        return;
    if (type != LUA_TSTRING && type != LUA_TTABLE)
        tl_lua_fail(L, "%s: joints must be a name or a list of names, not %s", what, tl_lua_describe(L, -1));
    const size_t count = type == LUA_TSTRING ? 1 : (size_t)lua_rawlen(L, -1);
    const int at = lua_gettop(L);
    if (type == LUA_TTABLE)
        tl_lua_check_list(L, at, "joints", count);
    if (count == 0)
        tl_lua_fail(L, "%s: joints is an empty list; leave it out for all joints", what);
    const char **names = lua_newuserdatauv(L, count * sizeof *names, 0);
    for (size_t i = 0; i < count; i++) {
        if (type == LUA_TSTRING)
            lua_pushvalue(L, at);
        else
            lua_rawgeti(L, at, (lua_Integer)i + 1);
        names[i] = tl_lua_text(L, -1, what, "the name of a joint"); /* the table keeps it */
        lua_pop(L, 1);
    }
    options->joints = names;
    options->joint_count = count;
}

static void push_trial(lua_State *L, const tl_safety_trial *trial)
{
    lua_createtable(L, 0, 5);
    tl_lua_set_number(L, "F", trial->factor);
    lua_pushboolean(L, trial->holds != 0);
    lua_setfield(L, -2, "holds");
    lua_pushboolean(L, trial->undecided != 0);
    lua_setfield(L, -2, "undecided");
    tl_lua_set_count(L, "cycles", (size_t)trial->cycles);
    tl_lua_set_text(L, "why", trial->why);
}

/* Runs protected: on_trial(trial). Arguments: function, trial. */
static int call_trial(lua_State *L)
{
    push_trial(L, lua_touserdata(L, 2));
    lua_replace(L, 2);
    lua_call(L, 1, 0);
    return 0;
}

static tl_status on_trial(void *user, const tl_safety_trial *trial)
{
    caller *c = user;
    lua_State *L = c->L;
    lua_pushcfunction(L, call_trial);
    lua_pushvalue(L, AT_TRIAL);
    lua_pushlightuserdata(L, (void *)(uintptr_t)trial);
    c->failed = tl_lua_call_reading(L, c->owner, 2, 0) != LUA_OK;
    return c->failed ? TL_E_CANCELLED : TL_OK;
}

/* Reads what is asked. */
static tl_safety read_options(lua_State *L, const char *what, caller *c)
{
    tl_safety options = tl_safety_default();
    lua_settop(L, AT_ARGS);
    const int type = tl_lua_option(L, AT_ARGS, "on_trial");
    if (type != LUA_TNIL && type != LUA_TFUNCTION)
        tl_lua_fail(L, "%s: on_trial must be a function, not %s", what, tl_lua_describe(L, -1));
    tl_lua_read_function(L, AT_ARGS, what, safety_keys, &options);
    read_joints(L, what, &options);
    *c = (caller){.L = L, .owner = lua_touserdata(L, TL_LUA_AT_MODEL)};
    options.on_trial = type == LUA_TFUNCTION ? on_trial : NULL;
    options.user = c;
    if (options.workers > 1) { /* models that nothing holds any more may have threads */
        lua_gc(L, LUA_GCCOLLECT);
        lua_gc(L, LUA_GCCOLLECT);
    }
    return options;
}

/* Raises what has gone wrong in a search. */
static void check_search(lua_State *L, tl_model *model, const caller *c, const tl_lua_watch *watch, tl_status status,
                         const char *what)
{
    if (c->failed && !tl_lua_interrupt_asked()) {
        tl_lua_watch_end(L, watch, TL_OK, what, "");
        lua_error(L); /* that of the function */
    }
    tl_lua_watch_end(L, watch, status, what, "the model is as it was");
    tl_lua_ok(L, model, status);
}

/* ---------------------------------------------------------------- one factor ------------- */

static int free_result(lua_State *L)
{
    tl_safety_free(lua_touserdata(L, 1));
    return 0;
}

/* Sets a selection of the blocks of a list, which then belongs to it. */
static void set_blocks(lua_State *L, const char *name, tl_safety_blocks *blocks)
{
    tl_lua_selection *selection = tl_lua_selection_push(L, &tl_lua_block_kind, TL_LUA_AT_MODEL);
    selection->names = blocks->ids;
    selection->count = blocks->count;
    blocks->ids = NULL;
    lua_setfield(L, -2, name);
}

static void set_keyblock(lua_State *L, const tl_safety_result *r)
{
    if (isnan(r->keyblock_factor))
        return;
    lua_createtable(L, 0, 2);
    tl_lua_set_number(L, "factor", r->keyblock_factor);
    tl_lua_set_block(L, "block", r->keyblock);
    lua_setfield(L, -2, "keyblock");
}

static void push_result(lua_State *L, tl_safety_result *r)
{
    lua_createtable(L, 0, 16);
    TL_LUA_SET_NUMBERS(L, {"factor", r->factor}, {"lower", r->lower}, {"upper", r->upper}, {"volume", r->volume},
                       {"wall", r->wall});
    TL_LUA_SET_COUNTS(L, {"cycles", (size_t)r->cycles}, {"undecided", (size_t)r->undecided});
    tl_lua_set_text(L, "mode", tl_safety_mode_name((tl_safety_mode)r->mode));
    tl_lua_set_text(L, "message", r->message);
    if (r->failing.count > 0)
        tl_lua_set_vec3(L, "direction", (tl_vec3){r->direction[0], r->direction[1], r->direction[2]});
    set_keyblock(L, r);
    lua_createtable(L, (int)r->trial_count, 0);
    for (size_t i = 0; i < r->trial_count; i++) {
        push_trial(L, &r->trials[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "trials");
    set_blocks(L, "failing", &r->failing);
    set_blocks(L, "small", &r->small);
}

static int model_factor_of_safety(lua_State *L, tl_model *model)
{
    caller c;
    const tl_safety options = read_options(L, "factor_of_safety", &c);
    tl_safety_result *result = tl_lua_hold(L, sizeof *result, "talus.safety", free_result);
    const tl_lua_watch watch = tl_lua_watch_begin(L);
    const tl_status status = tl_model_factor_of_safety(model, &options, result);
    check_search(L, model, &c, &watch, status, "factor_of_safety");
    push_result(L, result);
    return 1;
}

/* ---------------------------------------------------------------- a map ------------------ */

static int free_map(lua_State *L)
{
    tl_safety_map_free(lua_touserdata(L, 1));
    return 0;
}

static void push_map(lua_State *L, const tl_safety_map *map)
{
    lua_createtable(L, 0, 5);
    lua_createtable(L, 0, (int)map->count);
    for (size_t i = 0; i < map->count; i++) {
        lua_pushnumber(L, map->factor[i]);
        lua_rawseti(L, -2, (lua_Integer)map->ids[i]);
    }
    lua_setfield(L, -2, "factor");
    lua_createtable(L, (int)map->point_count, 0);
    for (size_t i = 0; i < map->point_count; i++) {
        lua_createtable(L, 0, 3);
        TL_LUA_SET_NUMBERS(L, {"factor", map->curve[i].factor}, {"volume", map->curve[i].volume});
        tl_lua_set_count(L, "blocks", map->curve[i].blocks);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "curve");
    TL_LUA_SET_COUNTS(L, {"undecided", (size_t)map->undecided}, {"cycles", (size_t)map->cycles});
    tl_lua_set_number(L, "wall", map->wall);
}

static int model_safety_map(lua_State *L, tl_model *model)
{
    caller c;
    const tl_safety options = read_options(L, "safety_map", &c);
    tl_safety_map *map = tl_lua_hold(L, sizeof *map, "talus.safety_map", free_map);
    const tl_lua_watch watch = tl_lua_watch_begin(L);
    const tl_status status = tl_model_safety_map(model, &options, map);
    check_search(L, model, &c, &watch, status, "safety_map");
    push_map(L, map);
    return 1;
}

/* ---------------------------------------------------------------- help ------------------- */

static const tl_lua_key safety_results[] = {
    {"factor", "",
     "sqrt(lower * upper); 0 where it fails whatever the strengths, math.huge where it holds at `to`, `from` where it "
     "fails there"},
    {"lower, upper", "", "the largest factor that holds, 0: none; and the least that fails, math.huge: none"},
    {"failing", "", "selection of the blocks that go together at `upper`: those within 0.3 of the fastest"},
    {"volume, direction", "", "of these, m3, and where they go, a unit vector; without any direction is nil"},
    {"mode", "",
     "\"slides\"; \"turns\" (its corners go farther by rotation than its centre goes); \"falls\" (nothing bears it); "
     "\"yields\" (a deformable block is strained on and on); \"holds\" without any"},
    {"keyblock", "",
     "{factor =, block =}: the least factor of model:keyblocks with the strengths of the laws; nil where there is "
     "none, "
     "or laws have no friction and cohesion or name blocks"},
    {"trials", "", "each a table: F, holds, undecided, cycles, why; in the order in which they were made"},
    {"small", "",
     "selection of the blocks below least_volume that failed before at `upper`, and were deleted in that copy"},
    {"undecided", "", "number of trials that neither came to rest nor failed: they count as failing"},
    {"cycles, wall", "", "steps of all trials, and s"},
    {"message", "", "all of this in a sentence"},
    {NULL, NULL, NULL},
};

static const tl_lua_key map_results[] = {
    {"factor", "",
     "by the id of each block that can move: the factor at which it fails once those before it have gone; math.huge: "
     "it "
     "holds at `to`; 0: nothing holds it. Files and screens take it as block_fields = {safety = map.factor}"},
    {"curve", "", "by ascending factors, each {factor =, volume =, blocks =}: what has failed by then, in all"},
    {"undecided", "", "number of trials that neither came to rest nor failed: they count as failing"},
    {"cycles, wall", "", "steps of all trials, and s"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_safety_topics[] = {
    {.name = "factor_of_safety",
     .usage = "result = model:factor_of_safety{resolution = 0.01}",
     .function = "factor_of_safety",
     .keys = safety_keys,
     .title = "Fields of the result",
     .verbs = safety_results,
     .arguments = 1,
     .method = model_factor_of_safety},
    {.name = "safety_map",
     .usage = "map = model:safety_map{from = 0.5, to = 3, step = 0.5}",
     .function = "safety_map",
     .keys = safety_keys,
     .title = "Fields of the map",
     .verbs = map_results,
     .arguments = 1,
     .method = model_safety_map},
    {.name = NULL},
};
