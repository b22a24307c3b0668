/* selection.c - a list of blocks or contacts as a Lua object.
 *
 * A selection is a snapshot: ids in ascending order, taken when it was made. Sums run in that order,
 * so they are the same bits every time. */
#include "lua/selection.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

tl_lua_selection *tl_lua_selection_push(lua_State *L, const tl_lua_kind *kind, int model_index)
{
    model_index = lua_absindex(L, model_index);
    tl_lua_selection *selection = lua_newuserdatauv(L, sizeof *selection, 1);
    *selection = (tl_lua_selection){kind, lua_touserdata(L, model_index), NULL, 0};
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
        tl_lua_fail(L, "%s: called on %s, not on a selection of %s; write selection:%s(...)",
                    method, tl_lua_describe(L, 1), kind->items, method);
    return selection;
}

static int selection_collect(lua_State *L)
{
    tl_lua_selection *selection = self(L, "collect");
    free(selection->ids);
    selection->ids = NULL;
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
 * Selection:values(field): one field of all blocks or contacts of a selection, as a list. */

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
    tl_lua_ok(L, model, selection->kind->values(model, NULL, 0, name, NULL, &width));
    double *values = lua_newuserdatauv(L, (count * width + 1) * sizeof *values, 0);
    tl_lua_ok(L, model,
              selection->kind->values(model, selection->ids, count, name, values, &width));
    if (flat || width == 1)
        push_flat(L, values, count * width, kind == TL_FIELD_COUNT || kind == TL_FIELD_IDS);
    else if (kind == TL_FIELD_IDS)
        push_items(L, selection, field, index);
    else
        tl_lua_push_rows(L, values, count, width, width);
    return 1;
}

/* ---------------------------------------------------------------- sums and extremes ------ */

/* The field named at stack index 2, which must be of numbers, and its index. */
static const tl_field *number_field(lua_State *L, const tl_lua_kind *kind, const char *method,
                                    size_t *index)
{
    const char *name = tl_lua_text(L, 2, method, "the field's name");
    tl_lua_arity(L, 2, method);
    const tl_field *field = tl_lua_field_named(kind, name, index);
    if (!field) {
        tl_lua_names names = {0};
        size_t count;
        const tl_field *fields = kind->fields(&count);
        tl_lua_names_fields(&names, fields, count);
        tl_lua_unknown(L,
                       lua_pushfstring(L, "%s: a %s has no field of numbers", method, kind->item),
                       name, &names);
    } else if (field->kind > TL_FIELD_VEC3)
        tl_lua_fail(L, "%s: the field '%s' of a %s is not a number", method, name, kind->item);
    return field;
}

static void field_value(lua_State *L, const tl_lua_selection *selection, size_t i, size_t field,
                        tl_field_value *value)
{
    tl_model *model = tl_lua_living(L, selection->owner);
    tl_lua_ok(L, model, selection->kind->field(model, selection->ids[i], field, value));
}

/* Values of the state of a law named at stack index 2, which it pushes in their order, NaN where a law has none of that name;
 * NULL when it is no state. */
static const double *state_values(lua_State *L, const tl_lua_selection *selection,
                                  const char *method, size_t *width)
{
    const tl_lua_kind *kind = selection->kind;
    const char *name = tl_lua_text(L, 2, method, "the field's name");
    size_t index;
    if (tl_lua_field_named(kind, name, &index))
        return NULL;
    tl_model *model = tl_lua_living(L, selection->owner);
    if (kind->values(model, NULL, 0, name, NULL, width) == TL_E_NOT_FOUND)
        return NULL;
    tl_lua_arity(L, 2, method);
    double *values = lua_newuserdatauv(L, (selection->count * *width + 1) * sizeof *values, 0);
    tl_lua_ok(L, model, kind->values(model, selection->ids, selection->count, name, values, width));
    return values;
}

/* Pushes the sum of a state over the items that have it. */
static int sum_states(lua_State *L, const double *values, size_t count, size_t width)
{
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < width; k++)
            sum[k] += isnan(values[i * width]) ? 0 : values[i * width + k];
    if (width == 1)
        lua_pushnumber(L, sum[0]);
    else
        tl_lua_push_numbers(L, sum, width);
    return 1;
}

/* Pushes the largest (sign 1) or smallest (sign -1) value of a state. */
static int extreme_state(lua_State *L, const char *method, double sign, const double *values,
                         size_t count, size_t width)
{
    const char *name = lua_tostring(L, 2);
    if (width > 1)
        tl_lua_fail(L, "%s: the state '%s' is a vector; only single numbers are compared", method,
                    name);
    double best = NAN;
    for (size_t i = 0; i < count; i++)
        if (!isnan(values[i]) && !(sign * values[i] <= sign * best))
            best = values[i];
    if (isnan(best))
        tl_lua_fail(L, "%s: no contact of the selection has a law with the state '%s'", method,
                    name);
    lua_pushnumber(L, best);
    return 1;
}

