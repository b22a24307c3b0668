/* strict.c - reading a global variable that was never assigned raises, with the nearest known name:
 * a typing error would otherwise be a silent nil. Assigning declares, even nil. */
#include "front.h"

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
        return tl_lua_fail(L, "the variable '%s' is not declared; did you mean '%s'?", word,
                           nearest);
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
    lua_pushvalue(L, -1);
    lua_pushcclosure(L, global_read, 1);
    lua_setfield(L, -3, "__index");
    lua_pushcclosure(L, global_write, 1);
    lua_setfield(L, -2, "__newindex");
    lua_setmetatable(L, -2);
    lua_pop(L, 1);
}
