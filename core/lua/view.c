/* view.c - model:view{...}: a model that is seen, and worked on, while it runs.
 *
 * Frames are shown after steps, commands are done between two steps, and a run that is paused waits there. What is done
 * is a line of Lua, which is logged: on standard error, on the page and, with `log`, in a file. In front of each line
 * stand the steps made since the line before, so the lines one after the other repeat the work.
 *
 * What goes wrong in a command is told to those who look, and ends nothing. */
#include "lua/view.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/interrupt.h"
#include "lua/living.h"
#include "lua/page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Constant: how long the program waits for a command before it looks whether somebody has pressed Ctrl-C, s. */
#define PATIENCE 0.2
/* Chunk name of commands, which is in front of their errors. */
#define CHUNK "view"

static const tl_lua_key view_keys[] = {
    TL_LUA_PAGE_KEYS,
    {"wait", "true or false",
     "whether view waits, and does what is asked for on the page, until \"go\" is pressed there"},
    {"prefix", "text in quotes",
     "folder and name with which files begin that are written from the page; view when left out"},
    {"log", "text in quotes", "a file for the lines that repeat the work on the page"},
    {NULL, NULL, NULL},
};

/* What another call may give again. */
static const tl_lua_key again_keys[] = {
    TL_LUA_PAGE_KEYS,
    {"wait", "", ""},
    {NULL, NULL, NULL},
};

typedef struct tl_lua_viewing {
    tl_view *view;
    char *prefix;
    FILE *log;
    int64_t logged;     /* cycle up to which the log repeats the run */
    int64_t steps;      /* left to make of those that were asked for */
    bool paused, waits; /* in a run; in model:view */
    bool commanded;     /* a line was logged */
    tl_view_state told;
} viewing;

static viewing *view_of(lua_State *L)
{
    return ((tl_lua_model *)lua_touserdata(L, TL_LUA_AT_MODEL))->view;
}

static tl_model *model_of(lua_State *L)
{
    return ((tl_lua_model *)lua_touserdata(L, TL_LUA_AT_MODEL))->model;
}

/* ---------------------------------------------------------------- what is told ----------- */

static void tell(lua_State *L, viewing *v, const char *line, const char *refused)
{
    if (tl_view_tell(v->view, v->told, line, refused) != TL_OK)
        tl_lua_log(tl_lua_options_of(L), tl_model_error(model_of(L))->text);
}

static void tell_state(lua_State *L, viewing *v, tl_view_state state)
{
    if (v->told == state)
        return;
    v->told = state;
    tell(L, v, NULL, NULL);
}

/* Tells a line that was done. */
static void log_line(lua_State *L, viewing *v, const char *line)
{
    tl_lua_log(tl_lua_options_of(L), lua_pushfstring(L, "view: %s", line));
    lua_pop(L, 1);
    v->commanded = true;
    tell(L, v, line, NULL);
    if (v->log && (fprintf(v->log, "%s\n", line) < 0 || fflush(v->log) != 0)) {
        tl_lua_log(tl_lua_options_of(L), "view: the log cannot be written any more");
        fclose(v->log);
        v->log = NULL;
    }
}

/* Tells the steps that were made since the last line. */
static void log_steps(lua_State *L, viewing *v)
{
    char line[64];
    int64_t cycles = tl_model_cycles(model_of(L)), made = cycles - v->logged;
    v->logged = cycles;
    if (made <= 0)
        return;
    snprintf(line, sizeof line, "model:cycle(%lld)", (long long)made);
    log_line(L, v, line);
}

/* Tells why the command was not done: the error on the top of the stack, which it pops. */
static void tell_refused(lua_State *L, viewing *v)
{
    static const char place[] = CHUNK ":1: ";
    char sentence[TL_ERROR_TEXT];
    const char *text = luaL_tolstring(L, -1, NULL);
    if (strncmp(text, place, sizeof place - 1) == 0)
        text += sizeof place - 1;
    snprintf(sentence, sizeof sentence, "%s", text);
    for (char *c = sentence; *c; c++) /* names in it may be anything, and a terminal shows it */
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?';
    tl_lua_log(tl_lua_options_of(L), lua_pushfstring(L, "view: not done: %s", sentence));
    tell(L, v, NULL, sentence);
    lua_pop(L, 3);
}

