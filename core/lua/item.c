/* item.c - blocks, contacts, zones and gridpoints as Lua objects: one of them, and a list.
 *
 * An item is no pointer into the kernel but a name that is looked up at every access. So one that was deleted raises
 * and never crashes. A selection is a snapshot, taken when it was made: blocks in ascending order of id, contacts in
 * that of their blocks. Sums run in that order, so they are the same bits every time, whenever contacts began. */
#include "lua/item.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void add_fields(tl_lua_names *names, const tl_lua_kind *kind)
{
    size_t count;
    const tl_field *fields = kind->fields(&count);
    for (size_t i = 0; i < count; i++)
        tl_lua_names_add(names, fields[i].name);
}

/* Pushes a list of numbers, or of whole ones. */
static void push_flat(lua_State *L, const double *values, size_t count, bool whole)
{
    if (!whole) {
        tl_lua_push_numbers(L, values, count);
        return;
    }
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        lua_pushinteger(L, (lua_Integer)values[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* Pushes a field's value as Lua sees it. */
static void push_field(lua_State *L, tl_field_kind kind, const tl_field_value *value)
{
    const double *n = value->number;
    switch (kind) {
    case TL_FIELD_SCALAR: lua_pushnumber(L, value->number[0]); break;
    case TL_FIELD_COUNT: lua_pushinteger(L, (lua_Integer)value->number[0]); break;
    case TL_FIELD_BOOL: lua_pushboolean(L, value->number[0] != 0.0); break;
    case TL_FIELD_VEC3: tl_lua_push_numbers(L, value->number, 3); break;
    case TL_FIELD_QUAT: tl_lua_push_numbers(L, value->number, 4); break;
    case TL_FIELD_SYM3:
        lua_createtable(L, 0, 6);
        TL_LUA_SET_NUMBERS(L, {"xx", n[0]}, {"yy", n[1]}, {"zz", n[2]}, {"xy", n[3]}, {"yz", n[4]}, {"zx", n[5]});
        break;
    case TL_FIELD_TEXT: lua_pushstring(L, value->text); break;
    case TL_FIELD_IDS: push_flat(L, value->number, 2, true); break;
    }
}

/* ---------------------------------------------------------------- one item --------------- */

/* The item at index 1 of a metamethod, whose upvalue 1 is the kind. */
static tl_lua_item *self_item(lua_State *L)
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

static tl_lua_item item_at(const tl_lua_selection *selection, size_t i)
{
    const tl_lua_kind *kind = selection->kind;
    tl_lua_item item = {.kind = kind, .owner = selection->owner};
    memcpy(&item.name, (const char *)selection->names + i * kind->name_size, kind->name_size);
    return item;
}

static void push(lua_State *L, int model_index, tl_lua_item item)
{
    model_index = lua_absindex(L, model_index);
    tl_lua_item *pushed = lua_newuserdatauv(L, sizeof *pushed, 1);
    *pushed = item;
    pushed->owner = lua_touserdata(L, model_index);
    luaL_setmetatable(L, item.kind->item_type);
    lua_pushvalue(L, model_index);
    lua_setiuservalue(L, -2, 1);
}

tl_lua_item tl_lua_item_push(lua_State *L, int model_index, const tl_lua_selection *selection, size_t i)
{
    const tl_lua_item item = item_at(selection, i);
    push(L, model_index, item);
    return item;
}

void tl_lua_item_push_name(lua_State *L, const tl_lua_kind *kind, int model_index, const void *name)
{
    tl_lua_item item = {.kind = kind};
    memcpy(&item.name, name, kind->name_size);
    push(L, model_index, item);
}

void tl_lua_item_rename(lua_State *L, const char *name, tl_id id)
{
    lua_getfield(L, -1, name);
    tl_lua_item *item = lua_touserdata(L, -1);
    item->name.block = id;
    lua_pop(L, 1);
    if (id != TL_NO_ID)
        return;
    lua_pushnil(L);
    lua_setfield(L, -2, name);
}

static int unknown_field(lua_State *L, const tl_lua_kind *kind, const char *name)
{
    tl_lua_names names = {0};
    add_fields(&names, kind);
    for (const tl_lua_key *key = kind->extra_keys; key->name; key++)
        tl_lua_names_add(&names, key->name);
    return tl_lua_unknown(L, lua_pushfstring(L, "a %s has no field", kind->item), name, &names);
}

static int item_index(lua_State *L)
{
    lua_settop(L, 2);
    tl_lua_item *item = self_item(L);
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a %s has no field %s", item->kind->item, tl_lua_describe(L, 2));
    const char *name = lua_tostring(L, 2);
    tl_model *model = tl_lua_living(L, item->owner);
    lua_getiuservalue(L, 1, 1);
    if (item->kind->extra(L, model, item, name))
        return 1;
    size_t index;
    const tl_field *field = tl_lua_field_named(item->kind, name, &index);
    if (!field)
        return unknown_field(L, item->kind, name);
    tl_field_value value;
    tl_lua_ok(L, model, item->kind->field(model, item, index, &value));
    push_field(L, field->kind, &value);
    return 1;
}

static int item_assign(lua_State *L)
{
    tl_lua_item *item = self_item(L);
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "?";
    if (!item->kind->verbs->name)
        return tl_lua_fail(L, "the fields of a %s can only be read ('%s')", item->kind->item, name);
    return tl_lua_fail(
        L, "the fields of a %s can only be read; to change '%s' use a selection: model:%s{id = %I}:set{...}",
        item->kind->item, name, item->kind->items, item->kind->number(&item->name));
}

static int item_equal(lua_State *L)
{
    const tl_lua_kind *kind = lua_touserdata(L, lua_upvalueindex(1));
    tl_lua_item *a = luaL_testudata(L, 1, kind->item_type);
    tl_lua_item *b = luaL_testudata(L, 2, kind->item_type);
    lua_pushboolean(L, a && b && a->owner == b->owner && memcmp(&a->name, &b->name, kind->name_size) == 0);
    return 1;
}

static int item_text(lua_State *L)
{
    tl_lua_item *item = self_item(L);
    lua_pushfstring(L, "%s %I", item->kind->item, item->kind->number(&item->name));
    return 1;
}

static void open_item(lua_State *L, const tl_lua_kind *kind)
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

/* ---------------------------------------------------------------- selections ------------- */

tl_lua_selection *tl_lua_selection_push(lua_State *L, const tl_lua_kind *kind, int model_index)
{
    model_index = lua_absindex(L, model_index);
    tl_lua_selection *selection = lua_newuserdatauv(L, sizeof *selection, 1);
    *selection = (tl_lua_selection){.kind = kind, .owner = lua_touserdata(L, model_index)};
    lua_pushvalue(L, model_index);
    lua_setiuservalue(L, -2, 1);
    luaL_setmetatable(L, kind->selection_type);
    return selection;
}

/* The selection at index 1 of a method; upvalue 1 is the kind. */
static tl_lua_selection *self(lua_State *L, const char *method)
{
    const tl_lua_kind *kind = lua_touserdata(L, lua_upvalueindex(1));
    tl_lua_selection *selection = luaL_testudata(L, 1, kind->selection_type);
    if (!selection)
        tl_lua_fail(L, "%s: called on %s, not on a selection of %s; write selection:%s(...)", method,
                    tl_lua_describe(L, 1), kind->items, method);
    return selection;
}

static int selection_collect(lua_State *L)
{
    tl_lua_selection *selection = self(L, "collect");
    free(selection->names);
    selection->names = NULL;
    selection->count = 0;
    return 0;
}

static int selection_length(lua_State *L)
{
    lua_pushinteger(L, (lua_Integer)self(L, "#")->count);
    return 1;
}

static int selection_text(lua_State *L)
{
    tl_lua_selection *selection = self(L, "tostring");
    lua_pushfstring(L, "selection of %I %s", (lua_Integer)selection->count,
                    selection->count == 1 ? selection->kind->item : selection->kind->items);
    return 1;
}

/* ---------------------------------------------------------------- one field of all --------
 *
 * selection:values(field): one field of all items of a selection, as a list. */

/* Whether the second argument of `values` asks for a flat list. */
static bool wants_flat(lua_State *L)
{
    if (lua_isnoneornil(L, 3))
        return false;
    if (lua_isboolean(L, 3))
        return lua_toboolean(L, 3);
    const char *how = lua_type(L, 3) == LUA_TSTRING ? lua_tostring(L, 3) : "";
    if (strcmp(how, "flat") != 0 && strcmp(how, "nested") != 0)
        tl_lua_fail(L, "values: how to list must be \"flat\" or \"nested\", not %s", tl_lua_describe(L, 3));
    return strcmp(how, "flat") == 0;
}

/* Texts, truths, tensors and ids: as single items give them. */
static void push_items(lua_State *L, const tl_lua_selection *selection, const tl_field *field, size_t index)
{
    lua_createtable(L, (int)selection->count, 0);
    for (size_t i = 0; i < selection->count; i++) {
        tl_model *model = tl_lua_living(L, selection->owner);
        tl_field_value value;
        const tl_lua_item item = item_at(selection, i);
        tl_lua_ok(L, model, selection->kind->field(model, &item, index, &value));
        push_field(L, field->kind, &value);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* Ids: exact, as single items give them. */
static void push_ids(lua_State *L, const tl_lua_selection *selection)
{
    lua_createtable(L, (int)selection->count, 0);
    for (size_t i = 0; i < selection->count; i++) {
        const tl_lua_item item = item_at(selection, i);
        lua_pushinteger(L, item.kind->number(&item.name));
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

/* Raises an error where `name` is a list or a table that items have besides their fields: there is no column of it. */
static void refuse_extra(lua_State *L, const tl_lua_kind *kind, const char *name, const char *method)
{
    for (const tl_lua_key *key = kind->extra_keys; key->name; key++)
        if (strcmp(key->name, name) == 0)
            tl_lua_fail(L, "%s: '%s' of a %s is a %s and has no column of numbers; ask each %s for it: selection[1].%s",
                        method, name, kind->item, strncmp(key->type, "list", 4) == 0 ? "list" : "table", kind->item,
                        name);
}

static int selection_values(lua_State *L)
{
    const tl_lua_selection *selection = self(L, "values");
    tl_lua_arity(L, 3, "values");
    const char *name = tl_lua_text(L, 2, "values", "the field's name");
    bool flat = wants_flat(L);
    size_t index;
    const tl_field *field = tl_lua_field_named(selection->kind, name, &index);
    tl_field_kind kind = field ? field->kind : TL_FIELD_SCALAR;
    if (kind == TL_FIELD_TEXT || kind == TL_FIELD_BOOL || (kind == TL_FIELD_SYM3 && !flat)) {
        push_items(L, selection, field, index);
        return 1;
    }
    tl_model *model = tl_lua_living(L, selection->owner);
    size_t width, count = selection->count;
    tl_status status = selection->kind->values(model, NULL, name, NULL, &width);
    if (status == TL_E_NOT_FOUND)
        refuse_extra(L, selection->kind, name, "values");
    tl_lua_ok(L, model, status);
    double *values = lua_newuserdatauv(L, (count * width + 1) * sizeof *values, 0);
    tl_lua_ok(L, model, selection->kind->values(model, selection, name, values, &width));
    if (strcmp(name, "id") == 0)
        push_ids(L, selection);
    else if (flat || width == 1)
        push_flat(L, values, count * width, kind == TL_FIELD_COUNT || kind == TL_FIELD_IDS);
    else if (kind == TL_FIELD_IDS)
        push_items(L, selection, field, index);
    else
        tl_lua_push_rows(L, values, count, width, width);
    return 1;
}

/* ---------------------------------------------------------------- sums and extremes ------ */

/* What sum, max and min work on: a field of numbers, or a state of laws or solids, NaN of items that have it not. */
typedef struct column {
    const tl_field *field; /* NULL: a state */
    const double *values;  /* of each item as many as the width */
    size_t width;
} column;

/* How a component of a field is asked for, where items of a kind tell it; else nothing. */
static const char *component_hint(lua_State *L, const tl_lua_kind *kind, const char *name, const char *part)
{
    size_t width;
    tl_model *model = tl_lua_living(L, ((tl_lua_selection *)lua_touserdata(L, 1))->owner);
    const char *whole = lua_pushfstring(L, "%s.%s", name, part);
    const bool told = kind->values(model, NULL, whole, NULL, &width) == TL_OK;
    return told ? lua_pushfstring(L, ": ask for a component, as '%s'", whole) : "";
}

/* The column named at stack index 2; pushes its values. */
static column read_column(lua_State *L, const tl_lua_selection *selection, const char *method)
{
    const tl_lua_kind *kind = selection->kind;
    const char *name = tl_lua_text(L, 2, method, "the field's name");
    tl_lua_arity(L, 2, method);
    tl_model *model = tl_lua_living(L, selection->owner);
    size_t index, width;
    const tl_field *field = tl_lua_field_named(kind, name, &index);
    if (field && field->kind > TL_FIELD_VEC3)
        tl_lua_fail(L, "%s: the field '%s' of a %s is not a number%s", method, name, kind->item,
                    component_hint(L, kind, name, "zz"));
    if (kind->values(model, NULL, name, NULL, &width) == TL_E_NOT_FOUND) {
        refuse_extra(L, kind, name, method);
        tl_lua_names names = {0};
        add_fields(&names, kind);
        lua_pushfstring(L, "%s: a %s has no field of numbers", method, kind->item);
        tl_lua_unknown(L, lua_tostring(L, -1), name, &names);
    }
    double *values = lua_newuserdatauv(L, (selection->count * width + 1) * sizeof *values, 0);
    tl_lua_ok(L, model, kind->values(model, selection, name, values, &width));
    return (column){field, values, width};
}

/* Pushes a sum or an extreme of a column. */
static int push_of_column(lua_State *L, const column *c, const tl_field_value *value)
{
    tl_field_kind kind = c->field ? c->field->kind : c->width > 1 ? TL_FIELD_VEC3 : TL_FIELD_SCALAR;
    push_field(L, kind == TL_FIELD_BOOL ? TL_FIELD_COUNT : kind, value);
    return 1;
}

static int selection_sum(lua_State *L)
{
    tl_lua_selection *selection = self(L, "sum");
    column c = read_column(L, selection, "sum");
    tl_field_value sum = {{0}, NULL};
    for (size_t i = 0; i < selection->count; i++)
        for (size_t k = 0; k < c.width; k++)
            if (c.field || !isnan(c.values[i * c.width]))
                sum.number[k] += c.values[i * c.width + k];
    return push_of_column(L, &c, &sum);
}

/* The largest (sign 1) or smallest (sign -1) value of a column of single numbers. */
static int extreme(lua_State *L, const char *method, double sign)
{
    tl_lua_selection *selection = self(L, method);
    column c = read_column(L, selection, method);
    const char *name = lua_tostring(L, 2);
    bool truth = c.field && c.field->kind == TL_FIELD_BOOL;
    if (c.width > 1 || truth)
        tl_lua_fail(L, "%s: the %s '%s' is %s; only single numbers are compared%s", method, c.field ? "field" : "state",
                    name, truth ? "true or false" : "a vector",
                    truth ? "" : component_hint(L, selection->kind, name, "z"));
    if (c.field && selection->count == 0)
        tl_lua_fail(L, "%s: the selection is empty, so '%s' has no value", method, name);
    double best = c.field ? c.values[0] : NAN;
    for (size_t i = 0; i < selection->count; i++)
        if (sign * c.values[i] > sign * best || (!c.field && isnan(best)))
            best = c.values[i];
    if (!c.field && isnan(best))
        tl_lua_fail(L, "%s: no %s of the selection has a %s with the state '%s'", method, selection->kind->item,
                    selection->kind->bearer, name);
    return push_of_column(L, &c, &(tl_field_value){{best}, NULL});
}

static int selection_max(lua_State *L)
{
    return extreme(L, "max", 1.0);
}

static int selection_min(lua_State *L)
{
    return extreme(L, "min", -1.0);
}

/* ---------------------------------------------------------------- verbs ------------------
 *
 * What all verbs of selections share: whom they act on, and how they end. */

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

/* Says once for each place in a script that a verb had nothing to act on. */
static void remark_empty(lua_State *L, const tl_lua_kind *kind, const char *verb, const char *done)
{
    luaL_getsubtable(L, LUA_REGISTRYINDEX, "talus.remarks");
    tl_lua_push_where(L);
    lua_pushfstring(L, "%s: the selection is empty: no %s was %s; see what model:%s{...} finds", verb, kind->item, done,
                    kind->items);
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

/* Calls a verb, which is upvalue 2. */
static int call_verb(lua_State *L)
{
    const tl_lua_verb *verb = lua_touserdata(L, lua_upvalueindex(2));
    tl_lua_selection *items = self(L, verb->name);
    tl_model *model = tl_lua_living(L, items->owner);
    tl_lua_arity(L, verb->arguments + 1, verb->name);
    lua_settop(L, verb->arguments + 1);
    if (verb->ask)
        return verb->ask(L, items);
    tl_status status = verb->plain ? verb->plain(model, items->names, items->count) : verb->act(L, items);
    if (verb->done && items->count == 0 && status == TL_OK)
        remark_empty(L, items->kind, verb->name, verb->done);
    tl_lua_ok(L, model, status);
    lua_getiuservalue(L, 1, 1);
    sweep_drives(L, lua_gettop(L)); /* the verb may have ended a drive */
    lua_settop(L, 1);
    return 1;
}

/* ---------------------------------------------------------------- filter ----------------- */

/* Puts item i in the place of item `to` of the same selection. */
static void move(tl_lua_selection *selection, size_t to, size_t i)
{
    char *names = selection->names;
    const size_t size = selection->kind->name_size;
    memmove(names + to * size, names + i * size, size);
}

void tl_lua_selection_filter(lua_State *L, int selection_index, int function_index)
{
    tl_lua_selection *selection = lua_touserdata(L, selection_index);
    lua_getiuservalue(L, selection_index, 1);
    int model_index = lua_gettop(L);
    size_t kept = 0;
    for (size_t i = 0; i < selection->count; i++) {
        lua_pushvalue(L, function_index);
        tl_lua_item_push(L, model_index, selection, i);
        lua_call(L, 1, 1);
        if (lua_toboolean(L, -1))
            move(selection, kept++, i);
        lua_pop(L, 1);
    }
    selection->count = kept;
    lua_pop(L, 1);
}

int tl_lua_read_where(lua_State *L, const tl_lua_kind *kind)
{
    if (tl_lua_option(L, 2, "where") == LUA_TNIL)
        return 0;
    if (lua_type(L, -1) != LUA_TFUNCTION)
        tl_lua_fail(L, "%s: where must be a function(%s), not %s", kind->items, kind->item, tl_lua_describe(L, -1));
    return lua_gettop(L);
}

static int selection_where(lua_State *L)
{
    tl_lua_selection *selection = self(L, "where");
    tl_lua_arity(L, 2, "where");
    if (lua_type(L, 2) != LUA_TFUNCTION)
        tl_lua_fail(L, "where: a function(%s) is expected, not %s", selection->kind->item, tl_lua_describe(L, 2));
    lua_getiuservalue(L, 1, 1);
    tl_lua_selection *copy = tl_lua_selection_push(L, selection->kind, 3);
    const size_t bytes = selection->count * selection->kind->name_size;
    copy->names = malloc(bytes + 1);
    if (!copy->names)
        return tl_lua_fail(L, "where: out of memory");
    if (bytes)
        memcpy(copy->names, selection->names, bytes);
    copy->count = selection->count;
    tl_lua_selection_filter(L, 4, 2);
    return 1;
}

/* ---------------------------------------------------------------- index ------------------ */

static const luaL_Reg methods[] = {
    {"sum", selection_sum},     {"max", selection_max},       {"min", selection_min},
    {"where", selection_where}, {"values", selection_values}, {NULL, NULL},
};

static int unknown_method(lua_State *L, const tl_lua_kind *kind, const char *name)
{
    tl_lua_names names = {0};
    for (const luaL_Reg *method = methods; method->name; method++)
        tl_lua_names_add(&names, method->name);
    for (const tl_lua_verb *verb = kind->verbs; verb->name; verb++)
        tl_lua_names_add(&names, verb->name);
    return tl_lua_unknown(L, lua_pushfstring(L, "a selection of %s has no method", kind->items), name, &names);
}

/* selection[i] and selection:method(). Upvalue 1 is the kind, upvalue 2 the table of methods. */
static int selection_index(lua_State *L)
{
    tl_lua_selection *selection = self(L, "index");
    if (lua_isinteger(L, 2)) {
        lua_Integer i = lua_tointeger(L, 2);
        if (i < 1 || (lua_Unsigned)i > selection->count)
            return 0;
        lua_getiuservalue(L, 1, 1);
        tl_lua_item_push(L, 3, selection, (size_t)i - 1);
        return 1;
    }
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL)
        return 1;
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a selection is indexed by whole numbers from 1, not by %s", tl_lua_describe(L, 2));
    return unknown_method(L, selection->kind, lua_tostring(L, 2));
}

static int selection_assign(lua_State *L)
{
    return tl_lua_fail(L, "a selection of %s cannot be assigned to", self(L, "assign")->kind->items);
}

static void open_selection(lua_State *L, const tl_lua_kind *kind)
{
    if (luaL_newmetatable(L, kind->selection_type)) {
        lua_pushlightuserdata(L, (void *)(uintptr_t)kind);
        lua_newtable(L);
        lua_pushvalue(L, -2);
        luaL_setfuncs(L, methods, 1);
        for (const tl_lua_verb *verb = kind->verbs; verb->name; verb++) {
            lua_pushvalue(L, -2);
            lua_pushlightuserdata(L, (void *)(uintptr_t)verb);
            lua_pushcclosure(L, call_verb, 2);
            lua_setfield(L, -2, verb->name);
        }
        const luaL_Reg meta[] = {{"__index", selection_index}, {"__newindex", selection_assign},
                                 {"__len", selection_length},  {"__tostring", selection_text},
                                 {"__gc", selection_collect},  {NULL, NULL}};
        luaL_setfuncs(L, meta, 2);
    }
    lua_pop(L, 1);
}

void tl_lua_kind_open(lua_State *L, const tl_lua_kind *kind)
{
    open_item(L, kind);
    open_selection(L, kind);
}
