/* convert.c - from Lua values to the kernel's named values and back.
 *
 * The checks proper (names, types, ranges) are the kernel's tl_args_read, from one table per
 * function or plugin; here values only get the form it reads. Every buffer is a Lua userdata that
 * hangs on one anchor table, so an error raised on the way leaks nothing. */
#include "lua/convert.h"

#include "lua/fail.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/boundary.h>

/* Letters of a wrong string that a message repeats. */
#define LONGEST_SHOWN 60

/* ---------------------------------------------------------------- conversion to values --- */

/* Hangs the value on the top of the stack on the anchor table and pops it. */
static void hold(lua_State *L, int anchor)
{
    lua_rawseti(L, anchor, (lua_Integer)lua_rawlen(L, anchor) + 1);
}

static void convert_other(lua_State *L, int anchor, tl_value *value, const char *text)
{
    value->type = TL_VALUE_OTHER;
    value->text = lua_pushstring(L, text);
    hold(L, anchor);
}

/* The number at `index`. The sign of a NaN depends on how it came about; it is not shown. */
static double number_at(lua_State *L, int index)
{
    double number = lua_tonumber(L, index);
    return isnan(number) ? NAN : number;
}

/* Numbers before texts, and these before all else. */
static int key_rank(int type)
{
    return type == LUA_TNUMBER ? 0 : type == LUA_TSTRING ? 1 : 2;
}

/* Whether the key at index x comes before that at y. */
static bool key_before(lua_State *L, int x, int y)
{
    int rank = key_rank(lua_type(L, x)), other = key_rank(lua_type(L, y));
    if (rank != other)
        return rank < other;
    if (rank == 0)
        return lua_compare(L, x, y, LUA_OPLT);
    return rank == 1 && strcmp(lua_tostring(L, x), lua_tostring(L, y)) < 0;
}

static bool is_place(lua_State *L, int index, size_t count)
{
    return lua_isinteger(L, index) && lua_tointeger(L, index) >= 1 && lua_tointeger(L, index) <= (lua_Integer)count;
}

const char *tl_lua_stray_key(lua_State *L, int index, size_t count)
{
    index = lua_absindex(L, index);
    luaL_checkstack(L, 8, "too many values");
    lua_pushnil(L);
    const int first = lua_gettop(L);
    for (lua_pushnil(L); lua_next(L, index); lua_pop(L, 1))
        if (!is_place(L, -2, count) && (lua_isnil(L, first) || key_before(L, first + 1, first))) {
            lua_pushvalue(L, -2);
            lua_replace(L, first);
        }
    switch (lua_type(L, first)) {
    case LUA_TNIL: lua_pop(L, 1); return NULL;
    case LUA_TNUMBER: tl_lua_push_number_text(L, first); break;
    case LUA_TSTRING: lua_pushfstring(L, "'%s'", lua_tostring(L, first)); break;
    default: lua_pushstring(L, tl_lua_describe(L, first));
    }
    lua_replace(L, first);
    lua_settop(L, first);
    return lua_tostring(L, first);
}

void tl_lua_check_list(lua_State *L, int index, const char *what, size_t count)
{
    const char *key = tl_lua_stray_key(L, index, count);
    if (key)
        tl_lua_fail(L, "%s has the key %s: " TL_LUA_LIST_KEYS, what, key);
}

/* Reads row `row` of the list at `index`: so many numbers. false, with what it is instead in `value`. */
static bool convert_row(lua_State *L, int index, int anchor, lua_Integer row, int width, double *out, tl_value *value)
{
    lua_rawgeti(L, index, row);
    const char *fault = NULL;
    if (lua_type(L, -1) != LUA_TTABLE)
        fault = lua_pushfstring(L, "list whose row %I is %s", row, tl_lua_describe(L, -1));
    else if (lua_rawlen(L, -1) != (size_t)width)
        fault =
            lua_pushfstring(L, "list whose row %I has %I numbers, not %d", row, (lua_Integer)lua_rawlen(L, -1), width);
    const char *key = fault ? NULL : tl_lua_stray_key(L, -1, (size_t)width);
    if (key)
        fault = lua_pushfstring(L, "list whose row %I has the key %s: " TL_LUA_LIST_KEYS, row, key);
    for (int i = 0; i < width && !fault; i++) {
        if (lua_rawgeti(L, -1, i + 1) != LUA_TNUMBER)
            fault = lua_pushfstring(L, "list whose row %I has %s in place %d", row, tl_lua_describe(L, -1), i + 1);
        else {
            out[i] = number_at(L, -1);
            lua_pop(L, 1);
        }
    }
    if (fault)
        convert_other(L, anchor, value, fault);
    return !fault;
}

