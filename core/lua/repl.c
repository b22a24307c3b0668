/* repl.c - the read-eval-print loop, on libedit's line editing. Besides Lua it knows the words help, help TOPIC, exit
 * and quit, as long as no global variable has that name. */
#include "lua/repl.h"

#include "lua/help.h"
#include "lua/interrupt.h"
#include "lua/living.h"
#include "lua/repl_complete.h"

#include <editline/readline.h>
#include <errno.h>
#include <fcntl.h>
#include <lauxlib.h>
#include <limits.h>
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---------------------------------------------------------------- calls ------------------ */

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

/* Prints the message on the top of the stack, and pops it. */
static void report(lua_State *L)
{
    const char *message = lua_tostring(L, -1);
    fflush(stdout);
    fprintf(stderr, "talus: %s\n", message ? message : "an error without a message");
    lua_pop(L, 1);
}

static int call(lua_State *L, int arguments, int results, bool verbose, bool at_prompt)
{
    int base = lua_gettop(L) - arguments;
    lua_pushcfunction(L, verbose ? error_traceback : error_text);
    lua_insert(L, base);
    int status = tl_lua_watch_call(L, arguments, results, base, at_prompt);
    lua_remove(L, base);
    if (status == LUA_OK)
        return EXIT_SUCCESS;
    bool interrupted = tl_lua_interrupted(lua_tostring(L, -1));
    report(L);
    return interrupted ? TL_EXIT_INTERRUPTED : EXIT_FAILURE;
}

int tl_repl_call(lua_State *L, int arguments, int results, bool verbose)
{
    return call(L, arguments, results, verbose, false);
}

/* ---------------------------------------------------------------- words ------------------ */

typedef enum word_kind { WORD_NONE, WORD_DONE, WORD_END } word_kind;

static bool is_global(lua_State *L, const char *name)
{
    lua_pushglobaltable(L);
    lua_pushstring(L, name);
    bool found = lua_rawget(L, -2) != LUA_TNIL;
    lua_pop(L, 2);
    return found;
}

/* Does what the words of the loop say, when the line is made of them. */
static word_kind obey_word(lua_State *L, const char *text)
{
    char word[16] = "", topic[64] = "", more[2] = "";
    int count = sscanf(text, " %15s %63s %1s", word, topic, more);
    const char *at = topic;
    while (tl_scan_is_name(*at))
        at++;
    bool ends = count == 1 && (strcmp(word, "exit") == 0 || strcmp(word, "quit") == 0);
    bool helps = strcmp(word, "help") == 0 && (count == 1 || (count == 2 && !*at));
    if ((!ends && !helps) || is_global(L, word))
        return WORD_NONE;
    tl_error error;
    if (helps && !tl_lua_help(count == 2 ? topic : NULL, &error))
        fprintf(stderr, "talus: %s\n", error.text);
    fflush(stdout);
    return ends ? WORD_END : WORD_DONE;
}

/* ---------------------------------------------------------------- lines of before ---------
 *
 * The lines typed at the prompt are in $XDG_STATE_HOME/talus/history, or ~/.local/state/talus/history.
 *
 * A line is appended when it is typed, so that sessions side by side lose nothing of each other. A file with more than
 * twice MOST lines is cut to the last MOST when a session begins. Only the user can read it. Whatever fails, the prompt
 * goes on without the file. */

#define MOST 1000 /* lines that are kept */

static struct {
    char path[PATH_MAX];
    char *last; /* line, from malloc */
    bool quiet, open;
} history;

static void give_up(const char *why)
{
    history.open = false;
    if (!history.quiet)
        fprintf(stderr, "talus: what is typed is not kept: %s: %s\n", history.path, why);
}

/* Makes the folders of the path; those that are there stay as they are. */
static bool make_folders(void)
{
    for (char *slash = strchr(history.path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        int failed = mkdir(history.path, 0700) != 0 && errno != EEXIST ? errno : 0;
        *slash = '/';
        if (failed) {
            give_up(strerror(failed));
            return false;
        }
    }
    return true;
}

/* A descriptor of the file, or -1 after a remark. A pipe in its place must not let the program wait. */
static int open_file(int flags)
{
    struct stat about;
    int file = open(history.path, flags | O_NONBLOCK | O_CLOEXEC, 0600);
    if (file < 0) {
        give_up(strerror(errno));
        return -1;
    }
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) {
        give_up("it is not a regular file");
        close(file);
        return -1;
    }
    return file;
}

