/* history.c - values of a model that runs sample: model:history{...}.
 *
 * After every step run.c asks whether a sample is due, and takes it in a protected call. While a history's function
 * runs the kernel refuses whatever would change the model. So a run gives the same bits with histories and without. */
#include "lua/history.h"

#include "lua/block.h"
#include "lua/contact.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"
#include "lua/zones.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <talus/fields.h>
#include <talus/zones.h>

/* ---------------------------------------------------------------- what is asked ---------- */

typedef struct history_args {
    const char *name, *field;
    tl_vec3 at;
    int64_t every;
    int32_t take, remove;
} history_args;

static const char *const take_names[] = {
    [TL_TAKE_MEAN] = "mean", [TL_TAKE_SUM] = "sum", [TL_TAKE_MIN] = "min", [TL_TAKE_MAX] = "max", NULL};

static const tl_param history_params[] = {
    TL_PARAM(TL_PARAM_STRING, history_args, name, "", "what it is called, one of its own", .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_INT, history_args, every, "", "steps between two samples; the first is taken at once",
             .def = {10.0}, .min = 1.0, .max = INFINITY, .flags = TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_STRING, history_args, field, "",
             "field of numbers of what `of` gives (\"displacement\", \"normal_force\"), or of what is `at` a point",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, history_args, at, "m",
             "of the point of a deformable block that is here now, and then goes with the block: a field of the zone "
             "in which it lies, or its position, displacement or velocity, between those of the zone's gridpoints",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_ENUM, history_args, take, "", "of a selection: what is made of the values of its items",
             .def = {TL_TAKE_MEAN}, .choices = take_names),
    TL_PARAM(TL_PARAM_BOOL, history_args, remove, "", "ends the history of that name, with all its samples",
             .def = {0.0}),
};

static const tl_lua_key history_keys[] = {
    {"value", "function(model) or text",
     "gives a number, a list of numbers ({x, y, z}) or several numbers, as many each time; it may read the model, but "
     "not change it. Or one of \"kinetic\", \"potential\", \"stored\", \"friction\", \"damping\", \"external\", "
     "\"strain\", \"plastic\" (J), "
     "\"balance\", \"ratio\", \"ratio_maximum\", \"ratio_local\", \"max_velocity\" (m/s), \"contacts\", \"slipping\", "
     "\"open\" (numbers of contacts in the last step)"},
    {"of", "block, contact, zone, gridpoint or selection",
     "what the field is sampled of, in the place of `value`. Those that no longer "
     "exist are left out; where none is left the value is nan"},
    {NULL, NULL, NULL},
};

static const tl_lua_spec history_spec = {"history", history_params, sizeof history_params / sizeof *history_params,
                                         history_keys};

/* ---------------------------------------------------------------- the list --------------- */

static size_t history_find(const tl_model *model, const char *name)
{
    size_t i = 0;
    const tl_history *h;
    while ((h = tl_history_at(model, i)) != NULL && strcmp(h->name, name) != 0)
        i++;
    return i;
}

/* Sets the function of a history of the model at `model_index` to the value at the top of the stack, which it pops. */
static void history_set_function(lua_State *L, int model_index, const char *name)
{
    lua_getiuservalue(L, model_index, TL_LUA_HISTORIES);
    lua_rotate(L, -2, 1);
    lua_setfield(L, -2, name);
    lua_pop(L, 1);
}

/* ---------------------------------------------------------------- samples -----------------
 *
 * Takes the samples of histories: of functions, of the model, of fields of blocks and contacts. */

/* What a model can be asked for by name. */
typedef enum origin { OF_ENERGY, OF_ZONES, OF_BALANCE, OF_CONTACTS } origin;

#define TERM(name, unit, doc) {#name, OF_ENERGY, offsetof(tl_energy, name)},
#define ZONE_TERM(name, unit, doc) {#name, OF_ZONES, offsetof(tl_zone_energy, name)},
static const struct {
    const char *name;
    origin origin;
    size_t offset;
} quantities[] = {
    TL_ENERGY(TERM) TL_ZONE_ENERGY(ZONE_TERM){"ratio", OF_BALANCE, offsetof(tl_balance, ratio)},
    {"ratio_maximum", OF_BALANCE, offsetof(tl_balance, ratio_maximum)},
    {"ratio_local", OF_BALANCE, offsetof(tl_balance, ratio_local)},
    {"max_velocity", OF_BALANCE, offsetof(tl_balance, max_velocity)},
    {"contacts", OF_CONTACTS, offsetof(tl_contact_counts, contacts)},
    {"slipping", OF_CONTACTS, offsetof(tl_contact_counts, slipping)},
    {"open", OF_CONTACTS, offsetof(tl_contact_counts, open)},
};
#undef TERM
#undef ZONE_TERM

