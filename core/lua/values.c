/* values.c - selection:values(field): one field of all blocks or contacts of a selection, as a list. */
#include "front.h"

#include <string.h>
#include <talus/fields.h>

/* Whether the second argument of `values` asks for a flat list. */
static bool wants_flat(lua_State *L)
{
    if (lua_isnoneornil(L, 3))
        return false;
    if (lua_isboolean(L, 3))
        return lua_toboolean(L, 3);
    const char *how = lua_type(L, 3) == LUA_TSTRING ? lua_tostring(L, 3) : "";
    if (strcmp(how, "flat") != 0 && strcmp(how, "nested") != 0)
        tl_lua_fail(L, "values: how to list must be \"flat\" or \"nested\", not %s",
                    tl_lua_describe(L, 3));
    return strcmp(how, "flat") == 0;
}

/* The field of a name, or NULL. */
static const tl_field *field_named(const tl_lua_kind *kind, const char *name, size_t *index)
{
    size_t count;
    const tl_field *fields = kind->fields(&count);
    for (*index = 0; *index < count; (*index)++)
        if (strcmp(fields[*index].name, name) == 0)
            return &fields[*index];
    return NULL;
}

/* Texts, truths, tensors and ids: as single items give them. */
static void push_items(lua_State *L, const tl_lua_selection *selection, const tl_field *field,
                       size_t index)
{
    lua_createtable(L, (int)selection->count, 0);
    for (size_t i = 0; i < selection->count; i++) {
        tl_model *model = tl_lua_living(L, selection->owner);
        tl_field_value value;
        tl_lua_ok(L, model, selection->kind->field(model, selection->ids[i], index, &value));
        tl_lua_push_field(L, field->kind, &value);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* Numbers, one by one. */
static void push_flat(lua_State *L, const double *values, size_t count, bool whole)
{
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        if (whole)
            lua_pushinteger(L, (lua_Integer)values[i]);
        else
            lua_pushnumber(L, values[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static void push_nested(lua_State *L, const double *values, size_t count, size_t width)
{
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        tl_lua_push_numbers(L, values + i * width, width);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

int tl_lua_selection_values(lua_State *L, const tl_lua_selection *selection)
{
    tl_lua_arity(L, 3, "values");
    const char *name = tl_lua_text(L, 2, "values", "the field's name");
    bool flat = wants_flat(L);
    size_t index;
    const tl_field *field = field_named(selection->kind, name, &index);
    tl_field_kind kind = field ? field->kind : TL_FIELD_SCALAR;
    if (kind == TL_FIELD_TEXT || kind == TL_FIELD_BOOL || (kind == TL_FIELD_SYM3 && !flat)) {
        push_items(L, selection, field, index);
        return 1;
    }
    tl_model *model = tl_lua_living(L, selection->owner);
    size_t width, count = selection->count;
    tl_lua_ok(L, model, selection->kind->values(model, NULL, 0, name, NULL, &width));
    double *values = lua_newuserdatauv(L, (count * width + 1) * sizeof *values, 0);
    tl_lua_ok(L, model,
              selection->kind->values(model, selection->ids, count, name, values, &width));
    if (flat || width == 1)
        push_flat(L, values, count * width, kind == TL_FIELD_COUNT || kind == TL_FIELD_IDS);
    else if (kind == TL_FIELD_IDS)
        push_items(L, selection, field, index);
    else
        push_nested(L, values, count, width);
    return 1;
}
