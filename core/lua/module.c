/* module.c - the module `talus`: what require "talus" gives, in the program and in a stock Lua. */
#include "lua/block.h"
#include "lua/contact.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/help.h"
#include "lua/item.h"
#include "lua/library.h"
#include "lua/lists.h"
#include "lua/living.h"
#include "lua/model.h"
#include "lua/selection.h"
#include "lua/topics.h"

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

int luaopen_talus(lua_State *L)
{
    if (tl_plugins_load_default() != TL_OK)
        return tl_lua_fail(L, "out of memory while the plugins are loaded");
    tl_lua_item_open(L, &tl_lua_block_kind);
    tl_lua_item_open(L, &tl_lua_contact_kind);
    tl_lua_selection_open(L, &tl_lua_block_kind);
    tl_lua_selection_open(L, &tl_lua_contact_kind);
    lua_createtable(L, 0, 16);
    lua_newtable(L);
    put_functions(L);
    tl_lua_model_open(L);
    lua_setfield(L, -2, "model");
    tl_lua_lists_open(L);
    lua_pushcfunction(L, module_help);
    lua_setfield(L, -2, "help");
    lua_pushliteral(L, TALUS_VERSION);
    lua_setfield(L, -2, "version");
    tl_lua_library_attach(L);
    return 1;
}