enum { QUANTITIES = sizeof quantities / sizeof *quantities };

/* The place of a quantity in the table; QUANTITIES: it has none of that name. */
static size_t quantity_named(const char *name)
{
    size_t i = 0;
    while (i < QUANTITIES && strcmp(quantities[i].name, name) != 0)
        i++;
    return i;
}

/* From TL_FROM_BLOCKS on. */
static const tl_lua_kind *const kinds[] = {&tl_lua_block_kind, &tl_lua_contact_kind, &tl_lua_zone_kind,
                                           &tl_lua_gridpoint_kind};

static const tl_lua_kind *history_kind(const tl_history *h)
{
    return kinds[h->source - TL_FROM_BLOCKS];
}

/* Whether a history may be of a field of this kind. */
static bool is_numbers(tl_field_kind kind)
{
    return kind <= TL_FIELD_VEC3 || kind == TL_FIELD_SYM3;
}

/* Finds the field that a history of items asks for; NULL: they have none of numbers of that name. */
static const tl_field *history_field(const tl_history *h, size_t *index)
{
    const tl_field *field = tl_lua_field_named(history_kind(h), h->asked, index);
    return field && is_numbers(field->kind) ? field : NULL;
}

/* Places on the stack while the function of a history is called. */
enum { AT_MODEL = 1, AT_HISTORY, AT_FUNCTION, AT_VALUES };

/* What is being sampled. */
typedef struct latest {
    double number[TL_HISTORY_WIDEST];
    size_t width;
    bool list;
} latest;

static double read_number(lua_State *L, const tl_history *h, int index)
{
    if (lua_type(L, index) != LUA_TNUMBER)
        tl_lua_fail_in(L, AT_FUNCTION, "history '%s': the function must give a number or a list of numbers, not %s",
                       h->name, tl_lua_describe(L, index));
    return lua_tonumber(L, index);
}

/* Calls the function with the model and reads what it gives. */
static void ask_function(lua_State *L, const tl_history *h, latest *now)
{
    lua_getiuservalue(L, AT_MODEL, TL_LUA_HISTORIES);
    lua_getfield(L, -1, h->name);
    lua_replace(L, AT_FUNCTION);
    lua_settop(L, AT_FUNCTION);
    lua_pushvalue(L, AT_FUNCTION);
    lua_pushvalue(L, AT_MODEL);
    lua_call(L, 1, LUA_MULTRET);
    int given = lua_gettop(L) - AT_FUNCTION;
    luaL_checkstack(L, 16, "too many values");
    bool list = given == 1 && lua_istable(L, AT_VALUES);
    size_t count = list ? (size_t)lua_rawlen(L, AT_VALUES) : (size_t)given;
    if (count == 0 || count > TL_HISTORY_WIDEST)
        tl_lua_fail_in(L, AT_FUNCTION,
                       "history '%s': the function must give a number or a list of 1 to %d numbers, not %s", h->name,
                       TL_HISTORY_WIDEST,
                       count  ? lua_pushfstring(L, "%d of them", (int)count)
                       : list ? "an empty list"
                              : "nothing");
    const char *key = list ? tl_lua_stray_key(L, AT_VALUES, count) : NULL;
    if (key)
        tl_lua_fail_in(L, AT_FUNCTION,
                       "history '%s': the list that the function gives has the key %s: " TL_LUA_LIST_KEYS, h->name,
                       key);
    for (size_t i = 0; i < count; i++) {
        if (list)
            lua_rawgeti(L, AT_VALUES, (lua_Integer)i + 1);
        now->number[i] = read_number(L, h, list ? -1 : AT_VALUES + (int)i);
        lua_settop(L, AT_FUNCTION + given);
    }
    now->width = count;
    now->list = list || given > 1;
    if (h->count && (count != h->width || now->list != h->list))
        tl_lua_fail_in(L, AT_FUNCTION,
                       "history '%s': the function gives %d numbers, before it gave %d: it must give as many each time",
                       h->name, (int)count, (int)h->width);
}