/* Numbers in a list of them; false, with what it is instead in `value`. */
static bool convert_number(lua_State *L, int index, int anchor, lua_Integer i, double *out, tl_value *value)
{
    if (lua_rawgeti(L, index, i) == LUA_TNUMBER) {
        *out = number_at(L, -1);
        return true;
    }
    const char *fault = lua_pushfstring(L, "list whose item %I is %s", i, tl_lua_describe(L, -1));
    convert_other(L, anchor, value, fault);
    return false;
}

/* "function", "talus.block": the type of a value that is neither number, text nor list. */
static const char *type_name(lua_State *L, int index)
{
    if (luaL_getmetafield(L, index, "__name") == LUA_TSTRING)
        return lua_tostring(L, -1);
    return luaL_typename(L, index);
}

static void convert_list(lua_State *L, int index, int anchor, tl_value *value)
{
    size_t length = (size_t)lua_rawlen(L, index);
    const char *key = tl_lua_stray_key(L, index, length);
    if (key) {
        convert_other(L, anchor, value, lua_pushfstring(L, "table with the key %s: " TL_LUA_LIST_KEYS, key));
        return;
    }
    bool rows = lua_rawgeti(L, index, 1) == LUA_TTABLE;
    bool flat = rows && lua_rawlen(L, -1) == 2; /* points of a plane */
    bool outlines = rows && lua_rawgeti(L, -1, 1) == LUA_TTABLE;
    lua_pop(L, rows ? 2 : 1);
    if (outlines) {
        convert_other(L, anchor, value, "list of lists of points (holes cannot be given)");
        return;
    }
    size_t width = rows ? 3 : 1;
    double *data = lua_newuserdatauv(L, length * width * sizeof *data, 0);
    hold(L, anchor);
    for (size_t i = 0; i < length; i++) {
        int top = lua_gettop(L);
        lua_Integer place = (lua_Integer)i + 1;
        if (flat)
            data[3 * i + 2] = 0;
        bool good = rows ? convert_row(L, index, anchor, place, flat ? 2 : 3, data + 3 * i, value)
                         : convert_number(L, index, anchor, place, data + i, value);
        lua_settop(L, top);
        if (!good)
            return;
    }
    value->type = flat ? TL_VALUE_FLAT : rows ? TL_VALUE_POINTS : TL_VALUE_NUMBERS;
    value->data = data;
    value->count = length;
}

static void convert(lua_State *L, int index, int anchor, tl_value *value)
{
    int top = lua_gettop(L);
    size_t length;
    switch (lua_type(L, index)) {
    case LUA_TNUMBER:
        value->type = TL_VALUE_NUMBER;
        value->number = number_at(L, index);
        break;
    case LUA_TBOOLEAN:
        value->type = TL_VALUE_BOOL;
        value->number = lua_toboolean(L, index);
        break;
    case LUA_TSTRING:
        value->type = TL_VALUE_STRING;
        value->text = lua_tolstring(L, index, &length);
        if (strlen(value->text) != length)
            convert_other(L, anchor, value, "string with a zero byte");
        break;
    case LUA_TTABLE: convert_list(L, index, anchor, value); break;
    default: convert_other(L, anchor, value, type_name(L, index));
    }
    lua_settop(L, top);
}

static int compare_keys(const void *a, const void *b)
{
    return strcmp(((const tl_value *)a)->key, ((const tl_value *)b)->key);
}

static bool is_listed(const tl_lua_key *keys, const char *name)
{
    for (; keys && keys->name; keys++)
        if (strcmp(keys->name, name) == 0)
            return true;
    return false;
}

