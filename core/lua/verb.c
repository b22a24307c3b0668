/* verb.c - what all verbs of selections of blocks share: whom they act on, and how they end. */
#include "front.h"

/* Lets go of the functions of drives that have ended. */
static void sweep_drives(lua_State *L, int model_index)
{
    lua_getiuservalue(L, model_index, 1);
    for (lua_pushnil(L); lua_next(L, -2);) {
        const tl_lua_anchor *a = lua_touserdata(L, -1);
        lua_pop(L, 1);
        if (a->ended) {
            lua_pushnil(L);
            lua_rawsetp(L, -3, a);
        }
    }
    lua_pop(L, 1);
}

tl_lua_selection *tl_lua_blocks_self(lua_State *L, int most, const char *method)
{
    tl_lua_selection *blocks = tl_lua_selection_of(L, TL_LUA_BLOCKS, "blocks", method);
    tl_lua_living(L, blocks->owner);
    tl_lua_arity(L, most, method);
    lua_settop(L, most);
    return blocks;
}

/* Says once for each place in a script that a verb had nothing to act on. */
static void remark_empty(lua_State *L, const char *verb, const char *done)
{
    luaL_getsubtable(L, LUA_REGISTRYINDEX, "talus.remarks");
    tl_lua_push_where(L);
    lua_pushfstring(L,
                    "%s: the selection is empty: no block was %s; see what model:blocks{...} finds",
                    verb, done);
    lua_concat(L, 2);
    lua_pushvalue(L, -1);
    if (lua_rawget(L, -3) == LUA_TNIL) {
        tl_lua_log(tl_lua_options_of(L), lua_tostring(L, -2));
        lua_pushvalue(L, -2);
        lua_pushboolean(L, true);
        lua_rawset(L, -5);
    }
    lua_pop(L, 3);
}

int tl_lua_blocks_acted(lua_State *L, const tl_lua_selection *blocks, const char *verb,
                        const char *done, tl_status status)
{
    if (blocks->count == 0 && status == TL_OK)
        remark_empty(L, verb, done);
    return tl_lua_blocks_done(L, blocks, status);
}

int tl_lua_blocks_done(lua_State *L, const tl_lua_selection *blocks, tl_status status)
{
    tl_lua_ok(L, blocks->owner->model, status);
    lua_getiuservalue(L, 1, 1);
    sweep_drives(L, lua_gettop(L)); /* the verb may have ended a drive */
    lua_settop(L, 1);
    return 1;
}