static void ask_model(lua_State *L, tl_model *model, const tl_history *h, latest *now)
{
    size_t index = quantity_named(h->asked);
    size_t offset = quantities[index].offset;
    now->width = 1;
    if (quantities[index].origin == OF_CONTACTS) {
        tl_contact_counts counts = tl_model_contact_counts(model);
        size_t count;
        memcpy(&count, (const char *)&counts + offset, sizeof count);
        now->number[0] = (double)count;
        return;
    }
    tl_energy energy;
    tl_zone_energy zones;
    tl_balance balance = tl_model_balance(model);
    const void *from = &balance;
    if (quantities[index].origin == OF_ENERGY) {
        tl_lua_ok(L, model, tl_model_energy(model, &energy));
        from = &energy;
    } else if (quantities[index].origin == OF_ZONES) {
        tl_lua_ok(L, model, tl_model_zone_energy(model, &zones));
        from = &zones;
    }
    memcpy(now->number, (const char *)from + offset, sizeof *now->number);
}

/* Tells once that blocks of a history are no longer there: `gone` of `count`, the last of them `id`. */
static void tell_lost(lua_State *L, tl_model *model, tl_history *h, tl_id id, size_t gone)
{
    const tl_lua_kind *kind = history_kind(h);
    if (h->lost || h->source != TL_FROM_BLOCKS) /* contacts come and go */
        return;
    h->lost = true;
    char text[300], left[60] = "nan";
    if (gone < h->id_count)
        snprintf(left, sizeof left, "of the %s that are left", kind->items);
    snprintf(text, sizeof text, "history '%s': %s %u no longer exists; from cycle %lld on its values are %s", h->name,
             kind->item, id, (long long)tl_model_cycles(model), left);
    tl_lua_log(tl_lua_options_of(L), text);
}

static void take_in(tl_history_take take, latest *now, const double *number, bool begins)
{
    for (size_t k = 0; k < now->width; k++) {
        double *to = &now->number[k];
        if (begins || (take == TL_TAKE_MIN && number[k] < *to) || (take == TL_TAKE_MAX && number[k] > *to))
            *to = number[k];
        else if (take == TL_TAKE_MEAN || take == TL_TAKE_SUM)
            *to += number[k];
    }
}

/* The field of the items. */
static void ask_items(lua_State *L, tl_model *model, tl_history *h, latest *now)
{
    size_t index, gone = 0;
    const tl_lua_kind *kind = history_kind(h);
    const size_t width = tl_field_width(history_field(h, &index)->kind);
    tl_id lost = TL_NO_ID;
    now->width = width;
    now->list = width > 1;
    for (size_t i = 0; i < h->id_count; i++) {
        tl_field_value value;
        tl_lua_item item = {.kind = kind};
        if (h->ids)
            item.name.block = h->ids[i];
        else if (h->contacts)
            item.name.contact = h->contacts[i];
        else
            item.name.zone = h->zones[i];
        tl_status status = kind->field(model, &item, index, &value);
        if (status == TL_E_STALE && h->count) { /* not at the first sample */
            gone++;
            lost = item.name.block;
            continue;
        }
        tl_lua_ok(L, model, status);
        for (size_t k = 0; h->weights && k < width; k++)
            value.number[k] *= h->weights[i];
        take_in(h->take, now, value.number, i == gone);
    }
    if (gone)
        tell_lost(L, model, h, lost, gone);
    for (size_t k = 0; k < now->width; k++)
        if (gone == h->id_count)
            now->number[k] = NAN;
        else if (h->take == TL_TAKE_MEAN)
            now->number[k] /= (double)(h->id_count - gone);
}

/* Runs protected. Arguments: the model, the history, a place for its function. */
static int sample(lua_State *L)
{
    tl_history *h = lua_touserdata(L, AT_HISTORY);
    tl_model *model = ((tl_lua_model *)lua_touserdata(L, AT_MODEL))->model;
    latest now = {.width = 0};
    if (h->source == TL_FROM_FUNCTION)
        ask_function(L, h, &now);
    else if (h->source == TL_FROM_MODEL)
        ask_model(L, model, h, &now);
    else
        ask_items(L, model, h, &now);
    tl_lua_ok(L, model, tl_history_sample(model, h, now.number, now.width));
    h->list = now.list;
    return 0;
}