void tl_lua_args(lua_State *L, int index, const char *context, const tl_lua_key *skip, tl_args *args)
{
    index = lua_absindex(L, index);
    luaL_checkstack(L, 16, "too many values");
    lua_newtable(L);
    int anchor = lua_gettop(L);
    *args = (tl_args){0};
    if (lua_isnoneornil(L, index))
        return;
    if (!lua_istable(L, index))
        tl_lua_fail(L, "%s: the parameters must be a table, not %s", context, tl_lua_describe(L, index));
    size_t pairs = 0;
    for (lua_pushnil(L); lua_next(L, index); lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            tl_lua_fail(L, "%s: parameters are given by name (name = value); %s has none", context,
                        tl_lua_describe(L, -1));
        tl_lua_text(L, -2, context, "the name of a parameter");
        pairs++;
    }
    tl_value *values = lua_newuserdatauv(L, pairs * sizeof *values, 0);
    hold(L, anchor);
    for (lua_pushnil(L); lua_next(L, index); lua_pop(L, 1)) {
        const char *key = lua_tostring(L, -2);
        if (is_listed(skip, key))
            continue;
        values[args->count] = (tl_value){.key = key};
        convert(L, lua_gettop(L), anchor, &values[args->count]);
        args->count++;
    }
    /* Lua's order of keys changes from run to run; of two mistakes the same is reported. */
    qsort(values, args->count, sizeof *values, compare_keys);
    args->values = values;
}

/* ---------------------------------------------------------------- checked reading -------- */

tl_lua_spec tl_lua_spec_of(const char *function, const tl_lua_key *keys)
{
    tl_lua_spec spec = {.context = function, .keys = keys};
    spec.params = tl_function_params(function, &spec.count, NULL);
    return spec;
}

const tl_param *tl_lua_param_named(const char *function, const char *name)
{
    size_t count;
    const tl_param *params = tl_function_params(function, &count, NULL);
    for (size_t i = 0; i < count; i++)
        if (strcmp(params[i].name, name) == 0)
            return &params[i];
    return NULL;
}

/* Refuses keys that neither the parameters nor the further keys of `spec` know. The kernel would
 * too, but its hint could not name the further keys. */
static void check_keys(lua_State *L, const tl_lua_spec *spec, const tl_args *args)
{
    tl_lua_names names = {0};
    for (size_t i = 0; i < spec->count; i++) {
        tl_lua_names_add(&names, spec->params[i].name);
        if (spec->params[i].alias)
            tl_lua_names_add(&names, spec->params[i].alias);
    }
    size_t own = names.count;
    for (const tl_lua_key *key = spec->keys; key && key->name; key++)
        tl_lua_names_add(&names, key->name);
    for (size_t i = 0; i < args->count; i++) {
        bool known = false;
        for (size_t k = 0; k < own && !known; k++)
            known = strcmp(names.at[k], args->values[i].key) == 0;
        if (!known)
            tl_lua_unknown(L, lua_pushfstring(L, "%s: unknown parameter", spec->context), args->values[i].key, &names);
    }
}

void tl_lua_read(lua_State *L, int index, const tl_lua_spec *spec, bool keep, void *out)
{
    tl_args args;
    tl_lua_args(L, index, spec->context, spec->keys, &args);
    check_keys(L, spec, &args);
    tl_error error;
    if (tl_args_read(spec->params, spec->count, sizeof(tl_param), &args, keep, out, spec->context, &error) != TL_OK)
        tl_lua_raise(L, &error);
}

void tl_lua_read_function(lua_State *L, int index, const char *function, const tl_lua_key *keys, void *out)
{
    tl_lua_spec spec = tl_lua_spec_of(function, keys);
    tl_lua_read(L, index, &spec, false, out);
}

bool tl_lua_read_tensor(lua_State *L, int table, const char *function, const char *key, tl_sym3 *out)
{
    if (tl_lua_option(L, table, key) == LUA_TNIL)
        return false;
    tl_lua_spec tensor = tl_lua_spec_of("tensor", NULL);
    tensor.context = lua_pushfstring(L, "%s, %s", function, key);
    tl_lua_read(L, -2, &tensor, false, out);
    return true;
}