/* Writes the last MOST lines into a file beside it, which then takes its place. */
static void cut_file(FILE *stream, size_t lines)
{
    char beside[PATH_MAX + 8];
    snprintf(beside, sizeof beside, "%s.tmp", history.path);
    int file = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0)
        return; /* another session cuts it */
    FILE *out = fdopen(file, "w");
    if (!out) {
        close(file);
        unlink(beside);
        return;
    }
    rewind(stream);
    for (int c; lines > MOST && (c = getc(stream)) != EOF;)
        lines -= c == '\n';
    for (int c; (c = getc(stream)) != EOF;)
        putc(c, out);
    bool good = !ferror(stream) && !ferror(out);
    good = fclose(out) == 0 && good;
    if (!good || rename(beside, history.path) != 0)
        unlink(beside);
}

static void read_file(void)
{
    int file = open_file(O_RDWR | O_CREAT);
    FILE *stream = file < 0 ? NULL : fdopen(file, "r");
    if (!stream) {
        if (file >= 0)
            close(file);
        return;
    }
    char *text = NULL;
    size_t size = 0, lines = 0;
    ssize_t length;
    while ((length = getline(&text, &size, stream)) > 0) {
        text[strcspn(text, "\n")] = 0;
        if (text[0])
            add_history(text);
        lines++;
    }
    free(text);
    if (lines > 2 * (size_t)MOST)
        cut_file(stream, lines);
    fclose(stream);
}

/* Reads what was typed before. When the file cannot be used, a remark says why, unless `quiet`, and nothing is kept. */
static void repl_history_open(bool quiet)
{
    const char *state = getenv("XDG_STATE_HOME"), *home = getenv("HOME");
    history.quiet = quiet;
    using_history();
    stifle_history(MOST);
    int length = 0;
    if (state && state[0] == '/') /* a relative one is to be ignored */
        length = snprintf(history.path, sizeof history.path, "%s/talus/history", state);
    else if (home && home[0] == '/')
        length = snprintf(history.path, sizeof history.path, "%s/.local/state/talus/history", home);
    history.open = length > 0 && (size_t)length < sizeof history.path;
    if (history.open && make_folders())
        read_file();
}

/* Adds a line, to the file as well. */
static void repl_history_add(const char *text)
{
    size_t length = strlen(text);
    if (length == 0 || (history.last && strcmp(history.last, text) == 0))
        return;
    add_history(text);
    char *copy = malloc(length + 2);
    if (!copy)
        return;
    memcpy(copy, text, length + 1);
    free(history.last);
    history.last = copy;
    int file = history.open ? open_file(O_WRONLY | O_APPEND | O_CREAT) : -1;
    if (file < 0)
        return;
    copy[length] = '\n'; /* in one call, so that lines of two sessions do not mix */
    if (write(file, copy, length + 1) != (ssize_t)length + 1)
        give_up("it cannot be written");
    copy[length] = 0;
    close(file);
}

/* ---------------------------------------------------------------- the loop --------------- */

typedef enum line_end { LINE_READ, LINE_STOPPED, LINE_END_OF_INPUT } line_end;

static struct {
    char *text; /* of the line, from malloc, or NULL at the end of input */
    bool done;
    volatile sig_atomic_t stopped;
} line;

static void on_line(char *text)
{
    line.text = text;
    line.done = true;
}

static void on_stop(int signal_number)
{
    (void)signal_number;
    line.stopped = 1;
}

/* Feeds what is typed to the editor until the line is there, input ends or Ctrl-C is pressed. Ctrl-C is let through
 * only while nothing is done. */
static void edit_line(const sigset_t *waiting)
{
    while (!line.done && !line.stopped) {
        fd_set input;
        FD_ZERO(&input);
        FD_SET(STDIN_FILENO, &input);
        if (pselect(STDIN_FILENO + 1, &input, NULL, NULL, NULL, waiting) > 0) {
            int bytes = 0;
            /* a terminal that has gone can be read, but gives nothing */
            if (ioctl(STDIN_FILENO, FIONREAD, &bytes) != 0 || bytes == 0)
                line.done = true;
            else
                rl_callback_read_char();
        } else if (errno != EINTR)
            line.done = true;
    }
}

