/* main.c - the program `talus`: options, sub-commands, and a Lua state to run scripts in. */
#include "commands.h"
#include "lua/fail.h"
#include "lua/front.h"
#include "lua/help.h"
#include "lua/library.h"
#include "lua/living.h"
#include "lua/repl.h"
#include "lua/run.h"

#include <errno.h>
#include <limits.h>
#include <lualib.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>
#include <unistd.h>

#ifndef TALUS_BUILD
#define TALUS_BUILD "unknown build type"
#endif

#ifdef __clang__
#define COMPILER __VERSION__
#else
#define COMPILER "gcc " __VERSION__
#endif

typedef struct options {
    tl_lua_options lua;
    bool verbose;
    const char *chunk; /* of -e */
    int next;          /* first argument that is not an option */
} options;

/* At the end of the program, however it comes: that not all could be printed, to a full disk say, is an error. */
static void close_output(void)
{
    bool lost = ferror(stdout) != 0;
    errno = 0;
    bool failed = fflush(stdout) != 0 || lost;
    int code = errno;
    if (fclose(stdout) != 0 && errno != EBADF) { /* EBADF: it was closed before the program began */
        failed = true;
        code = errno;
    }
    if (!failed)
        return;
    tl_command_fail("not all that was printed could be written to the standard output%s%s", code ? ": " : "",
                    code ? strerror(code) : "");
    _exit(EXIT_FAILURE);
}

static int exit_of(bool success)
{
    return success ? EXIT_SUCCESS : EXIT_FAILURE;
}

static int print_version(void)
{
    printf("Talus %s\nplugin interface %u.%u\n%s\ncompiler: %s\nbuild: %s\n", TALUS_VERSION, TL_ABI_MAJOR, TL_ABI_MINOR,
           LUA_RELEASE, COMPILER, TALUS_BUILD);
    return EXIT_SUCCESS;
}

/* ---------------------------------------------------------------- options ---------------- */

static bool read_threads(const char *text, int64_t *threads)
{
    char *end;
    errno = 0;
    long number = strtol(text, &end, 10);
    if (errno || end == text || *end || number < 1 || number > 256)
        return tl_command_fail("--threads: '%s' is not a whole number in [1, 256]", text);
    *threads = number;
    return true;
}

/* Minutes as seconds. */
static bool read_minutes(const char *text, double *seconds)
{
    const char *end;
    double minutes = tl_number_read(text, &end);
    if (end == text || *end || !(minutes > 0 && minutes <= 1e6))
        return tl_command_fail("--autosave: '%s' is not a number of minutes in (0, 1e6]", text);
    *seconds = 60 * minutes;
    return true;
}

/* All that are found; false after a message. */
static bool load_plugins(void)
{
    if (tl_plugins_load_default() == TL_OK)
        return true;
    return tl_command_fail("out of memory while the plugins are loaded");
}

/* A whole number of the environment, or -1. */
static int64_t number_of(const char *name)
{
    const char *text = name ? getenv(name) : NULL;
    char *end;
    errno = 0;
    const long long number = text && text[0] ? strtoll(text, &end, 10) : -1;
    return !text || !text[0] || errno || *end || number < 0 ? -1 : (int64_t)number;
}