/* ---------------------------------------------------------------- frames ----------------- */

/* Runs protected, with the model. */
static int show(lua_State *L)
{
    tl_html html = tl_html_default();
    lua_settop(L, TL_LUA_AT_MODEL);
    lua_getiuservalue(L, TL_LUA_AT_MODEL, TL_LUA_VIEW);
    tl_lua_page_read(L, 2, "view", &html);
    tl_lua_ok(L, model_of(L), tl_view_show(view_of(L)->view, &html));
    return 0;
}

bool tl_lua_view_step(lua_State *L, double worth)
{
    viewing *v = view_of(L);
    if (!v || !tl_view_due(v->view, worth))
        return true;
    lua_pushcfunction(L, show);
    lua_pushvalue(L, TL_LUA_AT_MODEL);
    if (lua_pcall(L, 1, 0, 0) == LUA_OK)
        return true;
    bool asks = lua_getiuservalue(L, TL_LUA_AT_MODEL, TL_LUA_VIEW) != LUA_TNIL;
    lua_pop(L, 1);
    if (!asks || (lua_type(L, -1) == LUA_TSTRING && tl_lua_interrupted(lua_tostring(L, -1))))
        return false;
    tell_refused(L, v); /* a run is worth more than its fields: it goes on without them */
    lua_pushnil(L);
    lua_setiuservalue(L, TL_LUA_AT_MODEL, TL_LUA_VIEW);
    return true;
}

/* ---------------------------------------------------------------- commands as lines of Lua ---
 *
 * Commands of those who look at a model, as lines of Lua: what is done is what is logged, so a log repeats it.
 *
 * Numbers have the digits that give back the same double. */

/* Digits of a number at least. */
#define DIGITS 6

/* The following push a piece of a line. A number: */
static const char *number(lua_State *L, double value)
{
    char text[TL_LUA_NUMBER];
    return lua_pushstring(L, tl_lua_number_text(value, DIGITS, text));
}

/* A text in quotes, with what could end it or its line as numbers. */
static const char *quoted(lua_State *L, const char *text)
{
    luaL_Buffer piece;
    luaL_buffinit(L, &piece);
    luaL_addchar(&piece, '"');
    for (; *text; text++) {
        char code[8];
        unsigned char letter = (unsigned char)*text;
        bool control = letter < ' ' || letter == 127;
        if (letter == '"' || letter == '\\')
            luaL_addchar(&piece, '\\');
        snprintf(code, sizeof code, control ? "\\%03u" : "%c", letter);
        luaL_addstring(&piece, code);
    }
    luaL_addchar(&piece, '"');
    luaL_pushresult(&piece);
    return lua_tostring(L, -1);
}

/* { 3, 5 } */
static const char *list(lua_State *L, const double *values, size_t count)
{
    char text[TL_LUA_NUMBER];
    luaL_Buffer piece;
    luaL_buffinit(L, &piece);
    for (size_t i = 0; i < count; i++) {
        luaL_addstring(&piece, i ? ", " : "{ ");
        luaL_addstring(&piece, tl_lua_number_text(values[i], DIGITS, text));
    }
    luaL_addstring(&piece, " }");
    luaL_pushresult(&piece);
    return lua_tostring(L, -1);
}

/* Whether a block of the command is hidden: a selection then has to ask for it. */
static bool any_hidden(tl_model *model, const tl_view_command *command)
{
    bool hidden = false;
    for (size_t i = 0; i < command->block_count && !hidden; i++) {
        tl_block_filter filter = tl_block_filter_default();
        tl_id *found;
        size_t count;
        filter.id = command->blocks[i];
        filter.hidden = 1;
        if (tl_blocks_select(model, &filter, &found, &count) != TL_OK)
            break;
        hidden = count > 0;
        free(found);
    }
    return hidden;
}