/* Takes a sample, while the model may only be read: as lua_pcall. */
static int history_take(lua_State *L, int model_index, tl_history *h)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    model_index = lua_absindex(L, model_index);
    lua_pushcfunction(L, sample);
    lua_pushvalue(L, model_index);
    lua_pushlightuserdata(L, h);
    lua_pushnil(L);
    return tl_lua_call_reading(L, owner, 3, 0);
}

/* ---------------------------------------------------------------- model:history ---------- */

static void check_name(lua_State *L, const char *name)
{
    size_t length = strlen(name);
    if (length == 0 || length > TL_HISTORY_NAME)
        tl_lua_fail(L, "history: name must have 1 to %d letters, not %d", TL_HISTORY_NAME, (int)length);
    if (strcmp(name, "cycle") == 0 || strcmp(name, "time") == 0)
        tl_lua_fail(L, "history: the name '%s' is that of a column which all files have", name);
    for (const char *c = name; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127)
            tl_lua_fail(L, "history: name must be in one line, without control characters");
}

static int remove_history(lua_State *L, tl_model *model, const char *name)
{
    size_t at = history_find(model, name);
    if (!tl_history_at(model, at)) {
        tl_lua_names names = {0};
        const tl_history *h;
        for (size_t i = 0; (h = tl_history_at(model, i)) != NULL; i++)
            tl_lua_names_add(&names, h->name);
        if (at == 0)
            return tl_lua_fail(L, "history: there is none of the name '%s': the model has no history", name);
        return tl_lua_unknown(L, "history: there is none of the name", name, &names);
    }
    lua_pushnil(L);
    history_set_function(L, 1, name);
    tl_history_end(model, at);
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
        tl_lua_fail(L, "history '%s': value must be a function(model) or the name of a quantity, not %s", h->name,
                    tl_lua_describe(L, -1));
    h->source = TL_FROM_MODEL;
    const char *name = tl_lua_text(L, -1, "history", "value");
    if (quantity_named(name) < QUANTITIES) {
        strcpy(h->asked, name);
        return;
    }
    tl_lua_names names = {0};
    for (size_t i = 0; i < QUANTITIES; i++)
        tl_lua_names_add(&names, quantities[i].name);
    tl_lua_unknown(L, lua_pushfstring(L, "history '%s': there is no value", h->name), name, &names);
}

/* Raises unless the field that is asked for is one of numbers, and what is made of several can be made of it. */
static void check_field(lua_State *L, const tl_history *h, const char *name)
{
    const tl_lua_kind *kind = history_kind(h);
    size_t count, index;
    const tl_field *fields = kind->fields(&count), *field = history_field(h, &index);
    tl_lua_names names = {0};
    for (size_t i = 0; i < count; i++)
        if (is_numbers(fields[i].kind))
            tl_lua_names_add(&names, fields[i].name);
    if (!field)
        tl_lua_unknown(L, lua_pushfstring(L, "history '%s': a %s has no field of numbers", h->name, kind->item), name,
                       &names);
    else if (tl_field_width(field->kind) > 1 && h->take >= TL_TAKE_MIN)
        tl_lua_fail(L, "history '%s': the field '%s' is a vector or tensor; only single numbers are compared", h->name,
                    name);
}

/* Reads `of`, at the top of the stack, and which field of it is wanted. The ids stay those of the object. */
static void read_items(lua_State *L, tl_history *h, const history_args *args)
{
    const tl_lua_model *owner = NULL;
    h->take = (tl_history_take)args->take;
    for (size_t i = 0; i < TL_LUA_COUNT(kinds); i++) {
        const tl_lua_kind *kind = kinds[i];
        tl_lua_item *item = luaL_testudata(L, -1, kind->item_type);
        const tl_lua_selection *selection = luaL_testudata(L, -1, kind->selection_type);
        if (!item && !selection)
            continue;
        h->source = (tl_history_source)(TL_FROM_BLOCKS + i);
        h->selection = selection != NULL;
        owner = item ? item->owner : selection->owner;
        void *names = item ? &item->name : selection->names;
        h->ids = h->source == TL_FROM_BLOCKS ? names : NULL;
        h->contacts = h->source == TL_FROM_CONTACTS ? names : NULL;
        h->zones = h->source >= TL_FROM_ZONES ? names : NULL;
        h->id_count = item ? 1 : selection->count;
    }
    if (!owner)
        tl_lua_fail(L,
                    "history '%s': of must be a block, a contact, a zone, a gridpoint or a selection of them, not %s",
                    h->name, tl_lua_describe(L, -1));
    if (owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "history '%s': of is a part of another model", h->name);
    if (h->id_count == 0)
        tl_lua_fail(L, "history '%s': the selection that of gives is empty", h->name);
    if (!args->field)
        tl_lua_fail(L, "history '%s': say which field is to be sampled: field = \"%s\"", h->name,
                    h->source == TL_FROM_CONTACTS ? "normal_force"
                    : h->source == TL_FROM_ZONES  ? "mean"
                                                  : "displacement");
    strncpy(h->asked, args->field, TL_HISTORY_NAME);
    check_field(L, h, args->field);
}

