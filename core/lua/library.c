/* library.c - the modules of Talus that are written in Lua (scripts/lib/talus), and files for them.
 *
 * `require "talus.plot"` finds them beside the program or the library talus.so, wherever these lie. A searcher of its
 * own comes before the search path of scripts, so the modules are of the same Talus. Where talus.so has not
 * been loaded yet, Lua's search for C modules loads it for its function luaopen_talus_NAME. */
#include "lua/library.h"

#include "lua/convert.h"
#include "lua/fail.h"

#include <limits.h>
#include <string.h>

#define PREFIX "talus."

/* Pushes the loader of a module and its path; or one sentence why there is none, and returns 1. */
static int push_loader(lua_State *L, const char *name)
{
    char file[128], path[PATH_MAX];
    size_t length = strlen(name);
    if (length + sizeof ".lua" > sizeof file || strspn(name, "abcdefghijklmnopqrstuvwxyz_.") != length)
        return 0;
    strcpy(file, name);
    for (char *c = file; *c; c++)
        *c = *c == '.' ? '/' : *c;
    strcat(file, ".lua");
    tl_error error;
    if (tl_library_find(file, path, sizeof path, &error) != TL_OK) {
        lua_pushstring(L, error.text);
        return 1;
    }
    if (luaL_loadfilex(L, path, "t") != LUA_OK)
        return lua_error(L);
    lua_pushstring(L, path);
    return 2;
}

/* One of package.searchers. */
static int search(lua_State *L)
{
    const char *name = luaL_checkstring(L, 1);
    return strncmp(name, PREFIX, sizeof PREFIX - 1) == 0 ? push_loader(L, name) : 0;
}

/* What luaopen_talus_NAME does. */
static int open_module(lua_State *L, const char *name)
{
    tl_lua_library_open(L);
    if (push_loader(L, name) != 2)
        return tl_lua_fail(L, "%s", lua_tostring(L, -1));
    lua_pushstring(L, name);
    lua_insert(L, -2);
    lua_call(L, 2, 1);
    return 1;
}

TL_API int luaopen_talus_plot(lua_State *L);
TL_API int luaopen_talus_stereonet(lua_State *L);

int luaopen_talus_plot(lua_State *L)
{
    return open_module(L, PREFIX "plot");
}

int luaopen_talus_stereonet(lua_State *L)
{
    return open_module(L, PREFIX "stereonet");
}

void tl_lua_library_open(lua_State *L)
{
    static const char key; /* its address is where the registry keeps that it is done */
    bool done = lua_rawgetp(L, LUA_REGISTRYINDEX, &key) != LUA_TNIL;
    lua_pop(L, 1);
    if (done || lua_getglobal(L, "package") != LUA_TTABLE) {
        lua_settop(L, done ? lua_gettop(L) : lua_gettop(L) - 1);
        return;
    }
    if (lua_getfield(L, -1, "searchers") == LUA_TTABLE) {
        for (lua_Integer i = (lua_Integer)lua_rawlen(L, -1); i >= 2; i--) {
            lua_rawgeti(L, -1, i);
            lua_rawseti(L, -2, i + 1);
        }
        lua_pushcfunction(L, search);
        lua_rawseti(L, -2, 2); /* after package.preload */
        lua_pushboolean(L, true);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &key);
    }
    lua_pop(L, 2);
}

static int module_write_file(lua_State *L)
{
    tl_lua_arity(L, 2, "talus.write_file");
    const char *path = tl_lua_text(L, 1, "talus.write_file", "the file's name");
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "talus.write_file: the text must be a string, not %s", tl_lua_describe(L, 2));
    size_t length;
    const char *text = lua_tolstring(L, 2, &length);
    tl_error error;
    if (tl_write_file(path, text, length, &error) != TL_OK)
        return tl_lua_fail(L, "talus.write_file: %s", error.text);
    return 0;
}

/* ---------------------------------------------------------------- help ------------------- */