/* model:blocks { id = { 3, 5 } }:VERB() */
static void push_verb_line(lua_State *L, tl_model *model, const tl_view_command *command)
{
    const char *verb = tl_view_op_name(command->op);
    double ids[TL_VIEW_BLOCKS];
    for (size_t i = 0; i < command->block_count; i++)
        ids[i] = command->blocks[i];
    if (command->block_count == 0)
        lua_pushfstring(L, "model:blocks { hidden = true }:%s()", verb);
    else
        lua_pushfstring(L, "model:blocks { id = %s%s }:%s()",
                        command->block_count == 1 ? number(L, ids[0]) : list(L, ids, command->block_count),
                        any_hidden(model, command) ? ", hidden = \"any\"" : "", verb);
}

/* Pushes the line that does the command, or an expression that gives its answer; not of pause, go or step. Raises when
 * a block is not there. */
static void push_line(lua_State *L, tl_model *model, const tl_view_command *command, const char *prefix)
{
    for (size_t i = 0; i < command->block_count; i++)
        if (tl_block_check(model, command->blocks[i]) != TL_OK) {
            lua_pushfstring(L, "%s: %s", tl_view_op_name(command->op), tl_model_error(model)->text);
            lua_error(L);
        }
    const double origin[] = {command->origin.x, command->origin.y, command->origin.z};
    char cycle[32];
    snprintf(cycle, sizeof cycle, "_%09lld.talus", (long long)tl_model_cycles(model));
    switch (command->op) {
    case TL_VIEW_CUT:
        lua_pushfstring(L, "model:generate(\"joint\", { joint = %s, dip = %s, dip_direction = %s, origin = %s })",
                        quoted(L, command->joint), number(L, command->dip), number(L, command->dip_direction),
                        list(L, origin, 3));
        break;
    case TL_VIEW_FRICTION:
        lua_pushfstring(L, "model:joint(%s, { friction = %s })", quoted(L, command->joint), number(L, command->value));
        break;
    case TL_VIEW_VTK: lua_pushfstring(L, "model:write_vtk(%s)", quoted(L, prefix)); break;
    case TL_VIEW_SNAPSHOT:
        lua_pushfstring(L, "model:save(%s)", quoted(L, lua_pushfstring(L, "%s%s", prefix, cycle)));
        break;
    case TL_VIEW_SAFETY: lua_pushliteral(L, "model:factor_of_safety {}"); break;
    default: push_verb_line(L, model, command);
    }
}

/* ---------------------------------------------------------------- commands --------------- */

/* Limit: blocks that a finding names. */
#define NAMED 256

/* Adds to the line at the top of the stack what a search for a factor of safety has found, below it, as a comment. */
static void add_finding(lua_State *L)
{
    const int result = lua_gettop(L) - 1;
    luaL_Buffer line;
    lua_getfield(L, result, "message");
    lua_getfield(L, result, "failing");
    lua_pushfstring(L, "%s -- %s", lua_tostring(L, result + 1), lua_tostring(L, -2));
    const lua_Integer count = luaL_len(L, -2);
    luaL_buffinit(L, &line);
    for (lua_Integer i = 1; i <= count && i <= NAMED; i++) {
        lua_geti(L, result + 3, i);
        lua_getfield(L, -1, "id");
        lua_pushfstring(L, i > 1 ? ", %I" : "; blocks %I", lua_tointeger(L, -1));
        lua_copy(L, -1, -3);
        lua_pop(L, 2);
        luaL_addvalue(&line);
    }
    luaL_pushresult(&line);
    lua_concat(L, 2);
}

