/* history_sample.c - takes the samples of histories: of functions, of the model, of fields of blocks and contacts. */
#include "history.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

const tl_lua_kind *tl_history_kind(lua_State *L, const tl_history *h)
{
    return tl_lua_item_kind(L, h->source == TL_FROM_BLOCKS ? TL_LUA_BLOCK : TL_LUA_CONTACT);
}

const tl_field *tl_history_field(lua_State *L, const tl_history *h, size_t *index)
{
    size_t count;
    const tl_field *fields = tl_history_kind(L, h)->fields(&count);
    for (size_t i = 0; i < count; i++)
        if (fields[i].kind <= TL_FIELD_VEC3 && strcmp(fields[i].name, h->asked) == 0) {
            *index = i;
            return &fields[i];
        }
    return NULL;
}

/* ---------------------------------------------------------------- one sample ------------- */

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
        tl_lua_fail_in(L, AT_FUNCTION,
                       "history '%s': the function must give a number or a list of numbers, not %s",
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
        now->number[i] = read_number(L, h, index);
        if (list)
            lua_pop(L, 1);
    }
    now->width = count;
    now->list = list || given > 1;
    if (h->count && (count != h->width || now->list != h->list))
        tl_lua_fail_in(
            L, AT_FUNCTION,
            "history '%s': the function gives %d numbers, before it gave %d: it must give "
            "as many each time",
            h->name, (int)count, (int)h->width);
}

static void ask_model(lua_State *L, tl_model *model, const tl_history *h, latest *now)
{
    size_t index = 0;
    while (strcmp(quantities[index].name, h->asked) != 0)
        index++;
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
    tl_balance balance = tl_model_balance(model);
    const void *from = &balance;
    if (quantities[index].origin == OF_ENERGY) {
        tl_lua_ok(L, model, tl_model_energy(model, &energy));
        from = &energy;
    }
    memcpy(now->number, (const char *)from + offset, sizeof *now->number);
}

/* Tells once that blocks of a history are no longer there: `gone` of `count`, the last of them `id`. */
static void tell_lost(lua_State *L, tl_model *model, tl_history *h, tl_id id, size_t gone)
{
    const tl_lua_kind *kind = tl_history_kind(L, h);
    if (h->lost || h->source != TL_FROM_BLOCKS) /* contacts come and go */
        return;
    h->lost = true;
    char text[300];
    long long cycle = tl_model_cycles(model);
    if (gone < h->id_count)
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

static void take_in(tl_history_take take, latest *now, const double *number, bool begins)
{
    for (size_t k = 0; k < now->width; k++) {
        double *to = &now->number[k];
        if (begins || (take == TL_TAKE_MIN && number[k] < *to) ||
            (take == TL_TAKE_MAX && number[k] > *to))
            *to = number[k];
        else if (take == TL_TAKE_MEAN || take == TL_TAKE_SUM)
            *to += number[k];
    }
}

/* The field of the blocks or contacts. */
static void ask_items(lua_State *L, tl_model *model, tl_history *h, latest *now)
{
    size_t index, gone = 0;
    const tl_lua_kind *kind = tl_history_kind(L, h);
    bool vector = tl_history_field(L, h, &index)->kind == TL_FIELD_VEC3;
    tl_id lost = TL_NO_ID;
    now->width = vector ? 3 : 1;
    now->list = vector;
    for (size_t i = 0; i < h->id_count; i++) {
        tl_field_value value;
        tl_status status = kind->field(model, h->ids[i], index, &value);
        if (status == TL_E_STALE && h->count) { /* not at the first sample */
            gone++;
            lost = h->ids[i];
            continue;
        }
        tl_lua_ok(L, model, status);
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

int tl_lua_history_take(lua_State *L, int model_index, tl_history *h)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    model_index = lua_absindex(L, model_index);
    lua_pushcfunction(L, sample);
    lua_pushvalue(L, model_index);
    lua_pushlightuserdata(L, h);
    lua_pushnil(L);
    owner->sampling = true;
    tl_model_only_read(owner->model, true);
    int status = lua_pcall(L, 3, 0, 0);
    tl_model_only_read(owner->model, false);
    owner->sampling = false;
    return status;
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

void tl_lua_histories_due(lua_State *L, int model_index)
{
    tl_lua_model *owner = lua_touserdata(L, model_index);
    int64_t cycle = tl_model_cycles(owner->model);
    const tl_history *h;
    owner->next_sample = INT64_MAX;
    for (size_t i = 0; (h = tl_history_at(owner->model, i)) != NULL; i++) {
        int64_t next = next_sample(h, cycle);
        owner->next_sample = next < owner->next_sample ? next : owner->next_sample;
    }
}

bool tl_lua_histories_sample(lua_State *L, int model_index)
{
    const tl_lua_model *owner = lua_touserdata(L, model_index);
    int64_t cycle = tl_model_cycles(owner->model);
    tl_history *h;
    for (size_t i = 0; (h = tl_history_at(owner->model, i)) != NULL; i++)
        if (cycle >= h->first && (cycle - h->first) % h->every == 0 &&
            tl_lua_history_take(L, model_index, h) != LUA_OK)
            return false;
    tl_lua_histories_due(L, model_index);
    return true;
}
