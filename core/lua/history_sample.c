/* history_sample.c - takes the samples of histories: of functions, of the model, of fields of blocks and contacts. */
#include "history.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

lua_Integer tl_histories_push(lua_State *L)
{
    lua_getiuservalue(L, 1, TL_LUA_HISTORIES);
    return (lua_Integer)lua_rawlen(L, -1);
}

tl_history *tl_history_at(lua_State *L, int list, lua_Integer i)
{
    lua_rawgeti(L, list, i);
    tl_history *h = lua_touserdata(L, -1);
    lua_pop(L, 1);
    return h;
}

/* What a model can be asked for by name. */
typedef enum origin { OF_ENERGY, OF_BALANCE, OF_CONTACTS } origin;

static const struct {
    const char *name;
    origin origin;
    size_t offset;
} quantities[] = {
    {"kinetic", OF_ENERGY, offsetof(tl_energy, kinetic)},
    {"potential", OF_ENERGY, offsetof(tl_energy, potential)},
    {"stored", OF_ENERGY, offsetof(tl_energy, stored)},
    {"friction", OF_ENERGY, offsetof(tl_energy, friction)},
    {"damping", OF_ENERGY, offsetof(tl_energy, damping)},
    {"external", OF_ENERGY, offsetof(tl_energy, external)},
    {"balance", OF_ENERGY, offsetof(tl_energy, balance)},
    {"ratio", OF_BALANCE, offsetof(tl_balance, ratio)},
    {"ratio_maximum", OF_BALANCE, offsetof(tl_balance, ratio_maximum)},
    {"ratio_local", OF_BALANCE, offsetof(tl_balance, ratio_local)},
    {"max_velocity", OF_BALANCE, offsetof(tl_balance, max_velocity)},
    {"contacts", OF_CONTACTS, offsetof(tl_contact_counts, contacts)},
    {"slipping", OF_CONTACTS, offsetof(tl_contact_counts, slipping)},
    {"open", OF_CONTACTS, offsetof(tl_contact_counts, open)},
};

enum { QUANTITIES = sizeof quantities / sizeof *quantities };

const char *tl_history_quantity(size_t i)
{
    return i < QUANTITIES ? quantities[i].name : NULL;
}

/* ---------------------------------------------------------------- one sample ------------- */

/* Places on the stack while the function of a history is called. */
enum { AT_MODEL = 1, AT_HISTORY, AT_FUNCTION, AT_VALUES };

static double read_number(lua_State *L, const tl_history *h, int index)
{
    if (lua_type(L, index) != LUA_TNUMBER)
        tl_lua_fail_in(L, AT_FUNCTION,
                       "history '%s': the function must give a number or a list of numbers, not %s",
                       h->name, tl_lua_describe(L, index));
    return lua_tonumber(L, index);
}

/* Calls the function with the model and reads what it gives; returns how many numbers. */
static size_t ask_function(lua_State *L, tl_history *h)
{
    lua_pushvalue(L, AT_FUNCTION);
    lua_pushvalue(L, AT_MODEL);
    lua_call(L, 1, LUA_MULTRET);
    int given = lua_gettop(L) - AT_FUNCTION;
    luaL_checkstack(L, 16, "too many values");
    bool list = given == 1 && lua_istable(L, AT_VALUES);
    size_t count = list ? (size_t)lua_rawlen(L, AT_VALUES) : (size_t)given;
    if (count == 0 || count > TL_HISTORY_WIDEST)
        tl_lua_fail_in(
            L, AT_FUNCTION,
            "history '%s': the function must give a number or a list of 1 to %d numbers, "
            "not %s",
            h->name, TL_HISTORY_WIDEST,
            count  ? lua_pushfstring(L, "%d of them", (int)count)
            : list ? "an empty list"
                   : "nothing");
    for (size_t i = 0; i < count; i++) {
        int index = AT_VALUES + (int)i;
        if (list) {
            lua_rawgeti(L, AT_VALUES, (lua_Integer)i + 1);
            index = lua_gettop(L);
        }
        h->latest[i] = read_number(L, h, index);
        if (list)
            lua_pop(L, 1);
    }
    if (h->width && (count != h->width || (list || given > 1) != h->list))
        tl_lua_fail_in(
            L, AT_FUNCTION,
            "history '%s': the function gives %d numbers, before it gave %d: it must give "
            "as many each time",
            h->name, (int)count, (int)h->width);
    h->list = list || given > 1;
    return count;
}