/* Runs protected: finds the line of a command, does it and gives it. Arguments: the model, the command. */
static int do_line(lua_State *L)
{
    const bool finds = ((const tl_view_command *)lua_touserdata(L, 2))->op == TL_VIEW_SAFETY;
    push_line(L, model_of(L), lua_touserdata(L, 2), view_of(L)->prefix);
    int line = lua_gettop(L);
    const char *text = lua_pushfstring(L, "local model = ... %s%s", finds ? "return " : "", lua_tostring(L, line));
    if (luaL_loadbuffer(L, text, strlen(text), "=" CHUNK) != LUA_OK)
        return lua_error(L);
    lua_pushvalue(L, TL_LUA_AT_MODEL);
    lua_call(L, 1, finds);
    if (finds) {
        lua_pushvalue(L, line);
        add_finding(L);
        return 1;
    }
    lua_settop(L, line);
    return 1;
}

/* Runs protected: makes the steps that a command asks for while view waits. */
static int do_steps(lua_State *L)
{
    lua_getfield(L, TL_LUA_AT_MODEL, "cycle");
    lua_pushvalue(L, TL_LUA_AT_MODEL);
    lua_pushinteger(L, (lua_Integer)((const tl_view_command *)lua_touserdata(L, 2))->steps);
    lua_call(L, 2, 0);
    return 0;
}

/* Calls a function with the model and the command. What it gives is then on the top of the stack, or its error. */
static bool call(lua_State *L, lua_CFunction function, const tl_view_command *command, int results)
{
    lua_pushcfunction(L, function);
    lua_pushvalue(L, TL_LUA_AT_MODEL);
    lua_pushlightuserdata(L, (void *)(uintptr_t)command);
    return lua_pcall(L, 2, results, 0) == LUA_OK;
}

/* Makes steps while view waits: a run, in which a pause is a pause. */
static bool make_steps(lua_State *L, viewing *v, const tl_view_command *command)
{
    v->waits = false;
    tell_state(L, v, TL_VIEW_RUNNING);
    bool made = call(L, do_steps, command, 0);
    v->commanded = true; /* the log tells these steps, too */
    v->waits = true;
    v->paused = false;
    return made;
}

/* Does the line of a command, and tells it. */
static bool do_and_log(lua_State *L, viewing *v, const tl_view_command *command)
{
    log_steps(L, v);
    if (!call(L, do_line, command, 1))
        return false;
    log_line(L, v, lua_tostring(L, -1));
    lua_pop(L, 1);
    return true;
}

/* Does a command, or tells why it is not done. False after a Ctrl-C, with its error on the top of the stack. */
static bool do_command(lua_State *L, viewing *v, const tl_view_command *command)
{
    bool done = true;
    if (command->op == TL_VIEW_PAUSE || (command->op == TL_VIEW_STEP && !v->waits)) {
        v->paused = !v->waits;
        v->steps = command->steps;
    } else if (command->op == TL_VIEW_GO) {
        v->paused = v->waits = false;
    } else {
        done = command->op == TL_VIEW_STEP ? make_steps(L, v, command) : do_and_log(L, v, command);
    }
    if (done)
        return true;
    if (lua_type(L, -1) == LUA_TSTRING && tl_lua_interrupted(lua_tostring(L, -1)))
        return false;
    tell_refused(L, v);
    return true;
}

/* Does commands while there are any, or as long as the model waits: in a run until it may go on. False, with the error
 * on the top of the stack, after a Ctrl-C, or when a frame cannot be shown. */
static bool serve(lua_State *L, viewing *v)
{
    double patience = 0;
    for (;;) {
        tl_view_command command;
        while (tl_view_take(v->view, patience, &command)) {
            if (!do_command(L, v, &command))
                return false;
            patience = 0;
        }
        if ((v->paused && v->steps > 0) || !(v->paused || v->waits) || tl_lua_interrupt_asked())
            break;
        tell_state(L, v, v->waits ? TL_VIEW_WAITING : TL_VIEW_PAUSED);
        if (!tl_lua_view_step(L, INFINITY))
            return false;
        patience = PATIENCE;
    }
    if (tl_lua_interrupt_asked())
        v->paused = false; /* the run ends, and the next one is not to wait */
    tell_state(L, v, TL_VIEW_RUNNING);
    return true;
}

