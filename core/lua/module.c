/* module.c - the module `talus`: what require "talus" gives, in the program and in a stock Lua. */
#include "lua/block.h"
#include "lua/contact.h"
#include "lua/convert.h"
#include "lua/element.h"
#include "lua/fail.h"
#include "lua/help.h"
#include "lua/item.h"
#include "lua/library.h"
#include "lua/living.h"
#include "lua/model.h"
#include "lua/topics.h"
#include "lua/zones.h"

#include <string.h>

/* talus.help(topic): prints what `talus help TOPIC` prints. */
static int module_help(lua_State *L)
{
    tl_lua_arity(L, 1, "talus.help");
    const char *topic = lua_isnoneornil(L, 1) ? NULL : tl_lua_text(L, 1, "talus.help", "the topic");
    tl_error error;
    if (!tl_lua_help(topic, &error))
        return tl_lua_raise(L, &error);
    return 0;
}

/* Calls a method of models, of the topic that is upvalue 1. */
static int call_method(lua_State *L)
{
    const tl_lua_topic *topic = lua_touserdata(L, lua_upvalueindex(1));
    tl_model *model = tl_lua_model_of(L, topic->name);
    tl_lua_arity(L, topic->arguments + 1, topic->name);
    lua_settop(L, topic->arguments + 1);
    luaL_checkstack(L, 64, "too many values");
    return topic->method(L, model);
}

/* Puts functions into the module below the top of the stack, and methods of models into the table at the top. */
static void put_functions(lua_State *L)
{
    const tl_lua_topic *topic;
    for (size_t i = 0; (topic = tl_lua_topic_at(i)) != NULL; i++) {
        if (topic->method) {
            lua_pushlightuserdata(L, (void *)(uintptr_t)topic);
            lua_pushcclosure(L, call_method, 1);
            lua_setfield(L, -2, topic->name);
        } else if (topic->call) {
            lua_pushcfunction(L, topic->call);
            lua_setfield(L, -3, topic->name);
        }
    }
}

/* ---------------------------------------------------------------- what is loaded ---------- */

static void push_kind(lua_State *L, const tl_kind *kind)
{
    lua_createtable(L, 0, 5);
    tl_lua_set_text(L, "name", kind->name);
    tl_lua_set_text(L, "doc", kind->doc ? kind->doc : "");
    const tl_plugin *plugin = tl_plugin_of(kind, NULL);
    tl_lua_set_text(L, "plugin", plugin ? plugin->id : NULL);
    lua_createtable(L, (int)kind->param_count, 0);
    for (uint32_t i = 0; i < kind->param_count; i++) {
        lua_pushstring(L, kind->params[i].name);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "parameters");
    lua_createtable(L, (int)kind->state_count, 0);
    for (uint32_t i = 0; i < kind->state_count; i++) {
        lua_pushstring(L, kind->states[i].name);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "states");
}

/* The kinds of a type. Upvalue 1 is the type, upvalue 2 the function's name. */
static int module_kinds(lua_State *L)
{
    tl_lua_arity(L, 0, lua_tostring(L, lua_upvalueindex(2)));
    tl_kind_type type = (tl_kind_type)lua_tointeger(L, lua_upvalueindex(1));
    lua_newtable(L);
    const tl_kind *kind;
    for (size_t i = 0; (kind = tl_plugin_kind(type, i)) != NULL; i++) {
        push_kind(L, kind);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

/* Puts talus.laws, talus.dampings and so on into the module at the top of the stack. */
static void put_kinds(lua_State *L)
{
    static const char *const lists[] = {
        [TL_KIND_LAW] = "laws",       [TL_KIND_DAMPING] = "dampings", [TL_KIND_GENERATOR] = "generators",
        [TL_KIND_SCREEN] = "screens", [TL_KIND_SOLID] = "solids",     [TL_KIND_ELEMENT] = "elements"};
    for (size_t type = 0; type < TL_LUA_COUNT(lists); type++) {
        lua_pushinteger(L, (lua_Integer)type);
        lua_pushfstring(L, "talus.%s", lists[type]);
        lua_pushcclosure(L, module_kinds, 2);
        lua_setfield(L, -2, lists[type]);
    }
}

/* ---------------------------------------------------------------- modules in Lua --------- */

/* Modules that the table `talus` holds, each a function; loaded when first used. */
static const char *const functions[] = {"back_analysis", "bolt_pattern", "bolt_test", "convert", "plot",
                                        "poles",         "realisations", "stereonet", NULL};

/* __index of the table `talus`: the modules it holds. Upvalue 1 is `require`. */
static int module_index(lua_State *L)
{
    lua_settop(L, 2);
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    for (const char *const *known = functions; *known; known++) {
        if (strcmp(*known, name) != 0)
            continue;
        lua_pushvalue(L, lua_upvalueindex(1));
        lua_pushfstring(L, "talus.%s", name);
        lua_call(L, 1, 1);
        lua_pushvalue(L, 2);
        lua_pushvalue(L, -2);
        lua_rawset(L, 1);
        return 1;
    }
    return 0;
}

/* Has the table at the top of the stack load them when they are first used. */
static void attach_library(lua_State *L)
{
    tl_lua_library_open(L);
    lua_createtable(L, 0, 1);
    lua_getglobal(L, "require");
    lua_pushcclosure(L, module_index, 1);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, -2);
}

int luaopen_talus(lua_State *L)
{
    if (tl_plugins_load_default() != TL_OK)
        return tl_lua_fail(L, "out of memory while the plugins are loaded");
    tl_lua_kind_open(L, &tl_lua_block_kind);
    tl_lua_kind_open(L, &tl_lua_contact_kind);
    tl_lua_kind_open(L, &tl_lua_zone_kind);
    tl_lua_kind_open(L, &tl_lua_gridpoint_kind);
    tl_lua_kind_open(L, &tl_lua_element_kind);
    lua_createtable(L, 0, 16);
    lua_newtable(L);
    put_functions(L);
    tl_lua_model_open(L);
    lua_setfield(L, -2, "model");
    put_kinds(L);
    lua_pushcfunction(L, module_help);
    lua_setfield(L, -2, "help");
    lua_pushliteral(L, TALUS_VERSION);
    lua_setfield(L, -2, "version");
    attach_library(L);
    return 1;
}
