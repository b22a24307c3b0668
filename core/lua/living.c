/* living.c - what all of the front end asks of a Lua state: its options, the model behind an object, and remarks. */
#include "lua/living.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/interrupt.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

tl_lua_options *tl_lua_options_of(lua_State *L)
{
    /* Only the address is used: it is a key no one else can have. */
    static const char key;
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &key) == LUA_TNIL) {
        tl_lua_options *fresh = lua_newuserdatauv(L, sizeof *fresh, 0);
        *fresh = (tl_lua_options){0};
        lua_rawsetp(L, LUA_REGISTRYINDEX, &key);
        lua_pop(L, 1);
        return fresh;
    }
    tl_lua_options *options = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return options;
}

void tl_lua_log(void *user, const char *text)
{
    const tl_lua_options *options = user;
    if (!options->quiet)
        fprintf(stderr, "%stalus: %s\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", text);
}

void tl_lua_default_threads(lua_State *L, int64_t *threads)
{
    const char *text = getenv("TALUS_THREADS");
    tl_lua_options *options = tl_lua_options_of(L);
    if (options->threads > 0)
        *threads = options->threads;
    else if (text && text[0]) {
        char *end;
        long number = strtol(text, &end, 10);
        if (*end || number < 1 || number > 256)
            tl_lua_fail(L, "the environment's TALUS_THREADS = '%s' is not a whole number in [1, 256]", text);
        *threads = number;
    }
}

void *tl_lua_hold(lua_State *L, size_t size, const char *type, lua_CFunction release)
{
    void *memory = memset(lua_newuserdatauv(L, size, 0), 0, size);
    if (luaL_newmetatable(L, type)) {
        lua_pushcfunction(L, release);
        lua_setfield(L, -2, "__gc");
    }
    lua_setmetatable(L, -2);
    return memory;
}

tl_lua_model *tl_lua_model_push(lua_State *L)
{
    tl_lua_model *object = lua_newuserdatauv(L, sizeof *object, TL_LUA_USER_VALUES);
    *object = (tl_lua_model){.next_sample = INT64_MAX};
    lua_newtable(L);
    lua_setiuservalue(L, -2, TL_LUA_DRIVES);
    lua_newtable(L);
    lua_setiuservalue(L, -2, TL_LUA_HISTORIES);
    luaL_setmetatable(L, TL_LUA_MODEL_TYPE);
    return object;
}

void tl_lua_model_begin(lua_State *L, const tl_lua_model *object)
{
    tl_model_log(object->model, tl_lua_log, tl_lua_options_of(L));
    tl_model_speak_lua(object->model, true);
    tl_model_interrupt_if(object->model, tl_lua_interrupt_asked);
}

tl_model *tl_lua_model_of(lua_State *L, const char *method)
{
    tl_lua_model *object = luaL_testudata(L, 1, TL_LUA_MODEL_TYPE);
    if (!object)
        tl_lua_fail(L, "%s: called on %s; write model:%s(...)", method, tl_lua_describe(L, 1), method);
    return tl_lua_living(L, object);
}

tl_model *tl_lua_living(lua_State *L, const tl_lua_model *owner)
{
    if (!owner->model)
        tl_lua_fail(L, "the model was closed");
    tl_lua_interrupt_check(L); /* in a coroutine no hook tells */
    return owner->model;
}

void tl_lua_ok(lua_State *L, tl_model *model, tl_status status)
{
    if (status != TL_OK)
        tl_lua_raise(L, tl_model_error(model));
}

int tl_lua_call_reading(lua_State *L, tl_lua_model *owner, int arguments, int results)
{
    bool outer = owner->sampling;
    owner->sampling = true;
    tl_model_only_read(owner->model, true);
    int status = lua_pcall(L, arguments, results, 0);
    tl_model_only_read(owner->model, outer);
    owner->sampling = outer;
    return status;
}

/* ---------------------------------------------------------------- runs --------------------
 *
 * The run whose step is being made, for functions of the script that are called in it (run.c, block.c). */

static tl_lua_running *current;

tl_lua_running *tl_lua_running_set(tl_lua_running *run)
{
    tl_lua_running *before = current;
    current = run;
    return before;
}

lua_State *tl_lua_run_state(void)
{
    return current->L;
}

void tl_lua_run_keep_error(void)
{
    lua_replace(current->L, TL_LUA_AT_ERROR);
    current->failed = true;
}