/* Fields of a point that are between those of gridpoints. */
static const char *const point_fields[] = {"position", "displacement", "velocity"};

/* Raises: a point has no such field. */
static void refuse_point_field(lua_State *L, const tl_history *h, const char *name)
{
    tl_lua_names names = {0};
    size_t count;
    const tl_field *fields = tl_lua_zone_kind.fields(&count);
    for (size_t i = 0; i < count; i++)
        if (is_numbers(fields[i].kind))
            tl_lua_names_add(&names, fields[i].name);
    for (size_t i = 0; i < TL_LUA_COUNT(point_fields); i++)
        tl_lua_names_add(&names, point_fields[i]);
    tl_lua_unknown(L, lua_pushfstring(L, "history '%s': a point has no field of numbers", h->name), name, &names);
}

/* Makes the history one of the point of the material that is at a place now. */
static void read_point(lua_State *L, tl_model *model, tl_history *h, const history_args *args, tl_material_point *point)
{
    bool between = false;
    if (!args->field)
        tl_lua_fail(L, "history '%s': say which field is to be sampled: field = \"stress\"", h->name);
    for (size_t i = 0; i < TL_LUA_COUNT(point_fields); i++)
        between = between || strcmp(args->field, point_fields[i]) == 0;
    strncpy(h->asked, args->field, TL_HISTORY_NAME);
    h->source = between ? TL_FROM_GRIDPOINTS : TL_FROM_ZONES;
    size_t index;
    if (!history_field(h, &index))
        refuse_point_field(L, h, args->field);
    if (tl_material_point_at(model, args->at, point) != TL_OK)
        tl_lua_fail(L, "history '%s': %s", h->name, tl_model_error(model)->text);
    h->zones = between ? point->gridpoint : &point->zone;
    h->weights = between ? point->weight : NULL;
    h->id_count = between ? 4 : 1;
    h->selection = between;
    h->take = between ? TL_TAKE_SUM : TL_TAKE_MEAN;
}

/* Makes the history what the table at index 2 asks for, and leaves its value or what it is of on the stack. */
static void read_source(lua_State *L, tl_model *model, tl_history *h, const history_args *args,
                        tl_material_point *point)
{
    const bool at = !isnan(args->at.x);
    if (at && (tl_lua_option(L, 2, "of") != LUA_TNIL || tl_lua_option(L, 2, "value") != LUA_TNIL ||
               tl_lua_option(L, 2, "take") != LUA_TNIL))
        tl_lua_fail(L, "history '%s': with at give field, and neither of, value nor take", h->name);
    if (at) {
        read_point(L, model, h, args, point);
        return;
    }
    bool of = lua_getfield(L, 2, "of") != LUA_TNIL;
    if (!of && lua_getfield(L, 2, "take") != LUA_TNIL)
        tl_lua_fail(L, "history '%s': take is for a history of blocks, contacts, zones or gridpoints, with of",
                    h->name);
    bool value = lua_getfield(L, 2, "value") != LUA_TNIL;
    if (value == of)
        tl_lua_fail(L,
                    "history '%s': give either value = function(model) ... end or of = a selection with field, or at = "
                    "{x, y, z} with field",
                    h->name);
    if (value && args->field)
        tl_lua_fail(L, "history '%s': field = '%s' is the field of what `of` gives, and there is no of", h->name,
                    args->field);
    if (value) {
        read_value(L, h);
    } else {
        lua_pop(L, 1);
        read_items(L, h, args);
    }
}

