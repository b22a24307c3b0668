/* item.c - one block or one contact as a Lua object: fields by name, equality, text.
 *
 * An item is no pointer into the kernel but a number that is looked up at every access. So one that
 * was deleted raises and never crashes. */
#include "lua/item.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <string.h>

/* The item at index 1 of a metamethod, whose upvalue 1 is the kind. */
static tl_lua_item *self(lua_State *L)
{
    const tl_lua_kind *kind = lua_touserdata(L, lua_upvalueindex(1));
    tl_lua_item *item = luaL_testudata(L, 1, kind->item_type);
    if (!item)
        tl_lua_fail(L, "a %s is expected, not %s", kind->item_type, tl_lua_describe(L, 1));
    return item;
}

const tl_field *tl_lua_field_named(const tl_lua_kind *kind, const char *name, size_t *index)
{
    size_t count;
    const tl_field *fields = kind->fields(&count);
    for (*index = 0; *index < count; (*index)++)
        if (strcmp(fields[*index].name, name) == 0)
            return &fields[*index];
    return NULL;
}

void tl_lua_item_push(lua_State *L, const tl_lua_kind *kind, int model_index, tl_id id)
{
    model_index = lua_absindex(L, model_index);
    tl_lua_item *item = lua_newuserdatauv(L, sizeof *item, 1);
    *item = (tl_lua_item){kind, lua_touserdata(L, model_index), id};
    luaL_setmetatable(L, kind->item_type);
    lua_pushvalue(L, model_index);
    lua_setiuservalue(L, -2, 1);
}

void tl_lua_item_rename(lua_State *L, const char *name, tl_id id)
{
    lua_getfield(L, -1, name);
    tl_lua_item *item = lua_touserdata(L, -1);
    item->id = id;
    lua_pop(L, 1);
    if (id != TL_NO_ID)
        return;
    lua_pushnil(L);
    lua_setfield(L, -2, name);
}

static int unknown_field(lua_State *L, const tl_lua_kind *kind, const char *name)
{
    tl_lua_names names = {0};
    size_t count;
    const tl_field *fields = kind->fields(&count);
    tl_lua_names_fields(&names, fields, count);
    for (const tl_lua_key *key = kind->extra_keys; key->name; key++)
        tl_lua_names_add(&names, key->name);
    return tl_lua_unknown(L, lua_pushfstring(L, "a %s has no field", kind->item), name, &names);
}

static int item_index(lua_State *L)
{
    lua_settop(L, 2);
    tl_lua_item *item = self(L);
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a %s has no field %s", item->kind->item, tl_lua_describe(L, 2));
    const char *name = lua_tostring(L, 2);
    tl_model *model = tl_lua_living(L, item->owner);
    lua_getiuservalue(L, 1, 1);
    if (item->kind->extra(L, model, item->id, name))
        return 1;
    size_t index;
    const tl_field *field = tl_lua_field_named(item->kind, name, &index);
    if (!field)
        return unknown_field(L, item->kind, name);
    tl_field_value value;
    tl_lua_ok(L, model, item->kind->field(model, item->id, index, &value));
    tl_lua_push_field(L, field->kind, &value);
    return 1;
}

static int item_assign(lua_State *L)
{
    tl_lua_item *item = self(L);
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    if (!item->kind->verbs->name)
        return tl_lua_fail(L, "the fields of a %s can only be read ('%s')", item->kind->item, name);
    return tl_lua_fail(L,
                       "the fields of a block can only be read; to change '%s' use a selection: "
                       "model:blocks{id = %I}:set{...}",
                       name, (lua_Integer)item->id);
}

static int item_equal(lua_State *L)
{
    const tl_lua_kind *kind = lua_touserdata(L, lua_upvalueindex(1));
    tl_lua_item *a = luaL_testudata(L, 1, kind->item_type);
    tl_lua_item *b = luaL_testudata(L, 2, kind->item_type);
    lua_pushboolean(L, a && b && a->owner == b->owner && a->id == b->id);
    return 1;
}

static int item_text(lua_State *L)
{
    tl_lua_item *item = self(L);
    lua_pushfstring(L, "%s %I", item->kind->item, (lua_Integer)item->id);
    return 1;
}

void tl_lua_item_open(lua_State *L, const tl_lua_kind *kind)
{
    if (luaL_newmetatable(L, kind->item_type)) {
        lua_pushlightuserdata(L, (void *)(uintptr_t)kind);
        const luaL_Reg meta[] = {{"__index", item_index},
                                 {"__newindex", item_assign},
                                 {"__eq", item_equal},
                                 {"__tostring", item_text},
                                 {NULL, NULL}};
        luaL_setfuncs(L, meta, 1);
    }
    lua_pop(L, 1);
}
