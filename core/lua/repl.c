/* repl.c - the read-eval-print loop, on libedit's line editing. */
#include "repl.h"

#include <editline/readline.h>
#include <lauxlib.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- calls ------------------ */

/* The state Ctrl-C is meant for; a signal handler has no other way to know it. */
static lua_State *interrupted_state;

static void raise_interrupt(lua_State *L, lua_Debug *record)
{
    lua_sethook(L, NULL, 0, 0);
    lua_getinfo(L, "Sl", record);
    lua_pushfstring(L, "%s:%d: stopped by Ctrl-C", record->short_src, record->currentline);
    lua_error(L);
}

/* Outside a run of the kernel, Ctrl-C raises an error at the next Lua instruction; once more and
 * the program ends. */
static void on_interrupt(int signal_number)
{
    struct sigaction standard = {.sa_handler = SIG_DFL};
    sigemptyset(&standard.sa_mask);
    sigaction(signal_number, &standard, NULL);
    lua_sethook(interrupted_state, raise_interrupt,
                LUA_MASKCALL | LUA_MASKRET | LUA_MASKLINE | LUA_MASKCOUNT, 1);
}

/* Turns an error object into text. */
static int error_text(lua_State *L)
{
    if (lua_type(L, 1) != LUA_TSTRING && !luaL_callmeta(L, 1, "__tostring"))
        lua_pushfstring(L, "(an error that is a %s)", luaL_typename(L, 1));
    else if (lua_type(L, 1) == LUA_TSTRING)
        lua_pushvalue(L, 1);
    return 1;
}

static int error_traceback(lua_State *L)
{
    error_text(L);
    luaL_traceback(L, L, lua_tostring(L, -1), 1);
    return 1;
}

void tl_repl_report(lua_State *L)
{
    const char *message = lua_tostring(L, -1);
    fflush(stdout);
    fprintf(stderr, "talus: %s\n", message ? message : "an error without a message");
    lua_pop(L, 1);
}

bool tl_repl_call(lua_State *L, int arguments, int results, bool verbose)
{
    int base = lua_gettop(L) - arguments;
    lua_pushcfunction(L, verbose ? error_traceback : error_text);
    lua_insert(L, base);
    struct sigaction action = {.sa_handler = on_interrupt}, before;
    sigemptyset(&action.sa_mask);
    interrupted_state = L;
    sigaction(SIGINT, &action, &before);
    int status = lua_pcall(L, arguments, results, base);
    sigaction(SIGINT, &before, NULL);
    lua_remove(L, base);
    if (status != LUA_OK)
        tl_repl_report(L);
    return status == LUA_OK;
}

/* ---------------------------------------------------------------- the loop --------------- */

/* Pushes a line read from the terminal; false at the end of input. */
static bool read_line(lua_State *L, const char *prompt)
{
    char *line = readline(prompt);
    if (!line)
        return false;
    if (line[0])
        add_history(line);
    lua_pushstring(L, line);
    free(line);
    return true;
}

/* Compiles the text at index `text` as an expression, so that `return` may be left out. */
static bool load_expression(lua_State *L, int text)
{
    const char *chunk = lua_pushfstring(L, "return %s", lua_tostring(L, text));
    bool good = luaL_loadbuffer(L, chunk, strlen(chunk), "=stdin") == LUA_OK;
    lua_remove(L, -2);
    if (!good)
        lua_pop(L, 1);
    return good;
}

/* True when the error on the top of the stack says that the chunk goes on in the next line. */
static bool is_incomplete(lua_State *L)
{
    static const char mark[] = "<eof>";
    size_t length;
    const char *message = lua_tolstring(L, -1, &length);
    return length >= sizeof mark - 1 && strcmp(message + length - (sizeof mark - 1), mark) == 0;
}

/* Reads one chunk of as many lines as it takes and leaves its function on the stack, or the error.
 * LUA_OK, an error status, or -1 at the end of input. */
static int read_chunk(lua_State *L)
{
    lua_settop(L, 0);
    if (!read_line(L, "> "))
        return -1;
    if (load_expression(L, 1))
        return LUA_OK;
    for (;;) {
        size_t length;
        const char *text = lua_tolstring(L, 1, &length);
        int status = luaL_loadbuffer(L, text, length, "=stdin");
        if (status != LUA_ERRSYNTAX || !is_incomplete(L))
            return status;
        lua_pop(L, 1);
        if (!read_line(L, ">> "))
            return -1;
        lua_pushliteral(L, "\n");
        lua_insert(L, 2);
        lua_concat(L, 3);
    }
}

/* Prints the value at `index` as it would be written in a script, tables by their address. */
static void print_value(lua_State *L, int index)
{
    const char *quote = lua_type(L, index) == LUA_TSTRING ? "\"" : "";
    printf("%s%s%s", quote, luaL_tolstring(L, index, NULL), quote);
    lua_pop(L, 1);
}

/* Prints a plain table one level deep, its list first: {1.0, 2.0, reason = "ratio"}. */
static void print_table(lua_State *L, int table)
{
    lua_Integer length = (lua_Integer)lua_rawlen(L, table);
    const char *separator = "";
    putchar('{');
    for (lua_Integer i = 1; i <= length; i++, separator = ", ") {
        fputs(separator, stdout);
        lua_rawgeti(L, table, i);
        print_value(L, lua_gettop(L));
        lua_pop(L, 1);
    }
    for (lua_pushnil(L); lua_next(L, table); lua_pop(L, 1)) {
        int key = lua_gettop(L) - 1;
        if (lua_isinteger(L, key) && lua_tointeger(L, key) >= 1 && lua_tointeger(L, key) <= length)
            continue;
        printf("%s%s = ", separator, luaL_tolstring(L, key, NULL));
        lua_pop(L, 1);
        print_value(L, key + 1);
        separator = ", ";
    }
    putchar('}');
}

/* Prints all its arguments on a line; called protected, because a __tostring may raise. */
static int print_all(lua_State *L)
{
    int count = lua_gettop(L);
    luaL_checkstack(L, LUA_MINSTACK, "too many values");
    for (int i = 1; i <= count; i++) {
        fputs(i > 1 ? "\t" : "", stdout);
        if (lua_istable(L, i) && !lua_getmetatable(L, i))
            print_table(L, i);
        else {
            lua_settop(L, count);
            printf("%s", luaL_tolstring(L, i, NULL));
            lua_pop(L, 1);
        }
    }
    putchar('\n');
    fflush(stdout);
    return 0;
}

void tl_repl_run(lua_State *L, bool verbose)
{
    int status;
    while ((status = read_chunk(L)) != -1) {
        lua_remove(L, 1);
        if (status != LUA_OK)
            tl_repl_report(L);
        else if (tl_repl_call(L, 0, LUA_MULTRET, verbose) && lua_gettop(L) > 0) {
            lua_pushcfunction(L, print_all);
            lua_insert(L, 1);
            tl_repl_call(L, lua_gettop(L) - 1, 0, verbose);
        }
    }
    lua_settop(L, 0);
    putchar('\n');
}
