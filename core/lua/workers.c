/* workers.c - the module talus.workers, for modules of Talus that are written in Lua: processes that call a function
 * with the numbers of jobs, the file to which one process adds rows, which shard this process is, and remarks.
 *
 * A worker is a copy of the Lua state that started it. It says nothing of runs, saves none, and its models have one
 * thread unless the script says otherwise. */
#include "lua/workers.h"

#include "lua/fail.h"
#include "lua/interrupt.h"
#include "lua/living.h"

#include <dirent.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <talus/log_file.h>
#include <talus/workers.h>
#include <unistd.h>

#define WORKERS_TYPE "talus.workers"
#define LOG_TYPE "talus.log"

/* Cost only: seconds after which a Ctrl-C is looked for that came just before a wait. */
#define PATIENCE 0.25

/* ---------------------------------------------------------------- workers ---------------- */

typedef struct crew {
    tl_workers *workers;
    lua_State *L; /* that started or gave a job last: its copy is what a new worker goes on with */
    tl_lua_options *options;
    bool ready;    /* in a worker: the options are those of one */
    bool answered; /* in a worker: an answer is on the stack of L */
} crew;

/* In a worker: calls the function, which the registry keeps under the address of the crew. A function that fails, for
 * want of memory say, ends the worker. */
static void do_job(void *user, uint64_t job, const void **data, size_t *size)
{
    crew *c = user;
    lua_State *L = c->L;
    if (!c->ready) {
        *c->options = (tl_lua_options){.threads = 1, .quiet = true};
        c->ready = true;
    }
    if (c->answered)
        lua_pop(L, 1); /* the answer of the job before */
    else if (!lua_checkstack(L, 4))
        _exit(EXIT_FAILURE);
    c->answered = true;
    lua_rawgetp(L, LUA_REGISTRYINDEX, c);
    lua_pushinteger(L, (lua_Integer)job);
    if (lua_pcall(L, 1, 1, 0) != LUA_OK || lua_type(L, -1) != LUA_TSTRING)
        _exit(EXIT_FAILURE);
    *data = lua_tolstring(L, -1, size);
}

static int end_workers(lua_State *L)
{
    crew *c = luaL_checkudata(L, 1, WORKERS_TYPE);
    tl_workers_end(c->workers);
    c->workers = NULL;
    lua_pushnil(L);
    lua_rawsetp(L, LUA_REGISTRYINDEX, c);
    return 0;
}

static crew *crew_of(lua_State *L)
{
    crew *c = luaL_checkudata(L, 1, WORKERS_TYPE);
    if (!c->workers)
        tl_lua_fail(L, "these workers have ended");
    c->L = L;
    return c;
}

/* start(count, f): f(job) gives a string. Objects that nothing holds any more are collected first: models may have
 * threads. */
static int start_workers(lua_State *L)
{
    tl_error error;
    const lua_Integer count = luaL_checkinteger(L, 1);
    luaL_checktype(L, 2, LUA_TFUNCTION);
    crew *c = lua_newuserdatauv(L, sizeof *c, 0);
    *c = (crew){.L = L, .options = tl_lua_options_of(L)};
    luaL_setmetatable(L, WORKERS_TYPE);
    lua_pushvalue(L, 2);
    lua_rawsetp(L, LUA_REGISTRYINDEX, c);
    lua_gc(L, LUA_GCCOLLECT);
    lua_gc(L, LUA_GCCOLLECT); /* what finalizers have let go */
    if (tl_workers_start((unsigned)count, do_job, c, &c->workers, &error) != TL_OK)
        return tl_lua_fail(L, "%s", error.text);
    return 1;
}

/* workers:give(worker, job), worker from 1. */
static int give_job(lua_State *L)
{
    tl_error error;
    crew *c = crew_of(L);
    if (tl_workers_give(c->workers, (unsigned)luaL_checkinteger(L, 2) - 1, (uint64_t)luaL_checkinteger(L, 3), &error) !=
        TL_OK)
        return tl_lua_fail(L, "%s", error.text);
    return 0;
}

/* workers:take(): worker, job, and the answer; without one the worker has died, and how is told in a sentence. */
static int take_answer(lua_State *L)
{
    tl_error error;
    tl_worker_answer answer = {.worker = UINT_MAX};
    crew *c = crew_of(L);
    while (answer.worker == UINT_MAX) {
        tl_lua_watch watch = tl_lua_watch_begin(L);
        tl_status status = tl_workers_take(c->workers, PATIENCE, &answer, &error);
        if (tl_lua_watch_end(L, &watch, status, "", "") != TL_OK)
            return tl_lua_fail(L, "%s", error.text);
    }
    lua_pushinteger(L, (lua_Integer)answer.worker + 1);
    lua_pushinteger(L, (lua_Integer)answer.job);
    if (answer.data) {
        lua_pushlstring(L, answer.data, answer.size);
        return 3;
    }
    lua_pushnil(L);
    if (answer.signal)
        lua_pushfstring(L, "it was ended by signal %d", answer.signal);
    else
        lua_pushfstring(L, "it ended with status %d", answer.code);
    return 4;
}

