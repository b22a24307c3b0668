/* state.c - a model once more: model:copy(), model:save(path), talus.restore(path).
 *
 * The functions of drives and histories belong to the script. A copy shares them. No file keeps them, so they are given
 * again to restore (those of histories: history.c). The anchors they hang on (action.c) are made before the kernel asks
 * for them, for no Lua error may leave it. */
#include "lua/state.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/history.h"
#include "lua/living.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const tl_lua_key restore_keys[] = {
    {"threads", "whole number",
     "threads, in [1, 256]; default: as of talus.model. Results are the same bits for any number"},
    {"drives", "{BLOCK = function(t)}",
     "what functions drive, by the lowest block of each drive: a function(t) for its velocity, or "
     "{velocity = function(t), angular_velocity = function(t)}"},
    {"histories", "{NAME = function(model)}",
     "what functions sample, by the name of each history; false ends the history of that name"},
    {NULL, NULL, NULL},
};

/* Anchors by whom they are for: an anchor of the model that is copied, or a block. */
typedef struct drive_binding {
    const void *anchor;
    tl_id block;
    tl_drive drive;
    bool taken;
} drive_binding;

typedef struct drive_bindings {
    size_t count;
    drive_binding list[];
} drive_bindings;

static bool give(void *user, const tl_drive_asked *asked, tl_drive *drive)
{
    drive_bindings *all = user;
    for (size_t i = 0; i < all->count; i++) {
        drive_binding *g = &all->list[i];
        if (asked->from ? g->anchor == asked->from->user : g->block == asked->block) {
            *drive = g->drive;
            g->taken = true;
            /* the kernel has it now, and says when it ends */
            ((tl_lua_anchor *)drive->user)->ended = false;
            return true;
        }
    }
    return false;
}

/* Pushes an empty list with room for as many anchors as the table at the top of the stack has entries. */
static drive_bindings *push_bindings(lua_State *L)
{
    size_t count = 0;
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1))
        count++;
    drive_bindings *all = lua_newuserdatauv(L, sizeof *all + count * sizeof all->list[0], 0);
    all->count = 0;
    return all;
}

/* ---------------------------------------------------------------- copy ------------------- */

/* Twins, hanging on the model at `to`, of all anchors of the model at `from`. */
static drive_bindings *push_twins(lua_State *L, int from, int to)
{
    lua_getiuservalue(L, from, TL_LUA_DRIVES);
    int anchors = lua_gettop(L);
    drive_bindings *all = push_bindings(L);
    for (lua_pushnil(L); lua_next(L, anchors);) {
        int old = lua_gettop(L);
        drive_binding *g = &all->list[all->count];
        *g = (drive_binding){.anchor = lua_touserdata(L, old), .block = TL_NO_ID};
        lua_getiuservalue(L, old, TL_LUA_VELOCITY);
        lua_getiuservalue(L, old, TL_LUA_ANGULAR_VELOCITY);
        tl_lua_anchor_push(L, to, &g->drive);
        all->count++;
        lua_settop(L, old - 1);
    }
    return all;
}

/* Lua sees a few bytes of a model only: lets its collector go on as if it had made all of it. */
static void tell_weight(lua_State *L, const tl_model *model)
{
    size_t kilobytes = tl_model_memory(model).total / 1024;
    lua_gc(L, LUA_GCSTEP, kilobytes < INT_MAX / 2 ? (int)kilobytes : INT_MAX / 2);
}

static int model_copy(lua_State *L, tl_model *model)
{
    tl_lua_model *object = tl_lua_model_push(L);
    drive_bindings *all = push_twins(L, 1, 2);
    tl_lua_ok(L, model, tl_model_copy(model, give, all, &object->model));
    tl_lua_model_begin(L, object);
    tl_lua_histories_share(L, 1, 2);
    object->probe = true;
    tell_weight(L, object->model);
    lua_settop(L, 2);
    return 1;
}

/* ---------------------------------------------------------------- files ------------------ */

static int model_save(lua_State *L, tl_model *model)
{
    const char *path = tl_lua_text(L, 2, "save", "the file");
    tl_lua_ok(L, model, tl_model_save(model, path));
    return 0;
}

/* Refuses what is neither a function nor nil at the top of the stack. */
static void check_function(lua_State *L, const char *what)
{
    if (!lua_isnil(L, -1) && !lua_isfunction(L, -1))
        tl_lua_fail(L, "talus.restore: %s of a drive must be a function(t), not %s", what, tl_lua_describe(L, -1));
}

/* Pushes velocity and angular velocity, functions or nil, of the value of `drives` at `value`. */
static void push_functions(lua_State *L, int value)
{
    int top = lua_gettop(L);
    if (lua_istable(L, value)) {
        const tl_lua_spec spec = {"talus.restore: drives", NULL, 0, tl_lua_drive_keys};
        tl_lua_read(L, value, &spec, false, NULL);
        lua_settop(L, top);
        lua_getfield(L, value, "velocity");
        check_function(L, "velocity");
        lua_getfield(L, value, "angular_velocity");
        check_function(L, "angular_velocity");
    } else {
        lua_pushvalue(L, value);
        check_function(L, "velocity");
        lua_pushnil(L);
    }
}

