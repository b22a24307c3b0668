/* history_again.c - histories of a copied or restored model: their functions, and whether a file asks for what there is. */
#include "history.h"

#include <string.h>

void tl_lua_histories_share(lua_State *L, int from, int to)
{
    lua_getiuservalue(L, from, TL_LUA_HISTORIES);
    int functions = lua_gettop(L);
    lua_getiuservalue(L, to, TL_LUA_HISTORIES);
    for (lua_pushnil(L); lua_next(L, functions);) {
        lua_pushvalue(L, -2);
        lua_rotate(L, -2, 1);
        lua_rawset(L, functions + 1);
    }
    lua_settop(L, functions - 1);
}

void tl_lua_histories_given(lua_State *L)
{
    int top = lua_gettop(L);
    if (!lua_istable(L, 2) || lua_getfield(L, 2, "histories") == LUA_TNIL) {
        lua_settop(L, top);
        return;
    }
    if (!lua_istable(L, -1))
        tl_lua_fail(L, "talus.restore: histories must be a table of functions by name, not %s",
                    tl_lua_describe(L, -1));
    for (lua_pushnil(L); lua_next(L, top + 1); lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            tl_lua_fail(L,
                        "talus.restore: histories has the key %s, which is the name of no history",
                        tl_lua_describe(L, -2));
        if (!lua_isfunction(L, -1) && !(lua_isboolean(L, -1) && !lua_toboolean(L, -1)))
            tl_lua_fail(L, "talus.restore: history '%s' needs a function(model), or false, not %s",
                        lua_tostring(L, -2), tl_lua_describe(L, -1));
    }
    lua_settop(L, top);
}

/* Whether there is what a history of the model, blocks or contacts asks for, of as many numbers as its samples have. */
static bool is_there(lua_State *L, const tl_history *h)
{
    size_t index = 0, width = 1;
    if (h->source == TL_FROM_MODEL) {
        const char *known;
        while ((known = tl_history_quantity(index)) != NULL && strcmp(known, h->asked) != 0)
            index++;
        return known && !h->list && h->count && h->width == width;
    }
    const tl_field *field = tl_history_field(L, h, &index);
    bool vector = field && field->kind == TL_FIELD_VEC3;
    width = vector ? 3 : 1;
    return field && !(vector && h->take >= TL_TAKE_MIN) && h->list == vector && h->count &&
           h->width == width;
}

/* Looks for what is given for a history, in the table at `given` or nil, and leaves it on the stack: a function, or false. */
static bool find_given(lua_State *L, int given, const char *name)
{
    if (lua_istable(L, given))
        lua_getfield(L, given, name);
    else
        lua_pushnil(L);
    return !lua_isnil(L, -1);
}

/* Takes up history `i`, or ends it; true: it is still there. */
static bool take_up(lua_State *L, const char *path, int model_index, int given, size_t i)
{
    tl_model *model = ((tl_lua_model *)lua_touserdata(L, model_index))->model;
    const tl_history *h = tl_history_at(model, i);
    bool found = find_given(L, given, h->name);
    if (found && !lua_toboolean(L, -1)) {
        tl_history_end(model, i);
        lua_pop(L, 1);
        return false;
    }
    if (found && h->source != TL_FROM_FUNCTION)
        tl_lua_fail(L, "talus.restore: history '%s' sampled no function when the model was saved",
                    h->name);
    if (!found && h->source == TL_FROM_FUNCTION)
        tl_lua_fail(L,
                    "cannot restore '%s': history '%s' samples a function, which has to be given "
                    "again: histories = {[\"%s\"] = function(model) ... end}, or false to end it",
                    path, h->name, h->name);
    if (h->source == TL_FROM_FUNCTION)
        tl_history_set_function(L, model_index, h->name);
    else if (!is_there(L, h))
        tl_lua_fail(L, "cannot restore '%s': history '%s' asks for '%s', which cannot be sampled",
                    path, h->name, h->asked);
    else
        lua_pop(L, 1);
    return true;
}

void tl_lua_histories_again(lua_State *L, const char *path, int model_index)
{
    tl_model *model = ((tl_lua_model *)lua_touserdata(L, model_index))->model;
    int top = lua_gettop(L), given = top + 1;
    if (lua_istable(L, 2))
        lua_getfield(L, 2, "histories");
    else
        lua_pushnil(L);
    if (lua_istable(L, given))
        for (lua_pushnil(L); lua_next(L, given); lua_pop(L, 1))
            if (!tl_history_at(model, tl_history_find(model, lua_tostring(L, -2))))
                tl_lua_fail(L, "talus.restore: there was no history '%s' when the model was saved",
                            lua_tostring(L, -2));
    for (size_t i = 0; tl_history_at(model, i);)
        i += take_up(L, path, model_index, given, i);
    lua_settop(L, top);
}