/* What batch systems and MPI tell a process: its number, how many there are, and the number of the first. */
static const struct batch {
    const char *rank, *count, *first;
} batches[] = {{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN"},
               {"SLURM_PROCID", "SLURM_NTASKS", NULL},
               {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", NULL},
               {"PMI_RANK", "PMI_SIZE", NULL}};

static bool shard_auto(tl_lua_options *lua)
{
    for (size_t i = 0; i < sizeof batches / sizeof *batches; i++) {
        const int64_t rank = number_of(batches[i].rank), count = number_of(batches[i].count);
        const int64_t first = number_of(batches[i].first), step = i == 0 ? number_of("SLURM_ARRAY_TASK_STEP") : 1;
        if (rank < 0 || count < 1)
            continue;
        lua->shard = (rank - (first > 0 ? first : 0)) / (step > 0 ? step : 1) + 1;
        lua->shards = count;
        if (lua->shard >= 1 && lua->shard <= count)
            return true;
        return tl_command_fail("--shard auto: %s = %lld is no process of %lld", batches[i].rank, (long long)rank,
                               (long long)count);
    }
    return tl_command_fail("%s", "--shard auto: neither SLURM_ARRAY_TASK_ID and _COUNT, SLURM_PROCID and SLURM_NTASKS, "
                                 "OMPI_COMM_WORLD_RANK and _SIZE nor PMI_RANK and PMI_SIZE are set");
}

/* --shard i/n or auto */
static bool read_shard(const char *text, tl_lua_options *lua)
{
    if (strcmp(text, "auto") == 0)
        return shard_auto(lua);
    char *end;
    errno = 0;
    const long long shard = strtoll(text, &end, 10);
    const bool begun = end != text && *end == '/';
    const char *rest = begun ? end + 1 : end;
    const long long shards = begun ? strtoll(rest, &end, 10) : 0;
    if (errno || !begun || end == rest || *end || shard < 1 || shard > shards || shards > 1000000)
        return tl_command_fail("--shard: '%s' is neither auto nor i/n with 1 <= i <= n <= 1000000", text);
    lua->shard = shard;
    lua->shards = shards;
    return true;
}

static bool load_plugin(const char *path)
{
    tl_error error;
    if (!load_plugins())
        return false;
    if (tl_plugin_load(path, &error) == TL_OK)
        return true;
    return tl_command_fail("%s", error.text);
}

static bool unknown_option(const char *word)
{
    static const char *const known[] = {"--threads", "--quiet", "--plugin",   "--version", "--help",
                                        "-v",        "-e",      "--autosave", "--resume",  "--shard"};
    const char *nearest = tl_nearest_name(word, known, sizeof known / sizeof known[0]);
    if (nearest)
        return tl_command_fail("unknown option '%s'; did you mean '%s'?", word, nearest);
    return tl_command_fail("unknown option '%s'; `talus help` lists them", word);
}

/* Reads the option at argv[o->next] and goes past it; false after a message. */
static bool read_option(int argc, char **argv, options *o)
{
    const char *word = argv[o->next++];
    bool takes_value = strcmp(word, "--threads") == 0 || strcmp(word, "--plugin") == 0 || strcmp(word, "-e") == 0 ||
                       strcmp(word, "--autosave") == 0 || strcmp(word, "--shard") == 0;
    if (strcmp(word, "--quiet") == 0)
        o->lua.quiet = true;
    else if (strcmp(word, "--resume") == 0)
        o->lua.resume = true;
    else if (strcmp(word, "-v") == 0)
        o->verbose = true;
    else if (!takes_value)
        return unknown_option(word);
    else if (o->next == argc)
        return tl_command_fail("the option %s needs a value", word);
    else if (strcmp(word, "--threads") == 0)
        return read_threads(argv[o->next++], &o->lua.threads);
    else if (strcmp(word, "--autosave") == 0)
        return read_minutes(argv[o->next++], &o->lua.autosave);
    else if (strcmp(word, "--shard") == 0)
        return read_shard(argv[o->next++], &o->lua);
    else if (strcmp(word, "--plugin") == 0)
        return load_plugin(argv[o->next++]);
    else
        o->chunk = argv[o->next++];
    return true;
}

/* ---------------------------------------------------------------- misspelt globals --------
 *
 * Reading a global variable that was never assigned raises, with the nearest known name:
 * a typing error would otherwise be a silent nil. Assigning declares, even nil. */

/* Names a typing error may have meant: the caller's local variables, then the globals. */
static void known_names(lua_State *L, tl_lua_names *names)
{
    lua_Debug caller;
    if (lua_getstack(L, 1, &caller)) {
        const char *name;
        for (int i = 1; (name = lua_getlocal(L, &caller, i)) != NULL; i++) {
            if (name[0] != '(')
                tl_lua_names_add(names, name);
            lua_pop(L, 1);
        }
    }
    lua_pushglobaltable(L);
    for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING)
            tl_lua_names_add(names, lua_tostring(L, -2));
    lua_pop(L, 1);
}

/* Upvalue 1 is the set of names that were assigned. */
static int global_read(lua_State *L)
{
    lua_settop(L, 2);
    if (lua_type(L, 2) != LUA_TSTRING)
        return 0;
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL)
        return 0;
    const char *word = lua_tostring(L, 2);
    tl_lua_names names = {0};
    known_names(L, &names);
    const char *nearest = tl_nearest_name(word, names.at, names.count);
    if (nearest)
        return tl_lua_fail(L, "the variable '%s' is not declared; did you mean '%s'?", word, nearest);
    return tl_lua_fail(L, "the variable '%s' is not declared", word);
}