static int model_history(lua_State *L, tl_model *model)
{
    tl_lua_model *owner = lua_touserdata(L, 1);
    history_args args = {.at = {NAN, NAN, NAN}};
    tl_material_point point;
    tl_lua_read(L, 2, &history_spec, false, &args);
    check_name(L, args.name);
    if (owner->sampling)
        return tl_lua_fail(L, "history '%s': a history's function may only read the model", args.name);
    if (args.remove)
        return remove_history(L, model, args.name);
    size_t at = history_find(model, args.name);
    if (tl_history_at(model, at))
        return tl_lua_fail(L,
                           "history '%s': there is one of that name; model:history{name = '%s', remove = true} ends it",
                           args.name, args.name);
    tl_history what = {.every = args.every}, *h;
    strcpy(what.name, args.name);
    read_source(L, model, &what, &args, &point);
    if (what.source == TL_FROM_FUNCTION)
        history_set_function(L, 1, what.name);
    tl_lua_ok(L, model, tl_history_add(model, &what, &h));
    if (history_take(L, 1, h) != LUA_OK) {
        tl_history_end(model, at);
        lua_pushnil(L);
        history_set_function(L, 1, what.name);
        return lua_error(L);
    }
    owner->next_sample = tl_model_cycles(model) + 1; /* the next step finds it */
    return 0;
}

/* ---------------------------------------------------------------- when ------------------- */

/* The next cycle after that one at which a sample is due. */
static int64_t next_sample(const tl_history *h, int64_t cycle)
{
    int64_t since = cycle - h->first;
    if (since < 0)
        return h->first;
    int64_t wait = h->every - since % h->every;
    return wait <= INT64_MAX - cycle ? cycle + wait : INT64_MAX;
}

bool tl_lua_histories_sample(lua_State *L, int model_index)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    int64_t cycle = tl_model_cycles(owner->model);
    tl_history *h;
    for (size_t i = 0; (h = tl_history_at(owner->model, i)) != NULL; i++)
        if (cycle >= h->first && (cycle - h->first) % h->every == 0 && history_take(L, model_index, h) != LUA_OK)
            return false;
    owner->next_sample = INT64_MAX;
    for (size_t i = 0; (h = tl_history_at(owner->model, i)) != NULL; i++) {
        int64_t next = next_sample(h, cycle);
        owner->next_sample = next < owner->next_sample ? next : owner->next_sample;
    }
    return true;
}

/* ---------------------------------------------------------------- histories of copies and files ---
 *
 * Histories of a copied or restored model: their functions, and whether a file asks for what there is. */

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
    if (tl_lua_option(L, 2, "histories") == LUA_TNIL) {
        lua_settop(L, top);
        return;
    }
    if (!lua_istable(L, -1))
        tl_lua_fail(L, "talus.restore: histories must be a table of functions by name, not %s", tl_lua_describe(L, -1));
    for (lua_pushnil(L); lua_next(L, top + 1); lua_pop(L, 1)) {
        if (lua_type(L, -2) != LUA_TSTRING)
            tl_lua_fail(L, "talus.restore: histories has the key %s, which is the name of no history",
                        tl_lua_describe(L, -2));
        if (!lua_isfunction(L, -1) && !(lua_isboolean(L, -1) && !lua_toboolean(L, -1)))
            tl_lua_fail(L, "talus.restore: history '%s' needs a function(model), or false, not %s", lua_tostring(L, -2),
                        tl_lua_describe(L, -1));
    }
    lua_settop(L, top);
}

/* Whether there is what a history of the model, blocks or contacts asks for, of as many numbers as its samples have. */
static bool is_there(const tl_history *h)
{
    if (h->source == TL_FROM_MODEL)
        return quantity_named(h->asked) < QUANTITIES && !h->list && h->count && h->width == 1;
    size_t index;
    const tl_field *field = history_field(h, &index);
    const size_t width = field ? tl_field_width(field->kind) : 0;
    return field && !(width > 1 && h->take >= TL_TAKE_MIN) && h->list == (width > 1) && h->count && h->width == width;
}