bool tl_lua_view_between(lua_State *L)
{
    viewing *v = view_of(L);
    if (!v)
        return true;
    if (!serve(L, v))
        return false;
    if (v->paused && v->steps > 0)
        v->steps--;
    return true;
}

void tl_lua_view_end(lua_State *L, tl_lua_model *owner)
{
    viewing *v = owner->view;
    if (!v)
        return;
    if (v->view && v->commanded)
        log_steps(L, v);
    owner->view = NULL;
    tl_view_close(v->view);
    if (v->log)
        fclose(v->log);
    free(v->prefix);
    free(v);
}

/* ---------------------------------------------------------------- model:view ------------- */

/* Reads a key of the table at index 2 that is a text; NULL when it is left out. The text lives as long as the table. */
static const char *read_text(lua_State *L, const char *key)
{
    const char *text = tl_lua_option(L, 2, key) == LUA_TNIL ? NULL : tl_lua_text(L, -1, "view", key);
    if (text && !text[0])
        tl_lua_fail(L, "view: %s must not be empty", key);
    lua_settop(L, 2);
    return text;
}

static bool read_wait(lua_State *L)
{
    int type = tl_lua_option(L, 2, "wait");
    bool wait = type == LUA_TBOOLEAN && lua_toboolean(L, -1);
    if (type != LUA_TNIL && type != LUA_TBOOLEAN)
        tl_lua_fail(L, "view: wait must be true or false, not %s", tl_lua_describe(L, -1));
    lua_settop(L, 2);
    return wait;
}

/* Opens the log; raises when it cannot be written. */
static FILE *open_log(lua_State *L, const char *path)
{
    tl_error error;
    static const char head[] = "-- Work on a model that was seen while it ran: loadfile(THIS)(model) repeats it.\n"
                               "local model = ...\n";
    if (tl_write_file(path, head, sizeof head - 1, &error) != TL_OK) /* makes the folders */
        tl_lua_fail(L, "view: log: %s", error.text);
    FILE *log = fopen(path, "a");
    if (!log)
        tl_lua_fail(L, "view: log: cannot write '%s'", path);
    return log;
}

/* Refuses what the first call alone decides. */
static void refuse_again(lua_State *L, const viewing *v)
{
    tl_args given;
    tl_lua_args(L, 2, "view", again_keys, &given);
    if (given.count > 0)
        tl_lua_fail(L, "view: the model is shown already, at %s; %s is chosen with the first call",
                    tl_view_address(v->view), given.values[0].key);
    lua_settop(L, 2);
}

/* Pushes the keys that a call may have: those of view, and the parameters of the screen. */
static const tl_lua_key *push_keys(lua_State *L, const tl_kind *screen)
{
    size_t own = sizeof view_keys / sizeof view_keys[0] - 1, more = screen ? screen->param_count : 0;
    tl_lua_key *keys = lua_newuserdatauv(L, (own + more + 1) * sizeof *keys, 0);
    memcpy(keys, view_keys, own * sizeof *keys);
    for (size_t i = 0; i < more; i++)
        keys[own + i] = (tl_lua_key){screen->params[i].name, "", ""};
    keys[own + more] = (tl_lua_key){NULL, NULL, NULL};
    return keys;
}

/* Reads what of the table at index 2 is a parameter of the screen; pushes what must stay. */
static void read_params(lua_State *L, const tl_kind *screen, tl_args *params)
{
    tl_lua_args(L, 2, "view", NULL, params);
    tl_value *values = (tl_value *)(uintptr_t)params->values; /* on the stack, and ours */
    size_t kept = 0;
    for (size_t i = 0; i < params->count; i++)
        for (uint32_t k = 0; screen && k < screen->param_count; k++)
            if (strcmp(values[i].key, screen->params[k].name) == 0)
                values[kept++] = values[i];
    params->count = kept;
}