static int global_write(lua_State *L)
{
    lua_settop(L, 3);
    lua_pushvalue(L, 2);
    lua_pushboolean(L, 1);
    lua_rawset(L, lua_upvalueindex(1));
    lua_rawset(L, 1);
    return 0;
}

/* From now on reading a global that was never assigned raises. */
static void strict(lua_State *L)
{
    lua_pushglobaltable(L);
    lua_createtable(L, 0, 2);
    lua_newtable(L);
    const luaL_Reg meta[] = {{"__index", global_read}, {"__newindex", global_write}, {NULL, NULL}};
    luaL_setfuncs(L, meta, 1);
    lua_setmetatable(L, -2);
    lua_pop(L, 1);
}

/* ---------------------------------------------------------------- running ---------------- */

/* The global `arg`: the script at 0, its arguments from 1, the program and options below 0. */
static void set_arguments(lua_State *L, int argc, char **argv, int script)
{
    lua_createtable(L, argc - script, script + 1);
    for (int i = 0; i < argc; i++) {
        lua_pushstring(L, argv[i]);
        lua_rawseti(L, -2, i - script);
    }
    lua_setglobal(L, "arg");
}

/* Calls the chunk on the top of the stack with argv[first ...]; gives the exit status. */
static int run_chunk(lua_State *L, int load_status, int argc, char **argv, int first, const options *o)
{
    if (load_status != LUA_OK) { /* the message is raised where errors are told */
        lua_pushcfunction(L, lua_error);
        lua_insert(L, -2);
        return tl_repl_call(L, 1, 0, false);
    }
    int count = first < argc ? argc - first : 0;
    luaL_checkstack(L, count, "too many arguments");
    for (int i = 0; i < count; i++)
        lua_pushstring(L, argv[first + i]);
    return tl_repl_call(L, count, 0, o->verbose);
}

static int run_script(lua_State *L, int argc, char **argv, const options *o)
{
    const char *script = argv[o->next];
    bool standard_input = strcmp(script, "-") == 0;
    if (!standard_input && access(script, R_OK) != 0)
        return exit_of(tl_command_fail("cannot read the script '%s': %s", script, strerror(errno)));
    int status = tl_lua_script_load(L, standard_input ? NULL : script);
    return run_chunk(L, status, argc, argv, o->next + 1, o);
}

/* Everything that may raise for want of memory, in a protected call. */
static int prepare(lua_State *L)
{
    options *o = lua_touserdata(L, 1);
    int argc = (int)lua_tointeger(L, 2);
    char **argv = lua_touserdata(L, 3);
    luaL_openlibs(L);
    luaL_getsubtable(L, LUA_REGISTRYINDEX, LUA_PRELOAD_TABLE);
    lua_pushcfunction(L, luaopen_talus);
    lua_setfield(L, -2, "talus");
    tl_lua_library_open(L);
    *tl_lua_options_of(L) = o->lua;
    set_arguments(L, argc, argv, o->next < argc ? o->next : 0);
    strict(L);
    return 0;
}

/* What is typed at the prompt or after -e has the module at hand without require. A script has not,
 * for it should run in a stock Lua too. */
static int give_module(lua_State *L, const options *o)
{
    int status = luaL_loadstring(L, "talus = require 'talus'");
    return status == LUA_OK ? tl_repl_call(L, 0, 0, o->verbose) : EXIT_FAILURE;
}