static int selection_sum(lua_State *L)
{
    tl_lua_selection *selection = self(L, "sum");
    size_t width;
    const double *values = state_values(L, selection, "sum", &width);
    if (values)
        return sum_states(L, values, selection->count, width);
    size_t index;
    tl_field_kind kind = number_field(L, selection->kind, "sum", &index)->kind;
    tl_field_value sum = {{0}, NULL}, value;
    for (size_t i = 0; i < selection->count; i++) {
        field_value(L, selection, i, index, &value);
        for (int k = 0; k < (kind == TL_FIELD_VEC3 ? 3 : 1); k++)
            sum.number[k] += value.number[k];
    }
    tl_lua_push_field(L, kind == TL_FIELD_BOOL ? TL_FIELD_COUNT : kind, &sum);
    return 1;
}

/* The largest (sign 1) or smallest (sign -1) value of a field of single numbers. */
static int extreme(lua_State *L, const char *method, double sign)
{
    tl_lua_selection *selection = self(L, method);
    size_t width;
    const double *values = state_values(L, selection, method, &width);
    if (values)
        return extreme_state(L, method, sign, values, selection->count, width);
    size_t index;
    const tl_field *f = number_field(L, selection->kind, method, &index);
    if (f->kind == TL_FIELD_VEC3 || f->kind == TL_FIELD_BOOL)
        tl_lua_fail(L, "%s: the field '%s' is %s; only single numbers are compared", method,
                    f->name, f->kind == TL_FIELD_VEC3 ? "a vector" : "true or false");
    if (selection->count == 0)
        tl_lua_fail(L, "%s: the selection is empty, so '%s' has no value", method, f->name);
    tl_field_value best, value;
    field_value(L, selection, 0, index, &best);
    for (size_t i = 1; i < selection->count; i++) {
        field_value(L, selection, i, index, &value);
        if (sign * value.number[0] > sign * best.number[0])
            best = value;
    }
    tl_lua_push_field(L, f->kind, &best);
    return 1;
}

static int selection_max(lua_State *L)
{
    return extreme(L, "max", 1.0);
}

static int selection_min(lua_State *L)
{
    return extreme(L, "min", -1.0);
}

/* ---------------------------------------------------------------- verbs of blocks -------------------
 *
 * What all verbs of selections of blocks share: whom they act on, and how they end. */

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

/* Calls a verb, which is upvalue 2. */
static int call_verb(lua_State *L)
{
    const tl_lua_verb *verb = lua_touserdata(L, lua_upvalueindex(2));
    tl_lua_selection *blocks = self(L, verb->name);
    tl_model *model = tl_lua_living(L, blocks->owner);
    tl_lua_arity(L, verb->arguments + 1, verb->name);
    lua_settop(L, verb->arguments + 1);
    if (verb->ask)
        return verb->ask(L, blocks);
    tl_status status =
        verb->plain ? verb->plain(model, blocks->ids, blocks->count) : verb->act(L, blocks);
    if (verb->done && blocks->count == 0 && status == TL_OK)
        remark_empty(L, verb->name, verb->done);
    tl_lua_ok(L, model, status);
    lua_getiuservalue(L, 1, 1);
    sweep_drives(L, lua_gettop(L)); /* the verb may have ended a drive */
    lua_settop(L, 1);
    return 1;
}

/* ---------------------------------------------------------------- filter ----------------- */

void tl_lua_selection_filter(lua_State *L, int selection_index, int function_index)
{
    tl_lua_selection *selection = lua_touserdata(L, selection_index);
    lua_getiuservalue(L, selection_index, 1);
    int model_index = lua_gettop(L);
    size_t kept = 0;
    for (size_t i = 0; i < selection->count; i++) {
        tl_id id = selection->ids[i];
        lua_pushvalue(L, function_index);
        tl_lua_item_push(L, selection->kind, model_index, id);
        lua_call(L, 1, 1);
        if (lua_toboolean(L, -1))
            selection->ids[kept++] = id;
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
        tl_lua_fail(L, "%s: where must be a function(%s), not %s", kind->items, kind->item,
                    tl_lua_describe(L, -1));
    return lua_gettop(L);
}

static int selection_where(lua_State *L)
{
    tl_lua_selection *selection = self(L, "where");
    tl_lua_arity(L, 2, "where");
    if (lua_type(L, 2) != LUA_TFUNCTION)
        tl_lua_fail(L, "where: a function(%s) is expected, not %s", selection->kind->item,
                    tl_lua_describe(L, 2));
    lua_getiuservalue(L, 1, 1);
    tl_lua_selection *copy = tl_lua_selection_push(L, selection->kind, 3);
    copy->ids = malloc((selection->count + 1) * sizeof *copy->ids);
    if (!copy->ids)
        return tl_lua_fail(L, "where: out of memory");
    memcpy(copy->ids, selection->ids, selection->count * sizeof *copy->ids);
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
    return tl_lua_unknown(L, lua_pushfstring(L, "a selection of %s has no method", kind->items),
                          name, &names);
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
        tl_lua_item_push(L, selection->kind, 3, selection->ids[i - 1]);
        return 1;
    }
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(2)) != LUA_TNIL)
        return 1;
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a selection is indexed by whole numbers from 1, not by %s",
                           tl_lua_describe(L, 2));
    return unknown_method(L, selection->kind, lua_tostring(L, 2));
}

static int selection_assign(lua_State *L)
{
    return tl_lua_fail(L, "a selection of %s cannot be assigned to",
                       self(L, "assign")->kind->items);
}

void tl_lua_selection_open(lua_State *L, const tl_lua_kind *kind)
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
