/* item.c - one block or one contact as a Lua object: fields by name, equality, text.
 *
 * An item is no pointer into the kernel but a number that is looked up at every access, so one that
 * was deleted raises and never crashes. */
#include "lua/item.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/front.h"
#include "lua/living.h"

/* Its address is where the metatable of items has their kind. */
static const char kind_key;

static tl_lua_item *item_of(lua_State *L, int index, const char *type)
{
    tl_lua_item *item = luaL_testudata(L, index, type);
    if (!item)
        tl_lua_fail(L, "a %s is expected, not %s", type, tl_lua_describe(L, index));
    return item;
}

const tl_lua_kind *tl_lua_item_kind(lua_State *L, const char *type)
{
    luaL_getmetatable(L, type);
    lua_rawgetp(L, -1, &kind_key);
    const tl_lua_kind *kind = lua_touserdata(L, -1);
    lua_pop(L, 2);
    return kind;
}

void tl_lua_item_push(lua_State *L, const char *type, int model_index, tl_id id)
{
    model_index = lua_absindex(L, model_index);
    tl_lua_item *item = lua_newuserdatauv(L, sizeof *item, 1);
    *item = (tl_lua_item){tl_lua_item_kind(L, type), lua_touserdata(L, model_index), id};
    luaL_setmetatable(L, type);
    lua_pushvalue(L, model_index);
    lua_setiuservalue(L, -2, 1);
}

void tl_lua_set_block(lua_State *L, const char *name, tl_id id)
{
    if (id == TL_NO_ID)
        return;
    tl_lua_item_push(L, TL_LUA_BLOCK, 1, id);
    lua_setfield(L, -2, name);
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

/* Upvalue 1 is the table from a field's name to its index, upvalue 2 the metatable's name. */
static int item_index(lua_State *L)
{
    lua_settop(L, 2);
    tl_lua_item *item = item_of(L, 1, lua_tostring(L, lua_upvalueindex(2)));
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a %s has no field %s", item->kind->item, tl_lua_describe(L, 2));
    const char *name = lua_tostring(L, 2);
    tl_model *model = tl_lua_living(L, item->owner);
    lua_getiuservalue(L, 1, 1);
    if (item->kind->extra(L, model, item->id, name))
        return 1;
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL)
        return unknown_field(L, item->kind, name);
    size_t index = (size_t)lua_tointeger(L, -1), count;
    const tl_field *fields = item->kind->fields(&count);
    tl_field_value value;
    tl_lua_ok(L, model, item->kind->field(model, item->id, index, &value));
    tl_lua_push_field(L, fields[index].kind, &value);
    return 1;
}

static int item_assign(lua_State *L)
{
    tl_lua_item *item = item_of(L, 1, lua_tostring(L, lua_upvalueindex(2)));
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
    const char *type = lua_tostring(L, lua_upvalueindex(2));
    tl_lua_item *a = luaL_testudata(L, 1, type), *b = luaL_testudata(L, 2, type);
    lua_pushboolean(L, a && b && a->owner == b->owner && a->id == b->id);
    return 1;
}

static int item_text(lua_State *L)
{
    tl_lua_item *item = item_of(L, 1, lua_tostring(L, lua_upvalueindex(2)));
    lua_pushfstring(L, "%s %I", item->kind->item, (lua_Integer)item->id);
    return 1;
}

void tl_lua_item_open(lua_State *L, const tl_lua_kind *kind)
{
    if (luaL_newmetatable(L, kind->item_type)) {
        lua_pushlightuserdata(L, (void *)(uintptr_t)kind);
        lua_rawsetp(L, -2, &kind_key);
        size_t count;
        const tl_field *fields = kind->fields(&count);
        lua_createtable(L, 0, (int)count);
        for (size_t i = 0; i < count; i++) {
            lua_pushinteger(L, (lua_Integer)i);
            lua_setfield(L, -2, fields[i].name);
        }
        lua_pushstring(L, kind->item_type);
        const luaL_Reg meta[] = {{"__index", item_index},
                                 {"__newindex", item_assign},
                                 {"__eq", item_equal},
                                 {"__tostring", item_text},
                                 {NULL, NULL}};
        luaL_setfuncs(L, meta, 2);
    }
    lua_pop(L, 1);
}