/* Pushes a line read from the terminal, if one was. After Ctrl-C the line is dropped. */
static line_end read_line(lua_State *L, const char *prompt)
{
    sigset_t interrupt, before;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    sigprocmask(SIG_BLOCK, &interrupt, &before);
    struct sigaction action = {.sa_handler = on_stop}, action_before;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, &action_before);
    line.text = NULL;
    line.done = false;
    line.stopped = 0;
    rl_callback_handler_install(prompt, on_line);
    edit_line(&before);
    rl_callback_handler_remove();
    sigaction(SIGINT, &action_before, NULL);
    sigprocmask(SIG_SETMASK, &before, NULL);
    if (!line.done)
        putchar('\n');
    if (!line.text)
        return line.done ? LINE_END_OF_INPUT : LINE_STOPPED;
    repl_history_add(line.text);
    lua_pushstring(L, line.text);
    free(line.text);
    return LINE_READ;
}

/* True when the error on the top of the stack says that the chunk goes on in the next line. */
static bool is_incomplete(lua_State *L)
{
    static const char mark[] = "<eof>";
    size_t length;
    const char *message = lua_tolstring(L, -1, &length);
    return length >= sizeof mark - 1 && strcmp(message + length - (sizeof mark - 1), mark) == 0;
}

/* Compiles the text at index `text`, as an expression, so that `return` may be left out, or as it is. Leaves the
 * function or the error; `more` tells whether the chunk goes on in the next line. */
static int load_chunk(lua_State *L, int text, bool *more)
{
    const char *chunk = lua_pushfstring(L, "return %s", lua_tostring(L, text));
    int status = luaL_loadbuffer(L, chunk, strlen(chunk), "=stdin");
    lua_remove(L, -2);
    *more = false;
    if (status == LUA_OK)
        return status;
    *more = status == LUA_ERRSYNTAX && is_incomplete(L);
    lua_pop(L, 1);
    size_t length;
    chunk = lua_tolstring(L, text, &length);
    status = luaL_loadbuffer(L, chunk, length, "=stdin");
    *more = status == LUA_ERRSYNTAX && (*more || is_incomplete(L));
    return status;
}

/* ---------------------------------------------------------------- chunks ----------------- */

/* Reads one chunk of as many lines as it takes. Leaves its function on the stack, or the error; `status` is that of the
 * loading. */
static line_end read_chunk(lua_State *L, int *status)
{
    lua_settop(L, 0);
    line_end end = read_line(L, "> ");
    *status = LUA_OK;
    if (end != LINE_READ)
        return end;
    word_kind word = obey_word(L, lua_tostring(L, 1));
    if (word != WORD_NONE)
        return word == WORD_END ? LINE_END_OF_INPUT : LINE_STOPPED;
    bool more;
    while (*status = load_chunk(L, 1, &more), more) {
        lua_settop(L, 1);
        tl_repl_complete(L, lua_tostring(L, 1));
        end = read_line(L, ">> ");
        tl_repl_complete(L, NULL);
        if (end != LINE_READ)
            return end;
        lua_pushliteral(L, "\n");
        lua_insert(L, 2);
        lua_concat(L, 3);
    }
    return LINE_READ;
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
    line_end end;
    /* So that letters beyond ASCII can be typed; numbers stay as they are. */
    setlocale(LC_CTYPE, "");
    repl_history_open(tl_lua_options_of(L)->quiet);
    tl_repl_complete(L, NULL);
    while ((end = read_chunk(L, &status)) != LINE_END_OF_INPUT) {
        if (end == LINE_STOPPED)
            continue;
        lua_remove(L, 1);
        if (status != LUA_OK)
            report(L);
        else if (call(L, 0, LUA_MULTRET, verbose, true) == EXIT_SUCCESS && lua_gettop(L) > 0) {
            lua_pushcfunction(L, print_all);
            lua_insert(L, 1);
            call(L, lua_gettop(L) - 1, 0, verbose, false);
        }
    }
    lua_settop(L, 0);
    putchar('\n');
}
