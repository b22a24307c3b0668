/* history.c - values of a model that runs sample: model:history{...}.
 *
 * run.c asks after every step whether a sample is due, and takes it in a protected call. While a history's function runs
 * the kernel refuses whatever would change the model, so a run gives the same bits with histories and without. */
#include "history.h"

#include <math.h>
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
     "\"open\" (numbers of contacts in the last step)"},
    {"of", "block, contact or selection",
     "what the field is sampled of, in the place of `value`. Blocks and contacts that no longer "
     "exist are left out; "
     "where none is left the value is nan"},
    {NULL, NULL, NULL},
};

const tl_lua_spec tl_lua_history_spec = {
    "history", history_params, sizeof history_params / sizeof *history_params, history_keys};

/* ---------------------------------------------------------------- the list --------------- */

size_t tl_history_find(const tl_model *model, const char *name)
{
    size_t i = 0;
    const tl_history *h;
    while ((h = tl_history_at(model, i)) != NULL && strcmp(h->name, name) != 0)
        i++;
    return i;
}

void tl_history_set_function(lua_State *L, int model_index, const char *name)
{
    lua_getiuservalue(L, model_index, TL_LUA_HISTORIES);
    lua_rotate(L, -2, 1);
    lua_setfield(L, -2, name);
    lua_pop(L, 1);
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

static int remove_history(lua_State *L, tl_model *model, const char *name)
{
    size_t at = tl_history_find(model, name);
    if (!tl_history_at(model, at)) {
        tl_lua_names names = {0};
        const tl_history *h;
        for (size_t i = 0; (h = tl_history_at(model, i)) != NULL; i++)
            tl_lua_names_add(&names, h->name);
        if (at == 0)
            return tl_lua_fail(
                L, "history: there is none of the name '%s': the model has no history", name);
        return tl_lua_unknown(L, "history: there is none of the name", name, &names);
    }
    lua_pushnil(L);
    tl_history_set_function(L, 1, name);
    tl_history_end(model, at);
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
    const char *name = tl_lua_text(L, -1, "history", "value");
    tl_lua_names names = {0};
    const char *known;
    for (size_t i = 0; (known = tl_history_quantity(i)) != NULL; i++) {
        if (strcmp(known, name) == 0) {
            strcpy(h->asked, name);
            return;
        }
        tl_lua_names_add(&names, known);
    }
    tl_lua_unknown(L, lua_pushfstring(L, "history '%s': there is no value", h->name), name, &names);
}

/* Raises unless the field that is asked for is one of numbers, and what is made of several can be made of it. */
static void check_field(lua_State *L, const tl_history *h, const char *name)
{
    const tl_lua_kind *kind = tl_history_kind(L, h);
    size_t count, index;
    const tl_field *fields = kind->fields(&count), *field = tl_history_field(L, h, &index);
    tl_lua_names names = {0};
    for (size_t i = 0; i < count; i++)
        if (fields[i].kind <= TL_FIELD_VEC3)
            tl_lua_names_add(&names, fields[i].name);
    if (!field)
        tl_lua_unknown(
            L,
            lua_pushfstring(L, "history '%s': a %s has no field of numbers", h->name, kind->item),
            name, &names);
    else if (field->kind == TL_FIELD_VEC3 && h->take >= TL_TAKE_MIN)
        tl_lua_fail(L, "history '%s': the field '%s' is a vector; only single numbers are compared",
                    h->name, name);
}

/* Reads `of`, at the top of the stack, and which field of it is wanted. The ids stay those of the object. */
static void read_items(lua_State *L, tl_history *h, const history_args *args)
{
    static const char *const item_types[] = {TL_LUA_BLOCK, TL_LUA_CONTACT};
    static const char *const selection_types[] = {TL_LUA_BLOCKS, TL_LUA_CONTACTS};
    static const tl_history_source sources[] = {TL_FROM_BLOCKS, TL_FROM_CONTACTS};
    const tl_lua_model *owner = NULL;
    h->take = (tl_history_take)args->take;
    for (size_t i = 0; i < 2; i++) {
        tl_lua_item *item = luaL_testudata(L, -1, item_types[i]);
        const tl_lua_selection *selection = luaL_testudata(L, -1, selection_types[i]);
        if (!item && !selection)
            continue;
        h->source = sources[i];
        h->selection = selection != NULL;
        owner = item ? item->owner : selection->owner;
        h->ids = item ? &item->id : selection->ids;
        h->id_count = item ? 1 : selection->count;
    }
    if (!owner)
        tl_lua_fail(L, "history '%s': of must be a block, a contact or a selection of them, not %s",
                    h->name, tl_lua_describe(L, -1));
    if (owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "history '%s': of is a part of another model", h->name);
    if (h->id_count == 0)
        tl_lua_fail(L, "history '%s': the selection that of gives is empty", h->name);
    if (!args->field)
        tl_lua_fail(L, "history '%s': say which field is to be sampled: field = \"%s\"", h->name,
                    h->source == TL_FROM_BLOCKS ? "displacement" : "normal_force");
    strncpy(h->asked, args->field, TL_HISTORY_NAME);
    check_field(L, h, args->field);
}

/* Makes the history what the table at index 2 asks for, and leaves its value or what it is of on the stack. */
static void read_source(lua_State *L, tl_history *h, const history_args *args)
{
    bool of = lua_getfield(L, 2, "of") != LUA_TNIL;
    if (!of && lua_getfield(L, 2, "take") != LUA_TNIL)
        tl_lua_fail(L, "history '%s': take is for a history of blocks or contacts, with of",
                    h->name);
    bool value = lua_getfield(L, 2, "value") != LUA_TNIL;
    if (value == of)
        tl_lua_fail(L,
                    "history '%s': give either value = function(model) ... end or of = a selection "
                    "with field",
                    h->name);
    if (value && args->field)
        tl_lua_fail(
            L, "history '%s': field = '%s' is the field of what `of` gives, and there is no of",
            h->name, args->field);
    if (value) {
        read_value(L, h);
    } else {
        lua_pop(L, 1);
        read_items(L, h, args);
    }
}

int tl_lua_history(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "history");
    const tl_lua_model *owner = lua_touserdata(L, 1);
    tl_lua_arity(L, 2, "history");
    lua_settop(L, 2);
    history_args args = {0};
    tl_lua_read(L, 2, &tl_lua_history_spec, false, &args);
    check_name(L, args.name);
    if (owner->sampling)
        return tl_lua_fail(L, "history '%s': a history's function may only read the model",
                           args.name);
    if (args.remove)
        return remove_history(L, model, args.name);
    size_t at = tl_history_find(model, args.name);
    if (tl_history_at(model, at))
        return tl_lua_fail(L,
                           "history '%s': there is one of that name; model:history{name = '%s', "
                           "remove = true} ends it",
                           args.name, args.name);
    tl_history what = {.every = args.every}, *h;
    strcpy(what.name, args.name);
    read_source(L, &what, &args);
    if (what.source == TL_FROM_FUNCTION)
        tl_history_set_function(L, 1, what.name);
    tl_lua_ok(L, model, tl_history_add(model, &what, &h));
    if (tl_lua_history_take(L, 1, h) != LUA_OK) {
        tl_history_end(model, at);
        lua_pushnil(L);
        tl_history_set_function(L, 1, what.name);
        return lua_error(L);
    }
    tl_lua_histories_due(L, 1);
    return 0;
}