/* Takes up history `i`, or ends it; true: it is still there. */
static bool take_up(lua_State *L, const char *path, int model_index, int given, size_t i)
{
    tl_model *model = ((tl_lua_model *)lua_touserdata(L, model_index))->model;
    const tl_history *h = tl_history_at(model, i);
    bool found = tl_lua_option(L, given, h->name) != LUA_TNIL;
    if (found && !lua_toboolean(L, -1)) {
        tl_history_end(model, i);
        lua_pop(L, 1);
        return false;
    }
    if (found && h->source != TL_FROM_FUNCTION)
        tl_lua_fail(L, "talus.restore: history '%s' sampled no function when the model was saved", h->name);
    if (!found && h->source == TL_FROM_FUNCTION)
        tl_lua_fail(L,
                    "cannot restore '%s': history '%s' samples a function, which has to be given "
                    "again: histories = {[\"%s\"] = function(model) ... end}, or false to end it",
                    path, h->name, h->name);
    if (h->source == TL_FROM_FUNCTION)
        history_set_function(L, model_index, h->name);
    else if (!is_there(h))
        tl_lua_fail(L, "cannot restore '%s': history '%s' asks for '%s', which cannot be sampled", path, h->name,
                    h->asked);
    else
        lua_pop(L, 1);
    return true;
}

void tl_lua_histories_again(lua_State *L, const char *path, int model_index)
{
    tl_model *model = ((tl_lua_model *)lua_touserdata(L, model_index))->model;
    int top = lua_gettop(L), given = top + 1;
    tl_lua_option(L, 2, "histories");
    if (lua_istable(L, given))
        for (lua_pushnil(L); lua_next(L, given); lua_pop(L, 1))
            if (!tl_history_at(model, history_find(model, lua_tostring(L, -2))))
                tl_lua_fail(L, "talus.restore: there was no history '%s' when the model was saved",
                            lua_tostring(L, -2));
    for (size_t i = 0; tl_history_at(model, i);)
        i += take_up(L, path, model_index, given, i);
    lua_settop(L, top);
}

/* ---------------------------------------------------------------- model:histories -------- */

/* The names of the components of values that are lists: of three numbers, and of a field that is a tensor. NULL: they
 * have numbers. */
