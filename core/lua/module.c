/* module.c - the module `talus`: what require "talus" gives, in the program and in a stock Lua. */
#include "front.h"

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

int luaopen_talus(lua_State *L)
{
    if (tl_plugins_load_default() != TL_OK)
        return tl_lua_fail(L, "out of memory while the plugins are loaded");
    tl_lua_item_open(L, &tl_lua_block_kind);
    tl_lua_item_open(L, &tl_lua_contact_kind);
    tl_lua_selection_open(L, &tl_lua_block_kind);
    tl_lua_selection_open(L, &tl_lua_contact_kind);
    lua_createtable(L, 0, 5);
    tl_lua_model_open(L);
    lua_setfield(L, -2, "model");
    lua_pushcfunction(L, tl_lua_report);
    lua_setfield(L, -2, "report");
    lua_pushcfunction(L, tl_lua_resumed);
    lua_setfield(L, -2, "resumed");
    lua_pushcfunction(L, tl_lua_restore);
    lua_setfield(L, -2, "restore");
    tl_lua_lists_open(L);
    lua_pushcfunction(L, tl_lua_write_file);
    lua_setfield(L, -2, "write_file");
    lua_pushcfunction(L, tl_lua_law_test);
    lua_setfield(L, -2, "law_test");
    lua_pushcfunction(L, module_help);
    lua_setfield(L, -2, "help");
    lua_pushliteral(L, TALUS_VERSION);
    lua_setfield(L, -2, "version");
    tl_lua_library_attach(L);
    return 1;
}