/* Anchors, hanging on the model at `to`, of what the option `drives` of the table at index 2 gives. */
static drive_bindings *push_block_bindings(lua_State *L, int to)
{
    if (tl_lua_option(L, 2, "drives") == LUA_TNIL)
        lua_newtable(L);
    int drives = lua_gettop(L);
    if (!lua_istable(L, drives))
        tl_lua_fail(L, "talus.restore: drives must be a table of functions by block, not %s",
                    tl_lua_describe(L, drives));
    drive_bindings *all = push_bindings(L);
    for (lua_pushnil(L); lua_next(L, drives);) {
        int value = lua_gettop(L);
        if (!lua_isinteger(L, value - 1))
            tl_lua_fail(L, "talus.restore: drives has the key %s, which is the number of no block",
                        tl_lua_describe(L, value - 1));
        drive_binding *g = &all->list[all->count];
        *g = (drive_binding){.block = (tl_id)lua_tointeger(L, value - 1)};
        push_functions(L, value);
        tl_lua_anchor_push(L, to, &g->drive);
        all->count++;
        lua_settop(L, value - 1);
    }
    return all;
}

static void read_threads(lua_State *L, int64_t *threads)
{
    *threads = 1;
    tl_lua_default_threads(L, threads);
    if (tl_lua_option(L, 2, "threads") == LUA_TNIL)
        return;
    if (!lua_isinteger(L, -1) || lua_tointeger(L, -1) < 1 || lua_tointeger(L, -1) > 256)
        tl_lua_fail(L, "talus.restore: threads = %s is not a whole number in [1, 256]", luaL_tolstring(L, -1, NULL));
    *threads = lua_tointeger(L, -1);
}

/* Checks the options at index 2, and pushes an object without a model, and what they give for its drives. */
static drive_bindings *read_options(lua_State *L, int64_t *threads, tl_lua_model **object)
{
    const tl_lua_spec spec = {"talus.restore", NULL, 0, restore_keys};
    tl_lua_read(L, 2, &spec, false, NULL);
    lua_settop(L, 2);
    read_threads(L, threads);
    lua_settop(L, 2);
    tl_lua_histories_given(L);
    *object = tl_lua_model_push(L);
    return push_block_bindings(L, 3);
}

static int module_restore(lua_State *L)
{
    tl_lua_arity(L, 2, "talus.restore");
    lua_settop(L, 2);
    const char *path = tl_lua_text(L, 1, "talus.restore", "the file");
    int64_t threads;
    tl_lua_model *object;
    drive_bindings *all = read_options(L, &threads, &object);
    tl_error error;
    if (tl_model_restore(path, threads, give, all, &object->model, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    for (size_t i = 0; i < all->count; i++)
        if (!all->list[i].taken)
            tl_lua_fail(L, "talus.restore: no function drove block %I when the model was saved",
                        (lua_Integer)all->list[i].block);
    tl_lua_model_begin(L, object);
    tl_lua_histories_again(L, path, 3);
    tell_weight(L, object->model);
    lua_settop(L, 3);
    return 1;
}

/* talus.resumed(options): as talus.restore of the script's last save; nil without --resume, or when there is none. */
static int module_resumed(lua_State *L)
{
    tl_lua_arity(L, 1, "talus.resumed");
    lua_settop(L, 1);
    const tl_lua_options *options = tl_lua_options_of(L);
    lua_pushnil(L); /* the options, at index 2 as of restore, are looked at in any case */
    lua_insert(L, 1);
    int64_t threads;
    tl_lua_model *object;
    read_options(L, &threads, &object);
    lua_settop(L, 2);
    if (!options->resume || !options->save_path || access(options->save_path, F_OK) != 0) {
        lua_pushnil(L);
        return 1;
    }
    lua_pushcfunction(L, module_restore);
    lua_pushstring(L, options->save_path);
    lua_pushvalue(L, 2);
    lua_call(L, 2, 1);
    return 1;
}

const tl_lua_topic tl_lua_state_topics[] = {
    {.name = "copy",
     .usage = "twin = model:copy()",
     .doc = "The same model once more in memory: equal state, and equal bits after equal calls "
            "from then on. The functions of drives are shared; frames of the copy begin with 0.",
     .method = model_copy},
    {.name = "save",
     .usage = "model:save(\"out/run.talus\")",
     .doc = "Saves all that the next steps depend on, to the bit, compressed and with checksums. The file appears "
            "whole or not at all, in the place of an older one, and outlives a crash of the machine; folders are made. "
            "The model goes on as if it had not been saved. Histories are saved with all their samples; functions of "
            "drives and histories are not. Frames of files go on with the next number.",
     .arguments = 1,
     .method = model_save},
    {.name = "restore",
     .usage = "model = talus.restore(\"out/run.talus\", {threads = 2})",
     .doc = "The model that a file holds: it goes on as the saved one does, to the bit, on any "
            "number of threads. Laws and damping must be loaded in the version that it was saved "
            "with. A damaged file, and one of another format, is refused.",
     .keys = restore_keys,
     .call = module_restore},
    {.name = "resumed",
     .usage = "model = talus.resumed()",
     .doc = "The model that `talus run --autosave MINUTES SCRIPT` saved last, after `talus run "
            "--resume SCRIPT`; nil when the script is not resumed, or nothing was saved. Takes the "
            "options of talus.restore. The file lies beside the script: SCRIPT.autosave.talus.",
     .call = module_resumed},
    {.name = NULL},
};