void tl_lua_read_one(lua_State *L, int index, const tl_lua_spec *spec, const char *key, void *out)
{
    index = lua_absindex(L, index);
    lua_createtable(L, 0, 1);
    if (!lua_isnoneornil(L, index)) {
        lua_pushvalue(L, index);
        lua_setfield(L, -2, key);
    }
    /* A single value is always wanted: one parameter, read as if the table had no other. */
    size_t i = 0;
    while (i + 1 < spec->count && strcmp(spec->params[i].name, key) != 0)
        i++;
    tl_param *param = lua_newuserdatauv(L, sizeof *param, 0);
    *param = spec->params[i];
    param->flags |= TL_PARAM_REQUIRED;
    tl_lua_spec one = {.context = spec->context, .params = param, .count = 1};
    tl_lua_read(L, -2, &one, false, out);
}

int tl_lua_option(lua_State *L, int table, const char *key)
{
    if (lua_istable(L, table))
        return lua_getfield(L, table, key);
    lua_pushnil(L);
    return LUA_TNIL;
}

const char *tl_lua_text(lua_State *L, int index, const char *function, const char *what)
{
    size_t length = 0;
    const char *text = lua_type(L, index) == LUA_TSTRING ? lua_tolstring(L, index, &length) : NULL;
    if (!text || strlen(text) != length)
        tl_lua_fail(L, "%s: %s must be a string, not %s", function, what,
                    text ? lua_pushfstring(L, "one with a zero byte after '%s'", text) : tl_lua_describe(L, index));
    return text;
}

void tl_lua_arity(lua_State *L, int most, const char *function)
{
    int extra = lua_gettop(L) - most;
    if (extra > 0)
        tl_lua_fail(L, "%s: %d argument%s too many; the first is %s", function, extra, extra == 1 ? "" : "s",
                    tl_lua_describe(L, most + 1));
}

void tl_lua_push_number_text(lua_State *L, int index)
{
    char text[40];
    if (lua_isinteger(L, index)) {
        lua_pushfstring(L, "%I", lua_tointeger(L, index));
        return;
    }
    tl_text_print(text, sizeof text, "%.14g", lua_tonumber(L, index));
    bool whole = text[strspn(text, "-0123456789")] == '\0';
    lua_pushfstring(L, "%s%s", text, whole ? ".0" : "");
}

const char *tl_lua_describe(lua_State *L, int index)
{
    const char *text;
    size_t length;
    switch (lua_type(L, index)) {
    case LUA_TNONE:
    case LUA_TNIL: return "nil";
    case LUA_TBOOLEAN: return lua_toboolean(L, index) ? "true" : "false";
    case LUA_TNUMBER:
        if (isnan(lua_tonumber(L, index)))
            return "not a number (NaN)";
        tl_lua_push_number_text(L, index);
        return lua_pushfstring(L, "the number %s", lua_tostring(L, -1));
    case LUA_TSTRING:
        text = lua_tolstring(L, index, &length);
        lua_pushlstring(L, text, length < LONGEST_SHOWN ? length : LONGEST_SHOWN);
        return lua_pushfstring(L, "the string '%s%s'", lua_tostring(L, -1), length > LONGEST_SHOWN ? "..." : "");
    default: return lua_pushfstring(L, "a %s", type_name(L, lua_absindex(L, index)));
    }
}

/* ---------------------------------------------------------------- back to Lua ------------ */

void tl_lua_push_numbers(lua_State *L, const double *numbers, size_t count)
{
    tl_lua_push_rows(L, numbers, count, 1, 0);
}