static const tl_lua_key plot_keys[] = {
    {"file", "text in quotes, required", "name of the SVG file; folders are made"},
    {"series", "list of {x =, y =, name =, style =, colour =}",
     "lines: lists of numbers x (1, 2, 3, ... when left out) and y; style is \"line\", \"points\" "
     "or \"both\", colour \"#0072b2\". Numbers that are not finite make a gap. Or {history =, "
     "component =, against =, name =}: history is one of model:histories(), component \"x\", "
     "\"y\", \"z\" or a number (all when left out), against \"time\" or \"cycle\""},
    {"model", "model", "draws histories of this model"},
    {"histories", "list of names", "which of them, in this order; all when left out"},
    {"x_axis, y_axis", "text or {name =, unit =, log =, range =}",
     "name and unit of the axis; log = true is a logarithmic one, which leaves out numbers not "
     "above 0; range = {from, to} when left out takes in all"},
    {"title", "text in quotes, may be left out", "stands above the picture"},
    {"legend", "true or false",
     "whether a list of the lines stands beside; left out: when there are several, or names"},
    {"grid", "true or false, default true", "whether ticks have lines across"},
    {"width, height", "number, default 720 and 440", "of the picture, pixels"},
    {NULL, NULL, NULL},
};

static const tl_lua_key stereonet_keys[] = {
    {"file", "text in quotes, required", "name of the SVG file; folders are made"},
    {"model", "model", "draws the joint sets of this model, from the faces of its blocks as they lie now"},
    {"joints", "list of names", "which of its joint sets (\"J1\"), in this order; all when left out"},
    {"sets", "list of {name =, dip =, dip_direction =}",
     "further sets, degrees; or {name =, planes = {{dip, dip_direction}, ...}} for several planes"},
    {"keyblocks", "list of keyblocks", "what model:keyblocks{...} gave: a cross for the direction of each movement"},
    {"projection", "\"equal_area\" or \"equal_angle\"", "of Schmidt and Lambert, the default, or of Wulff"},
    {"great_circles", "\"mean\", \"all\" or \"none\"",
     "of the mean plane of each set, the default, of every plane, or of none"},
    {"title", "text in quotes, may be left out", "stands above the picture"},
    {"legend", "true or false, default true", "whether a list of the sets stands beside, with mean dip/dip direction"},
    {"grid", "true or false, default true",
     "whether plunges of 30 and 60 degrees and every 30 degrees of trend are drawn"},
    {"size", "number, default 480", "of the square picture without the legend, pixels"},
    {NULL, NULL, NULL},
};

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

void tl_lua_strict(lua_State *L)
{
    lua_pushglobaltable(L);
    lua_createtable(L, 0, 2);
    lua_newtable(L);
    const luaL_Reg meta[] = {{"__index", global_read}, {"__newindex", global_write}, {NULL, NULL}};
    luaL_setfuncs(L, meta, 1);
    lua_setmetatable(L, -2);
    lua_pop(L, 1);
}

const tl_lua_topic tl_lua_library_topics[] = {
    {.name = "plot",
     .usage = "talus.plot{file = \"out/run.svg\", model = model, histories = {\"roof\"}, y_axis = "
              "{name = \"subsidence\", unit = \"m\"}}",
     .doc = "Draws lists and histories as lines, with axes, ticks and a legend, into an SVG file.",
     .keys = plot_keys},
    {.name = "stereonet",
     .usage = "talus.stereonet{file = \"out/joints.svg\", model = model, keyblocks = "
              "model:keyblocks{friction = 30}}",
     .doc = "Draws joint sets by poles and great circles on the lower hemisphere, into an SVG file.",
     .keys = stereonet_keys},
    {.name = "write_file",
     .usage = "talus.write_file(\"out/table.csv\", text)",
     .doc = "Writes a text into a file, whole or not at all. Folders are made; only a regular file "
            "is replaced.",
     .call = module_write_file},
    {.name = NULL},
};