/* ---------------------------------------------------------------- files of rows ---------- */

static tl_log_file **log_of(lua_State *L)
{
    return luaL_checkudata(L, 1, LOG_TYPE);
}

static int close_log(lua_State *L)
{
    tl_log_file **file = log_of(L);
    tl_log_close(*file);
    *file = NULL;
    return 0;
}

/* log(path) */
static int open_log(lua_State *L)
{
    tl_error error;
    const char *path = luaL_checkstring(L, 1);
    tl_log_file **file = lua_newuserdatauv(L, sizeof(tl_log_file *), 0);
    *file = NULL;
    luaL_setmetatable(L, LOG_TYPE);
    if (tl_log_open(path, file, &error) != TL_OK)
        return tl_lua_fail(L, "%s", error.text);
    return 1;
}

static int free_bytes(lua_State *L)
{
    char **bytes = lua_touserdata(L, 1);
    free(*bytes);
    *bytes = NULL;
    return 0;
}

/* file:read(): all of it. */
static int read_log(lua_State *L)
{
    tl_error error;
    tl_log_file *file = *log_of(L);
    char **bytes = tl_lua_hold(L, sizeof *bytes, "talus.bytes", free_bytes);
    size_t size;
    if (tl_log_read(file, bytes, &size, &error) != TL_OK)
        return tl_lua_fail(L, "%s", error.text);
    lua_pushlstring(L, *bytes, size);
    free(*bytes);
    *bytes = NULL;
    return 1;
}

/* file:cut(bytes) */
static int cut_log(lua_State *L)
{
    tl_error error;
    if (tl_log_cut(*log_of(L), (uint64_t)luaL_checkinteger(L, 2), &error) != TL_OK)
        return tl_lua_fail(L, "%s", error.text);
    return 0;
}

/* file:add(text) */
static int add_to_log(lua_State *L)
{
    tl_error error;
    size_t size;
    const char *text = luaL_checklstring(L, 2, &size);
    if (tl_log_add(*log_of(L), text, size, &error) != TL_OK)
        return tl_lua_fail(L, "%s", error.text);
    return 0;
}

/* ---------------------------------------------------------------- shards ----------------- */

static int close_folder(lua_State *L)
{
    DIR **folder = lua_touserdata(L, 1);
    if (*folder)
        closedir(*folder);
    *folder = NULL;
    return 0;
}

/* names(folder): the names in it, sorted by nothing; none where it cannot be read. */
static int names(lua_State *L)
{
    const char *path = luaL_checkstring(L, 1);
    DIR **folder = tl_lua_hold(L, sizeof *folder, "talus.folder", close_folder);
    lua_newtable(L);
    *folder = opendir(path);
    lua_Integer count = 0;
    for (struct dirent *entry; *folder && (entry = readdir(*folder));) {
        lua_pushstring(L, entry->d_name);
        lua_rawseti(L, -2, ++count);
    }
    return 1;
}

/* shard(): number and count of the shard that this process is, or nil. */
static int shard(lua_State *L)
{
    const tl_lua_options *options = tl_lua_options_of(L);
    if (options->shards == 0)
        return 0;
    lua_pushinteger(L, options->shard);
    lua_pushinteger(L, options->shards);
    return 2;
}

/* remark(text): a line on the standard error, of a process that is not quiet. */
static int remark(lua_State *L)
{
    tl_lua_log(tl_lua_options_of(L), luaL_checkstring(L, 1));
    return 0;
}

static void make_type(lua_State *L, const char *name, const luaL_Reg *methods, lua_CFunction release)
{
    if (luaL_newmetatable(L, name)) {
        lua_newtable(L);
        luaL_setfuncs(L, methods, 0);
        lua_setfield(L, -2, "__index");
        lua_pushcfunction(L, release);
        lua_setfield(L, -2, "__gc");
        lua_pushcfunction(L, release);
        lua_setfield(L, -2, "__close");
    }
    lua_pop(L, 1);
}

int tl_lua_workers_open(lua_State *L)
{
    static const luaL_Reg of_workers[] = {{"give", give_job}, {"take", take_answer}, {NULL, NULL}};
    static const luaL_Reg of_logs[] = {{"read", read_log}, {"cut", cut_log}, {"add", add_to_log}, {NULL, NULL}};
    static const luaL_Reg functions[] = {{"start", start_workers}, {"log", open_log},  {"names", names},
                                         {"shard", shard},         {"remark", remark}, {NULL, NULL}};
    make_type(L, WORKERS_TYPE, of_workers, end_workers);
    make_type(L, LOG_TYPE, of_logs, close_log);
    luaL_newlib(L, functions);
    return 1;
}