static const char *const *component_names(const tl_history *h)
{
    static const char *const axes[] = {"x", "y", "z"}, *const tensor[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    const bool field = h->source != TL_FROM_FUNCTION && h->source != TL_FROM_MODEL;
    return h->list && h->width == 3 ? axes : h->list && h->width == 6 && field ? tensor : NULL;
}

static void push_samples(lua_State *L, const tl_history *h)
{
    lua_createtable(L, 0, 6);
    lua_createtable(L, (int)h->count, 0);
    for (size_t i = 0; i < h->count; i++) {
        lua_pushinteger(L, (lua_Integer)h->cycles[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "cycle");
    tl_lua_push_numbers(L, h->times, h->count);
    lua_setfield(L, -2, "time");
    tl_lua_push_rows(L, h->values, h->count, h->width, h->list ? h->width : 0);
    lua_setfield(L, -2, "value");
    const char *const *names = component_names(h);
    for (size_t k = 0; names && k < h->width; k++) {
        tl_lua_push_rows(L, h->values + k, h->count, h->width, 0);
        lua_setfield(L, -2, names[k]);
    }
}

static int model_histories(lua_State *L, tl_model *model)
{
    const tl_history *h;
    lua_newtable(L);
    for (size_t i = 0; (h = tl_history_at(model, i)) != NULL; i++) {
        push_samples(L, h);
        lua_setfield(L, 2, h->name);
    }
    return 1;
}

static const tl_lua_key histories_fields[] = {
    {"cycle", "", "list of the steps at which it was sampled"},
    {"time", "", "list of the times, s"},
    {"value", "", "list of the values, each a number or a list of numbers"},
    {"x, y, z", "", "lists of the components, where each value is a list of three"},
    {"xx, yy, zz, xy, yz, zx", "", "lists of the components of a field that is a tensor, as \"stress\""},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- the file --------------- */

/* Numbers, nan and inf as programs read them. */
static void add_number(luaL_Buffer *b, double value)
{
    char text[TL_LUA_NUMBER];
    luaL_addstring(b, isnan(value) ? "nan" : tl_lua_number_text(value, DBL_DIG, text));
}

/* Names with a comma or a quotation mark are quoted. */
static void add_name(luaL_Buffer *b, const char *name, const char *component)
{
    bool quoted = strpbrk(name, ",\"") != NULL;
    luaL_addstring(b, quoted ? ",\"" : ",");
    for (const char *c = name; *c; c++) {
        if (*c == '"')
            luaL_addchar(b, '"');
        luaL_addchar(b, *c);
    }
    luaL_addstring(b, component);
    if (quoted)
        luaL_addchar(b, '"');
}

static void add_head(luaL_Buffer *b, const tl_history *h)
{
    char component[16] = "";
    const char *const *names = component_names(h);
    for (size_t k = 0; k < h->width; k++) {
        if (names)
            snprintf(component, sizeof component, ".%s", names[k]);
        else if (h->list)
            snprintf(component, sizeof component, ".%d", (int)k + 1);
        add_name(b, h->name, component);
    }
}

/* One line: every history that has a sample of the lowest cycle that is left. false when none is left. */
static bool add_line(luaL_Buffer *b, const tl_history *const *all, size_t *at, size_t count)
{
    int64_t cycle = INT64_MAX;
    double time = 0;
    for (size_t i = 0; i < count; i++)
        if (at[i] < all[i]->count && all[i]->cycles[at[i]] < cycle) {
            cycle = all[i]->cycles[at[i]];
            time = all[i]->times[at[i]];
        }
    if (cycle == INT64_MAX)
        return false;
    char text[40];
    snprintf(text, sizeof text, "%lld,", (long long)cycle);
    luaL_addstring(b, text);
    add_number(b, time);
    for (size_t i = 0; i < count; i++) {
        bool here = at[i] < all[i]->count && all[i]->cycles[at[i]] == cycle;
        for (size_t k = 0; k < all[i]->width; k++) {
            luaL_addchar(b, ',');
            if (here)
                add_number(b, all[i]->values[at[i] * all[i]->width + k]);
        }
        at[i] += here;
    }
    luaL_addchar(b, '\n');
    return true;
}

static int model_write_histories(lua_State *L, tl_model *model)
{
    const char *path = tl_lua_text(L, 2, "write_histories", "the file's name");
    size_t count = 0;
    while (tl_history_at(model, count))
        count++;
    if (count == 0)
        return tl_lua_fail(L, "write_histories: the model has no history; make one with model:history{...}");
    const tl_history **all = lua_newuserdatauv(L, count * sizeof *all, 0);
    size_t *at = lua_newuserdatauv(L, count * sizeof *at, 0);
    luaL_Buffer b;
    luaL_buffinit(L, &b);
    luaL_addstring(&b, "cycle,time");
    for (size_t i = 0; i < count; i++) {
        all[i] = tl_history_at(model, i);
        at[i] = 0;
        add_head(&b, all[i]);
    }
    luaL_addchar(&b, '\n');
    while (add_line(&b, all, at, count)) {
    }
    luaL_pushresult(&b);
    size_t length;
    const char *text = lua_tolstring(L, -1, &length);
    tl_error error;
    if (tl_write_file(path, text, length, &error) != TL_OK)
        return tl_lua_fail(L, "write_histories: %s", error.text);
    return 0;
}

const tl_lua_topic tl_lua_history_topics[] = {
    {.name = "history",
     .usage = "model:history{name = \"gap\", every = 10, value = function(m) return m:contacts():max(\"gap\") end}  or "
              " model:history{name = \"wedge\", of = selection, field = \"displacement\"}  or "
              " model:history{name = \"arch\", at = {3.5, 0.4, 1.8}, field = \"stress\"}",
     .doc = "Samples a value at once and then every so many steps of all runs, until it is removed.",
     .spec = &history_spec,
     .arguments = 1,
     .method = model_history},
    {.name = "histories",
     .usage = "histories = model:histories()",
     .doc = "Gives a table with the samples of each history, by name: copies of them.",
     .title = "Fields of each history",
     .verbs = histories_fields,
     .method = model_histories},
    {.name = "write_histories",
     .usage = "model:write_histories(\"out/run.csv\")",
     .doc = "Writes the samples of all histories into a CSV file: the columns cycle, time and one for each history, in "
            "the order in which they were made, or name.x, name.y and name.z, of a tensor name.xx to name.zx. A cell "
            "is empty where a history has no "
            "sample of that cycle. Folders are made; the file is written whole or not at all.",
     .arguments = 1,
     .method = model_write_histories},
    {.name = NULL},
};