static size_t ask_model(lua_State *L, tl_model *model, tl_history *h)
{
    size_t offset = quantities[h->index].offset;
    if (quantities[h->index].origin == OF_CONTACTS) {
        tl_contact_counts counts = tl_model_contact_counts(model);
        size_t count;
        memcpy(&count, (const char *)&counts + offset, sizeof count);
        h->latest[0] = (double)count;
        return 1;
    }
    tl_energy energy;
    tl_balance balance = tl_model_balance(model);
    const void *from = &balance;
    if (quantities[h->index].origin == OF_ENERGY) {
        tl_lua_ok(L, model, tl_model_energy(model, &energy));
        from = &energy;
    }
    memcpy(h->latest, (const char *)from + offset, sizeof *h->latest);
    return 1;
}

/* Tells once that blocks of a history are no longer there: `gone` of `count`, the last of them `id`. */
static void tell_lost(lua_State *L, tl_model *model, tl_history *h, const tl_lua_kind *kind,
                      tl_id id, size_t gone, size_t count)
{
    if (h->lost || strcmp(kind->item_type, TL_LUA_BLOCK) != 0) /* contacts come and go */
        return;
    h->lost = true;
    char text[300];
    long long cycle = tl_model_cycles(model);
    if (gone < count)
        snprintf(text, sizeof text,
                 "history '%s': %s %u no longer exists; from cycle %lld on its values are of the "
                 "%s that are left",
                 h->name, kind->item, id, cycle, kind->items);
    else
        snprintf(text, sizeof text,
                 "history '%s': %s %u no longer exists; from cycle %lld on its values are nan",
                 h->name, kind->item, id, cycle);
    tl_lua_log(tl_lua_options_of(L), text);
}

static void take_in(tl_history *h, const double *number, size_t width, bool begins)
{
    for (size_t k = 0; k < width; k++) {
        double *to = &h->latest[k];
        if (begins || (h->take == TL_TAKE_MIN && number[k] < *to) ||
            (h->take == TL_TAKE_MAX && number[k] > *to))
            *to = number[k];
        else if (h->take == TL_TAKE_MEAN || h->take == TL_TAKE_SUM)
            *to += number[k];
    }
}

/* The field of the block, contact or selection at the top of the stack. */
static size_t ask_items(lua_State *L, tl_model *model, tl_history *h)
{
    const tl_lua_item *item = lua_touserdata(L, -1);
    const tl_lua_selection *selection = lua_touserdata(L, -1);
    const tl_lua_kind *kind = h->selection ? selection->kind : item->kind;
    const tl_id *ids = h->selection ? selection->ids : &item->id;
    size_t count = h->selection ? selection->count : 1, gone = 0, fields;
    size_t width = kind->fields(&fields)[h->index].kind == TL_FIELD_VEC3 ? 3 : 1;
    tl_id lost = TL_NO_ID;
    for (size_t i = 0; i < count; i++) {
        tl_field_value value;
        tl_status status = kind->field(model, ids[i], h->index, &value);
        if (status == TL_E_STALE && h->width) { /* not at the first sample */
            gone++;
            lost = ids[i];
            continue;
        }
        tl_lua_ok(L, model, status);
        take_in(h, value.number, width, i == gone);
    }
    if (gone)
        tell_lost(L, model, h, kind, lost, gone, count);
    for (size_t k = 0; k < width; k++)
        if (gone == count)
            h->latest[k] = NAN;
        else if (h->take == TL_TAKE_MEAN)
            h->latest[k] /= (double)(count - gone);
    h->list = width > 1;
    return width;
}