/* Gives the exit status. */
static int run(lua_State *L, int argc, char **argv, options *o)
{
    lua_pushcfunction(L, prepare);
    lua_pushlightuserdata(L, o);
    lua_pushinteger(L, argc);
    lua_pushlightuserdata(L, argv);
    int exit_status = tl_repl_call(L, 3, 0, o->verbose);
    if (exit_status != EXIT_SUCCESS)
        return exit_status;
    if (o->chunk) {
        exit_status = give_module(L, o);
        if (exit_status != EXIT_SUCCESS)
            return exit_status;
        int status = luaL_loadbuffer(L, o->chunk, strlen(o->chunk), "=(command line)");
        return run_chunk(L, status, argc, argv, o->next, o);
    }
    if (o->next < argc)
        return run_script(L, argc, argv, o);
    if (!isatty(STDIN_FILENO))
        return run_chunk(L, luaL_loadfile(L, NULL), argc, argv, argc, o);
    exit_status = give_module(L, o);
    if (exit_status != EXIT_SUCCESS)
        return exit_status;
    printf("Talus %s. `help` tells what there is, Tab completes names, `exit` ends.\n", TALUS_VERSION);
    tl_repl_run(L, o->verbose);
    return EXIT_SUCCESS;
}

static int help(const char *topic)
{
    tl_error error;
    if (!load_plugins())
        return EXIT_FAILURE;
    return exit_of(tl_lua_help(topic, &error) || tl_command_fail("%s", error.text));
}

/* Reads the options that come next. false: the program ends, with that status. */
static bool read_options(int argc, char **argv, options *o, int *status)
{
    while (o->next < argc && argv[o->next][0] == '-' && argv[o->next][1]) {
        const char *word = argv[o->next];
        bool version = strcmp(word, "--version") == 0;
        if (version || strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
            *status = version ? print_version() : help(NULL);
            return false;
        }
        *status = EXIT_FAILURE;
        if (!read_option(argc, argv, o))
            return false;
    }
    return true;
}

/* The file of a script's saves, from malloc; NULL when out of memory. */
static char *autosave_path(const char *script)
{
    static const char ending[] = ".autosave.talus";
    size_t capacity = strlen(script) + sizeof ending;
    char *path = malloc(capacity);
    if (path)
        snprintf(path, capacity, "%s%s", script, ending);
    return path;
}

/* `talus run`: saves belong to a script in a file. */
static bool prepare_saves(int argc, char **argv, options *o, bool runs)
{
    bool script = o->next < argc && !o->chunk && strcmp(argv[o->next], "-") != 0;
    if (runs && !script)
        return tl_command_fail("%s", "run: name the script: talus run [--autosave MINUTES] [--resume] [--shard i/n] "
                                     "SCRIPT.lua");
    if (!script && (o->lua.autosave > 0 || o->lua.resume))
        return tl_command_fail("%s", "--autosave and --resume are for a script in a file, beside which it saves");
    if (script && !(o->lua.save_path = autosave_path(argv[o->next])))
        return tl_command_fail("%s", "not enough memory");
    return true;
}

int main(int argc, char **argv)
{
    options o = {.next = 1};
    int status;
    atexit(close_output);
    tl_plugin_name_crashes();
    signal(SIGXFSZ, SIG_IGN); /* a file beyond the limit is told like a full disk */
    if (!read_options(argc, argv, &o, &status))
        return status;
    const char *command = o.next < argc && !o.chunk ? argv[o.next] : "";
    if (strcmp(command, "help") == 0)
        return help(o.next + 1 < argc ? argv[o.next + 1] : NULL);
    if (strcmp(command, "plugins") == 0) {
        if (!load_plugins())
            return EXIT_FAILURE;
        tl_lua_help_plugins();
        return EXIT_SUCCESS;
    }
    if (strcmp(command, "check") == 0)
        return tl_command_check(argc - o.next - 1, argv + o.next + 1);
    if (strcmp(command, "new") == 0)
        return tl_command_new(argc - o.next - 1, argv + o.next + 1);
    char script[PATH_MAX]; /* of a command that is written in Lua */
    if (tl_library_command(command, script, sizeof script) && access(command, F_OK) != 0)
        argv[o.next] = script;
    bool runs = strcmp(command, "run") == 0;
    o.next += runs;
    if (runs && !read_options(argc, argv, &o, &status))
        return status;
    if (!prepare_saves(argc, argv, &o, runs))
        return EXIT_FAILURE;
    lua_State *L = luaL_newstate();
    if (!L)
        return exit_of(tl_command_fail("not enough memory to start Lua"));
    int exit_status = run(L, argc, argv, &o);
    lua_close(L);
    free((char *)(uintptr_t)o.lua.save_path);
    return exit_status;
}