/* Begins to show the model at index 1 as the table at index 2 says. */
static void open_view(lua_State *L, tl_lua_model *owner, const tl_view_options *options)
{
    tl_args params;
    const tl_kind *screen = tl_plugin_kind(TL_KIND_SCREEN, 0);
    const char *prefix = read_text(L, "prefix"), *log = read_text(L, "log");
    read_params(L, screen, &params);
    viewing *v = calloc(1, sizeof *v);
    owner->view = v; /* from here on it goes with the model */
    if (!v || !(v->prefix = strdup(prefix ? prefix : "view")))
        tl_lua_fail(L, "view: out of memory");
    v->logged = tl_model_cycles(owner->model);
    tl_lua_ok(L, owner->model, tl_view_open(owner->model, screen, &params, options, &v->view));
    if (log)
        v->log = open_log(L, log);
    tell(L, v, NULL, NULL);
}

/* Runs protected, with the model, the table and the options: opens the view, and shows the first frame. */
static int begin(lua_State *L)
{
    open_view(L, lua_touserdata(L, TL_LUA_AT_MODEL), lua_touserdata(L, 3));
    return show(L);
}

static void wait_for_go(lua_State *L, viewing *v)
{
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_lua_log(tl_lua_options_of(L), "view: waiting for \"go\" on the page");
    v->waits = true;
    bool shown = serve(L, v);
    v->waits = v->paused = false;
    if (v->commanded)
        log_steps(L, v);
    tl_lua_watch_end(L, &watch, TL_E_CANCELLED, "view", "");
    if (!shown)
        lua_error(L);
}

static int model_view(lua_State *L, tl_model *model)
{
    (void)model;
    tl_lua_model *owner = lua_touserdata(L, TL_LUA_AT_MODEL);
    tl_view_options options = tl_view_options_default();
    tl_lua_spec spec = tl_lua_spec_of("view", push_keys(L, tl_plugin_kind(TL_KIND_SCREEN, 0)));
    tl_lua_read(L, 2, &spec, false, &options); /* texts stay with the table */
    lua_settop(L, 2);
    bool wait = read_wait(L), again = owner->view != NULL;
    if (again)
        refuse_again(L, owner->view);
    lua_getiuservalue(L, TL_LUA_AT_MODEL, TL_LUA_VIEW);
    lua_pushvalue(L, 2);
    lua_setiuservalue(L, TL_LUA_AT_MODEL, TL_LUA_VIEW);
    lua_pushcfunction(L, again ? show : begin);
    lua_pushvalue(L, TL_LUA_AT_MODEL);
    lua_pushvalue(L, 2);
    lua_pushlightuserdata(L, &options);
    if (lua_pcall(L, 3, 0, 0) != LUA_OK) {
        lua_pushvalue(L, 3); /* a call that fails changes nothing */
        lua_setiuservalue(L, TL_LUA_AT_MODEL, TL_LUA_VIEW);
        if (!again)
            tl_lua_view_end(L, owner);
        return lua_error(L);
    }
    lua_pushstring(L, tl_view_address(owner->view->view));
    if (!again) {
        lua_pushfstring(L, "view: open %s in a browser", lua_tostring(L, -1));
        tl_lua_log(tl_lua_options_of(L), lua_tostring(L, -1));
        lua_pop(L, 1);
    }
    if (wait)
        wait_for_go(L, owner->view);
    return 1;
}

const tl_lua_topic tl_lua_view_topics[] = {
    {.name = "view",
     .usage = "address = model:view{title = \"Slope\"}",
     .function = "view",
     .keys = view_keys,
     .has_type = true,
     .type = TL_KIND_SCREEN,
     .arguments = 1,
     .method = model_view},
    {.name = NULL},
};
