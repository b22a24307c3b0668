/* history.c - values of a model that runs sample: model:history{...}.
 *
 * A history is a userdata in a list that is the second user value of the model's userdata. Its samples lie in columns
 * from malloc. Its own user values are the script's function, and the block, contact or selection it follows.
 *
 * run.c asks after every step whether a sample is due, and takes it in a protected call. While a history's function runs
 * the kernel refuses whatever would change the model, so a run gives the same bits with histories and without. */
#include "history.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- what is asked ---------- */

typedef struct history_args {
    const char *name, *field;
    int64_t every;
    int32_t take, remove;
} history_args;

static const char *const take_names[] = {[TL_TAKE_MEAN] = "mean",
                                         [TL_TAKE_SUM] = "sum",
                                         [TL_TAKE_MIN] = "min",
                                         [TL_TAKE_MAX] = "max",
                                         NULL};

static const tl_param history_params[] = {
    TL_PARAM(TL_PARAM_STRING, history_args, name, "", "what it is called, one of its own",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_INT, history_args, every, "",
             "steps between two samples; the first is taken at once", .def = {10.0}, .min = 1.0,
             .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_STRING, history_args, field, "",
             "field of numbers of what `of` gives (\"displacement\", \"normal_force\")",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_ENUM, history_args, take, "",
             "of a selection: what is made of the values of its blocks or contacts",
             .def = {TL_TAKE_MEAN}, .choices = take_names),
    TL_PARAM(TL_PARAM_BOOL, history_args, remove, "",
             "ends the history of that name, with all its samples", .def = {0.0}),
};

static const tl_lua_key history_keys[] = {
    {"value", "function(model) or text",
     "gives a number, a list of numbers ({x, y, z}) or several numbers, as many each time; it may "
     "read the model, but "
     "not change it. Or one of \"kinetic\", \"potential\", \"stored\", \"friction\", \"damping\", "
     "\"external\" (J), "
     "\"balance\", \"ratio\", \"ratio_maximum\", \"ratio_local\", \"max_velocity\" (m/s), "
     "\"contacts\", \"slipping\", "
     "\"open\" (numbers of contacts)"},
    {"of", "block, contact or selection",
     "what the field is sampled of, in the place of `value`. Blocks and contacts that no longer "
     "exist are left out; "
     "where none is left the value is nan"},
    {NULL, NULL, NULL},
};

const tl_lua_spec tl_lua_history_spec = {
    "history", history_params, sizeof history_params / sizeof *history_params, history_keys};

#define HISTORY_TYPE "talus.history"

/* ---------------------------------------------------------------- the list --------------- */

static int history_collect(lua_State *L)
{
    tl_history *h = luaL_checkudata(L, 1, HISTORY_TYPE);
    free(h->cycles);
    free(h->times);
    free(h->values);
    h->cycles = NULL;
    h->times = h->values = NULL;
    h->count = h->room = 0;
    return 0;
}

/* The place in the list at `list` of the history of that name, or 0. */
static lua_Integer find(lua_State *L, int list, const char *name)
{
    lua_Integer count = (lua_Integer)lua_rawlen(L, list);
    for (lua_Integer i = 1; i <= count; i++)
        if (strcmp(tl_history_at(L, list, i)->name, name) == 0)
            return i;
    return 0;
}

/* ---------------------------------------------------------------- model:history ---------- */

static void check_name(lua_State *L, const char *name)
{
    size_t length = strlen(name);
    if (length == 0 || length > TL_HISTORY_NAME)
        tl_lua_fail(L, "history: name must have 1 to %d letters, not %d", TL_HISTORY_NAME,
                    (int)length);
    if (strcmp(name, "cycle") == 0 || strcmp(name, "time") == 0)
        tl_lua_fail(L, "history: the name '%s' is that of a column which all files have", name);
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127)
            tl_lua_fail(L, "history: name must be in one line, without control characters");
}

static int remove_history(lua_State *L, int list, const char *name)
{
    lua_Integer at = find(L, list, name), count = (lua_Integer)lua_rawlen(L, list);
    if (!at) {
        tl_lua_names names = {0};
        for (lua_Integer i = 1; i <= count; i++)
            tl_lua_names_add(&names, tl_history_at(L, list, i)->name);
        if (!count)
            return tl_lua_fail(
                L, "history: there is none of the name '%s': the model has no history", name);
        return tl_lua_unknown(L, "history: there is none of the name", name, &names);
    }
    for (; at <= count; at++) {
        lua_rawgeti(L, list, at + 1);
        lua_rawseti(L, list, at);
    }
    tl_lua_histories_due(L, 1);
    return 0;
}

/* Reads `value`, at the top of the stack: a function or the name of a quantity. */
static void read_value(lua_State *L, tl_history *h)
{
    if (lua_isfunction(L, -1)) {
        h->source = TL_FROM_FUNCTION;
        return;
    }
    if (lua_type(L, -1) != LUA_TSTRING)
        tl_lua_fail(
            L, "history '%s': value must be a function(model) or the name of a quantity, not %s",
            h->name, tl_lua_describe(L, -1));
    h->source = TL_FROM_MODEL;
    const char *name = lua_tostring(L, -1);
    tl_lua_names names = {0};
    const char *known;
    for (size_t i = 0; (known = tl_history_quantity(i)) != NULL; i++) {
        if (strcmp(known, name) == 0) {
            h->index = i;
            return;
        }
        tl_lua_names_add(&names, known);
    }
    tl_lua_unknown(L, lua_pushfstring(L, "history '%s': there is no value", h->name), name, &names);
}