void tl_lua_push_rows(lua_State *L, const double *first, size_t count, size_t step, size_t width)
{
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++, first += step) {
        if (width)
            tl_lua_push_numbers(L, first, width);
        else
            lua_pushnumber(L, *first);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

const char *tl_lua_number_text(double number, int digits, char text[TL_LUA_NUMBER])
{
    do
        tl_text_print(text, TL_LUA_NUMBER, "%.*g", digits, number);
    while (tl_number_read(text, NULL) != number && digits++ < DBL_DECIMAL_DIG);
    return text;
}

/* Laws, dampings and settings have no texts and no lists of points. */
/* The rows of a table, of two numbers each where it is flat. */
static void push_points(lua_State *L, const tl_param *param, const char *at)
{
    tl_points points;
    memcpy(&points, at, sizeof points);
    lua_createtable(L, (int)points.count, 0);
    for (size_t k = 0; k < points.count; k++) {
        tl_lua_push_numbers(L, &points.at[k].x, param->flags & TL_PARAM_FLAT ? 2 : 3);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
}

void tl_lua_push_param(lua_State *L, const tl_param *param, const void *params)
{
    const char *at = (const char *)params + param->offset;
    double real[3];
    int64_t whole;
    int32_t small;
    bool vector = param->type == TL_PARAM_VEC3;
    switch (param->type) {
    case TL_PARAM_REAL:
    case TL_PARAM_VEC3:
        memcpy(real, at, (vector ? 3 : 1) * sizeof *real);
        if (isnan(real[0]))
            lua_pushnil(L);
        else if (vector)
            tl_lua_push_numbers(L, real, 3);
        else
            lua_pushnumber(L, real[0]);
        break;
    case TL_PARAM_INT:
        memcpy(&whole, at, sizeof whole);
        lua_pushinteger(L, (lua_Integer)whole);
        break;
    case TL_PARAM_BOOL:
        memcpy(&small, at, sizeof small);
        lua_pushboolean(L, small);
        break;
    case TL_PARAM_ENUM:
        memcpy(&small, at, sizeof small);
        lua_pushstring(L, param->choices[small]);
        break;
    case TL_PARAM_POINTS: push_points(L, param, at); break;
    default: lua_pushnil(L);
    }
}

/* ---------------------------------------------------------------- results ---------------- */

void tl_lua_set_numbers(lua_State *L, const tl_lua_number *numbers)
{
    for (; numbers->name; numbers++)
        tl_lua_set_number(L, numbers->name, numbers->number);
}

void tl_lua_set_counts(lua_State *L, const tl_lua_count *counts)
{
    for (; counts->name; counts++)
        tl_lua_set_count(L, counts->name, counts->count);
}

void tl_lua_set_number(lua_State *L, const char *name, double number)
{
    lua_pushnumber(L, number);
    lua_setfield(L, -2, name);
}

void tl_lua_set_count(lua_State *L, const char *name, size_t count)
{
    lua_pushinteger(L, (lua_Integer)count);
    lua_setfield(L, -2, name);
}

void tl_lua_set_text(lua_State *L, const char *name, const char *text)
{
    lua_pushstring(L, text);
    lua_setfield(L, -2, name);
}

void tl_lua_set_vec3(lua_State *L, const char *name, tl_vec3 v)
{
    tl_lua_push_numbers(L, &v.x, 3);
    lua_setfield(L, -2, name);
}

bool tl_lua_read_box(lua_State *L, int table, const char *function, const char *key, tl_bounds *box)
{
    static const tl_param params[] = {
        TL_PARAM(TL_PARAM_VEC3, tl_bounds, min, "m", "lowest corner", .flags = TL_PARAM_REQUIRED),
        TL_PARAM(TL_PARAM_VEC3, tl_bounds, max, "m", "highest corner", .flags = TL_PARAM_REQUIRED),
    };
    if (tl_lua_option(L, table, key) == LUA_TNIL)
        return false;
    tl_lua_spec spec = {lua_pushfstring(L, "%s, %s", function, key), params, TL_LUA_COUNT(params), NULL};
    tl_lua_read(L, -2, &spec, false, box);
    if (box->min.x > box->max.x || box->min.y > box->max.y || box->min.z > box->max.z)
        tl_lua_fail(L, "%s: every component of min must be at most that of max", spec.context);
    return true;
}

int32_t tl_lua_side(lua_State *L, const char *context, const char *name)
{
    tl_side side = tl_side_named(name);
    if (side == TL_SIDE_ANY) {
        tl_lua_names known = {0};
        tl_lua_names_list(&known, tl_side_names());
        tl_lua_unknown(L, lua_pushfstring(L, "%s: unknown side", context), name, &known);
    }
    return (int32_t)side;
}
