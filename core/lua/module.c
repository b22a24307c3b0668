/* module.c - the module `talus`: what require "talus" gives, in the program and in a stock Lua. */
#include "lua/block.h"
#include "lua/contact.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/front.h"
#include "lua/help.h"
#include "lua/item.h"
#include "lua/library.h"
#include "lua/lists.h"
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

/* Puts the functions of a kind into the table at the top of the stack. */
static void put_functions(lua_State *L, tl_lua_of of)
{
    const tl_lua_topic *topic;
    for (size_t i = 0; (topic = tl_lua_topic_at(i)) != NULL; i++) {
        if (topic->of != of)
            continue;
        lua_pushcfunction(L, topic->call);
        lua_setfield(L, -2, topic->name);
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
    put_functions(L, TL_LUA_OF_MODEL);
    tl_lua_model_open(L);
    lua_setfield(L, -2, "model");
    put_functions(L, TL_LUA_OF_MODULE);
    tl_lua_lists_open(L);
    lua_pushcfunction(L, module_help);
    lua_setfield(L, -2, "help");
    lua_pushliteral(L, TALUS_VERSION);
    lua_setfield(L, -2, "version");
    tl_lua_library_attach(L);
    return 1;
}