/* Room for one more sample. */
static void make_room(lua_State *L, tl_history *h, size_t width)
{
    if (h->count < h->room)
        return;
    size_t room = h->room ? 2 * h->room : 64;
    int64_t *cycles = realloc(h->cycles, room * sizeof *cycles);
    h->cycles = cycles ? cycles : h->cycles;
    double *times = realloc(h->times, room * sizeof *times);
    h->times = times ? times : h->times;
    double *values = realloc(h->values, room * width * sizeof *values);
    h->values = values ? values : h->values;
    if (!cycles || !times || !values)
        tl_lua_fail(L, "history '%s': out of memory after %I samples", h->name,
                    (lua_Integer)h->count);
    h->room = room;
}

/* Runs protected. Arguments: the model, the history. */
static int sample(lua_State *L)
{
    tl_history *h = lua_touserdata(L, AT_HISTORY);
    tl_model *model = ((tl_lua_model *)lua_touserdata(L, AT_MODEL))->model;
    lua_getiuservalue(L, AT_HISTORY,
                      h->source == TL_FROM_ITEMS ? TL_HISTORY_FOLLOWED : TL_HISTORY_FUNCTION);
    size_t width = h->source == TL_FROM_FUNCTION ? ask_function(L, h)
                   : h->source == TL_FROM_MODEL  ? ask_model(L, model, h)
                                                 : ask_items(L, model, h);
    make_room(L, h, width);
    h->width = width;
    h->cycles[h->count] = tl_model_cycles(model);
    h->times[h->count] = tl_model_time(model);
    memcpy(h->values + h->count * width, h->latest, width * sizeof *h->values);
    h->count++;
    return 0;
}

int tl_history_sample(lua_State *L, int model_index)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    model_index = lua_absindex(L, model_index);
    lua_pushcfunction(L, sample);
    lua_pushvalue(L, model_index);
    lua_rotate(L, -3, 2);
    owner->sampling = true;
    tl_model_only_read(owner->model, true);
    int status = lua_pcall(L, 2, 0, 0);
    tl_model_only_read(owner->model, false);
    owner->sampling = false;
    return status;
}

/* ---------------------------------------------------------------- when ------------------- */

static int64_t next_sample(const tl_history *h, int64_t cycle)
{
    int64_t since = cycle - h->first;
    return since < 0 ? h->first : h->first + (since / h->every + 1) * h->every;
}

void tl_lua_histories_due(lua_State *L, int model_index)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    int64_t cycle = tl_model_cycles(owner->model);
    owner->next_sample = INT64_MAX;
    lua_getiuservalue(L, model_index, TL_LUA_HISTORIES);
    int list = lua_gettop(L);
    lua_Integer count = (lua_Integer)lua_rawlen(L, list);
    for (lua_Integer i = 1; i <= count; i++) {
        int64_t next = next_sample(tl_history_at(L, list, i), cycle);
        owner->next_sample = next < owner->next_sample ? next : owner->next_sample;
    }
    lua_pop(L, 1);
}

bool tl_lua_histories_sample(lua_State *L, int model_index)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    int64_t cycle = tl_model_cycles(owner->model);
    lua_getiuservalue(L, model_index, TL_LUA_HISTORIES);
    int list = lua_gettop(L);
    lua_Integer count = (lua_Integer)lua_rawlen(L, list);
    for (lua_Integer i = 1; i <= count; i++) {
        const tl_history *h = tl_history_at(L, list, i);
        if (cycle < h->first || (cycle - h->first) % h->every != 0)
            continue;
        lua_rawgeti(L, list, i);
        if (tl_history_sample(L, model_index) != LUA_OK) {
            lua_remove(L, list);
            return false;
        }
    }
    lua_pop(L, 1);
    tl_lua_histories_due(L, model_index);
    return true;
}