/* Reads `of`, at the top of the stack, and which field of it is wanted. */
static void read_items(lua_State *L, tl_history *h, const history_args *args)
{
    static const char *const item_types[] = {TL_LUA_BLOCK, TL_LUA_CONTACT};
    static const char *const selection_types[] = {TL_LUA_BLOCKS, TL_LUA_CONTACTS};
    const tl_lua_kind *kind = NULL;
    const tl_lua_model *owner = NULL;
    h->source = TL_FROM_ITEMS;
    h->take = (tl_history_take)args->take;
    for (size_t i = 0; i < 2; i++) {
        const tl_lua_item *item = luaL_testudata(L, -1, item_types[i]);
        const tl_lua_selection *selection = luaL_testudata(L, -1, selection_types[i]);
        h->selection = h->selection || selection;
        kind = item ? item->kind : selection ? selection->kind : kind;
        owner = item ? item->owner : selection ? selection->owner : owner;
    }
    if (!kind)
        tl_lua_fail(L, "history '%s': of must be a block, a contact or a selection of them, not %s",
                    h->name, tl_lua_describe(L, -1));
    if (owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "history '%s': of is a part of another model", h->name);
    if (h->selection && ((const tl_lua_selection *)lua_touserdata(L, -1))->count == 0)
        tl_lua_fail(L, "history '%s': the selection that of gives is empty", h->name);
    if (!args->field)
        tl_lua_fail(L, "history '%s': say which field is to be sampled: field = \"%s\"", h->name,
                    strcmp(kind->item_type, TL_LUA_BLOCK) == 0 ? "displacement" : "normal_force");
    size_t count;
    const tl_field *fields = kind->fields(&count);
    tl_lua_names names = {0};
    for (size_t i = 0; i < count; i++) {
        if (fields[i].kind > TL_FIELD_VEC3)
            continue;
        tl_lua_names_add(&names, fields[i].name);
        h->index = strcmp(fields[i].name, args->field) == 0 ? i + 1 : h->index;
    }
    if (!h->index)
        tl_lua_unknown(
            L,
            lua_pushfstring(L, "history '%s': a %s has no field of numbers", h->name, kind->item),
            args->field, &names);
    h->index--;
    if (fields[h->index].kind == TL_FIELD_VEC3 && h->take >= TL_TAKE_MIN)
        tl_lua_fail(L, "history '%s': the field '%s' is a vector; only single numbers are compared",
                    h->name, args->field);
}

/* Makes the history at the top of the stack what the table at index 2 asks for. */
static void read_source(lua_State *L, tl_history *h, const history_args *args)
{
    int object = lua_gettop(L);
    bool value = lua_getfield(L, 2, "value") != LUA_TNIL;
    bool of = lua_getfield(L, 2, "of") != LUA_TNIL;
    if (!of && lua_getfield(L, 2, "take") != LUA_TNIL)
        tl_lua_fail(L, "history '%s': take is for a history of blocks or contacts, with of",
                    h->name);
    lua_settop(L, object + 2);
    if (value == of)
        tl_lua_fail(L,
                    "history '%s': give either value = function(model) ... end or of = a selection "
                    "with field",
                    h->name);
    if (value) {
        if (args->field)
            tl_lua_fail(
                L, "history '%s': field = '%s' is the field of what `of` gives, and there is no of",
                h->name, args->field);
        lua_pop(L, 1);
        read_value(L, h);
        lua_setiuservalue(L, object, TL_HISTORY_FUNCTION);
    } else {
        read_items(L, h, args);
        lua_setiuservalue(L, object, TL_HISTORY_FOLLOWED);
    }
    lua_settop(L, object);
}

int tl_lua_history(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "history");
    tl_lua_model *owner = lua_touserdata(L, 1);
    tl_lua_arity(L, 2, "history");
    lua_settop(L, 2);
    history_args args = {0};
    tl_lua_read(L, 2, &tl_lua_history_spec, false, &args);
    check_name(L, args.name);
    if (owner->sampling)
        return tl_lua_fail(L, "history '%s': a history's function may only read the model",
                           args.name);
    lua_Integer count = tl_histories_push(L);
    int list = lua_gettop(L);
    if (args.remove)
        return remove_history(L, list, args.name);
    if (find(L, list, args.name))
        return tl_lua_fail(L,
                           "history '%s': there is one of that name; model:history{name = '%s', "
                           "remove = true} ends it",
                           args.name, args.name);
    tl_history *h = lua_newuserdatauv(L, sizeof *h, TL_HISTORY_USER_VALUES);
    *h = (tl_history){.every = args.every, .first = tl_model_cycles(model)};
    strcpy(h->name, args.name);
    if (luaL_newmetatable(L, HISTORY_TYPE)) {
        lua_pushcfunction(L, history_collect);
        lua_setfield(L, -2, "__gc");
    }
    lua_setmetatable(L, -2);
    read_source(L, h, &args);
    lua_pushvalue(L, -1);
    if (tl_history_sample(L, 1) != LUA_OK)
        return lua_error(L);
    lua_rawseti(L, list, count + 1);
    tl_lua_histories_due(L, 1);
    return 0;
}
