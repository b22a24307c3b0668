/* fail.c - how the front end raises errors: "file:line: " of the script, then one sentence. */
#include "lua/fail.h"

#include <string.h>

/* Pushes "file:line: " of the nearest Lua code up the stack, so that a call through pcall or a
 * metamethod is placed too. */
void tl_lua_push_where(lua_State *L)
{
    lua_Debug record;
    for (int level = 0; lua_getstack(L, level, &record); level++) {
        lua_getinfo(L, "Sl", &record);
        if (record.currentline > 0) {
            lua_pushfstring(L, "%s:%d: ", record.short_src, record.currentline);
            return;
        }
    }
    lua_pushliteral(L, "");
}

/* Longest sentence, in bytes, and what is kept of its beginning and end: of a name of 100 kB not all is said again. */
#define LONGEST 2000
#define KEPT 900

/* Raises "file:line: " and the sentence, the two texts on the top of the stack. Line ends in names are shown escaped,
 * long names cut. */
static int raise_sentence(lua_State *L)
{
    const size_t length = lua_rawlen(L, -1);
    if (length > LONGEST) {
        lua_pushlstring(L, lua_tostring(L, -1), KEPT);
        lua_pushliteral(L, " ... ");
        lua_pushstring(L, lua_tostring(L, -3) + length - KEPT);
        lua_concat(L, 3);
        lua_remove(L, -2);
    }
    const char *text = lua_tostring(L, -1);
    if (!tl_text_is_clean(text)) {
        luaL_Buffer buffer;
        size_t size = 4 * strlen(text) + 1; /* most bytes of a byte that is escaped */
        char *line = luaL_buffinitsize(L, &buffer, size);
        strcpy(line, text);
        tl_text_clean(line, size);
        luaL_pushresultsize(&buffer, strlen(line));
        lua_remove(L, -2); /* the text as it was */
    }
    lua_concat(L, 2);
    return lua_error(L);
}

int tl_lua_fail(lua_State *L, const char *format, ...)
{
    luaL_checkstack(L, 8, "too many values");
    tl_lua_push_where(L);
    va_list arguments;
    va_start(arguments, format);
    lua_pushvfstring(L, format, arguments);
    va_end(arguments);
    return raise_sentence(L);
}

int tl_lua_fail_in(lua_State *L, int index, const char *format, ...)
{
    luaL_checkstack(L, 8, "too many values");
    lua_Debug record;
    lua_pushvalue(L, index);
    lua_getinfo(L, ">S", &record);
    if (record.linedefined > 0)
        lua_pushfstring(L, "%s:%d: ", record.short_src, record.linedefined);
    else
        tl_lua_push_where(L); /* of a function in C, the line that led to its call */
    va_list arguments;
    va_start(arguments, format);
    lua_pushvfstring(L, format, arguments);
    va_end(arguments);
    return raise_sentence(L);
}

int tl_lua_raise(lua_State *L, const tl_error *error)
{
    return tl_lua_fail(L, "%s", error->text);
}

void tl_lua_names_add(tl_lua_names *names, const char *name)
{
    if (names->count < TL_LUA_NAMES)
        names->at[names->count++] = name;
}

void tl_lua_names_list(tl_lua_names *names, const char *const *list)
{
    for (; list && *list; list++)
        tl_lua_names_add(names, *list);
}

int tl_lua_unknown(lua_State *L, const char *what, const char *word, const tl_lua_names *names)
{
    const char *nearest = tl_nearest_name(word, names->at, names->count);
    if (nearest)
        return tl_lua_fail(L, "%s '%s'; did you mean '%s'?", what, word, nearest);
    luaL_Buffer list;
    luaL_buffinit(L, &list);
    for (size_t i = 0; i < names->count; i++) {
        luaL_addstring(&list, i ? ", " : "");
        luaL_addstring(&list, names->at[i]);
    }
    luaL_pushresult(&list);
    return tl_lua_fail(L, "%s '%s' (known: %s)", what, word, lua_tostring(L, -1));
}
