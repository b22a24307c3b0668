/* try_stiffer.c - a run once more on a copy of the model with stiffer joints: does its verdict hang on stiffness? */
#include "lua/try_stiffer.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/interrupt.h"
#include "lua/living.h"

#include <string.h>
#include <talus/talus.h>

/* Constant: how much stiffer the joints of a trial are. Ten times the stiffness halves what soft joints take off the
 * load of a rigid structure (docs/how_stiff.md). */
#define STIFFER 10.0

static void hush(void *user, const char *text)
{
    (void)user;
    (void)text;
}

void tl_lua_trial_prepare(lua_State *L, int args, int result, const char *what)
{
    const int top = lua_gettop(L), type = tl_lua_option(L, args, "try_stiffer");
    if (type != LUA_TNIL && type != LUA_TBOOLEAN)
        tl_lua_fail(L, "%s: try_stiffer must be true or false, not %s", what, tl_lua_describe(L, -1));
    if (lua_toboolean(L, -1)) {
        lua_getfield(L, TL_LUA_AT_MODEL, "copy");
        lua_pushvalue(L, TL_LUA_AT_MODEL);
        lua_call(L, 1, 1);
        tl_model *copy = ((tl_lua_model *)lua_touserdata(L, -1))->model;
        const tl_status status = tl_joints_stiffen(copy, STIFFER);
        if (status != TL_OK)
            tl_lua_fail(L, "%s, try_stiffer: %s", what, tl_model_error(copy)->text);
        tl_model_log(copy, hush, NULL);
        lua_setfield(L, result, "stiffer");
    }
    lua_settop(L, top);
}

/* Pushes the options of the run for the trial, which calls none of its functions. */
static void push_trial_args(lua_State *L, int args, const tl_lua_key *keys)
{
    lua_newtable(L);
    if (!lua_istable(L, args))
        return;
    for (lua_pushnil(L); lua_next(L, args);) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_settable(L, -4);
    }
    for (const tl_lua_key *key = keys; key->name; key++) {
        lua_pushnil(L);
        lua_setfield(L, -2, key->name);
    }
}

/* What a run has shown. One that came to a limit of its own, as that of cycles, has shown neither. */
typedef enum verdict { OPEN, RESTS, FAILS } verdict;

static verdict verdict_of(const char *reason)
{
    static const char *const rests[] = {"rest", "ratio", "velocity"}, *const fails[] = {"failure", "overlap"};
    for (size_t i = 0; i < sizeof rests / sizeof rests[0]; i++)
        if (strcmp(reason, rests[i]) == 0)
            return RESTS;
    for (size_t i = 0; i < sizeof fails / sizeof fails[0]; i++)
        if (strcmp(reason, fails[i]) == 0)
            return FAILS;
    return OPEN;
}

/* Says how the verdicts differ, or that one of the runs came to none. It puts that into the trial's result, at the top
 * of the stack. */
static void compare_verdicts(lua_State *L, int result, const char *what)
{
    static const char *const words[] = {
        [OPEN] = "it comes to a limit of the run first", [RESTS] = "it rests", [FAILS] = "it fails"};
    lua_getfield(L, result, "reason");
    lua_getfield(L, -2, "reason");
    const verdict one = verdict_of(lua_tostring(L, -2)), other = verdict_of(lua_tostring(L, -1));
    lua_pop(L, 2);
    lua_pushboolean(L, one != OPEN && other != OPEN && one != other);
    lua_setfield(L, -2, "differs");
    if (one == other)
        return;
    const bool open = one == OPEN || other == OPEN;
    lua_pushfstring(L, "%s: %s the stiffness of the joints: with it as given %s, with %d times as much %s; %s", what,
                    open ? "it is open whether the verdict hangs on" : "the verdict hangs on", words[one], (int)STIFFER,
                    words[other],
                    open ? "raise max_cycles, or max_time where it is given"
                         : "measure the stiffness, or take that which stands for rigid blocks (docs/how_stiff.md)");
    tl_lua_log(tl_lua_options_of(L), lua_tostring(L, -1));
    lua_setfield(L, -2, "message");
}

static bool was_stopped(lua_State *L, int result)
{
    lua_getfield(L, result, "reason");
    const char *reason = lua_tostring(L, -1);
    const bool stopped = strcmp(reason, "stop") == 0 || strcmp(reason, "interrupt") == 0;
    lua_pop(L, 1);
    return stopped;
}

void tl_lua_trial_run(lua_State *L, int args, int result, const tl_lua_key *keys, const char *what)
{
    const int top = lua_gettop(L);
    if (lua_getfield(L, result, "stiffer") != LUA_TUSERDATA) {
        lua_settop(L, top);
        return;
    }
    lua_pushnil(L);
    lua_setfield(L, result, "stiffer");
    if (!was_stopped(L, result)) {
        lua_getfield(L, -1, what);
        lua_insert(L, -2);
        push_trial_args(L, args, keys);
        if (lua_pcall(L, 2, 1, 0) == LUA_OK) {
            compare_verdicts(L, result, what);
        } else if (tl_lua_interrupted(lua_tostring(L, -1))) {
            lua_error(L);
        } else {
            lua_newtable(L);
            lua_pushliteral(L, "error");
            lua_setfield(L, -2, "reason");
            lua_insert(L, -2);
            lua_setfield(L, -2, "message");
        }
        lua_setfield(L, result, "stiffer");
    }
    lua_settop(L, top);
}
