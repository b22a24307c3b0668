/* record.c - talus.record: records of ground motion, and what they are asked. */
#include "lua/record.h"

#include "lua/convert.h"
#include "lua/fail.h"

#include <math.h>
#include <string.h>

#define RECORD "talus.record"
/* Where the function keeps its argument on the Lua stack. */
#define AT_TABLE 1
/* Default: periods at which a spectrum is asked for that names none: 100 from 0.02 s on, each by 500^(1/99) longer than
 * the one before, to 10 s. */
#define PERIODS 100
#define SHORTEST 0.02
#define LONGER 1.0647859778233493

typedef struct holder {
    tl_record *record;
} holder;

static const tl_lua_key record_keys[] = {
    {"at", "list of numbers", "samples, in the place of a file; then dt must be given"},
    {"band", "list of 2 numbers",
     "{low, high}, Hz: filters of Butterworth at both, forward and backward, so without a shift in time; low = 0: only "
     "at high"},
    {NULL, NULL, NULL},
};

static const tl_lua_key record_results[] = {
    {"rec:peak()", "", "the largest acceleration, m/s2, and the largest velocity, m/s"},
    {"rec:arias()", "", "the Arias intensity, m/s: pi / (2 g) times the integral of the squared acceleration"},
    {"rec:spectrum(damping, periods)", "",
     "{period = list, acceleration = list}: pseudo-acceleration, m/s2, of oscillators with that fraction of critical "
     "damping, 0.05 when left out; periods in s, 100 from 0.02 to 10 when left out"},
    {"rec:acceleration(t), rec:velocity(t), rec:displacement(t)", "",
     "m/s2, m/s and m at a time, s, after the first sample. After the last one the velocity stays"},
    {"rec.dt, rec.count, rec.duration", "", "s between samples, their number, s from the first to the last"},
    {NULL, NULL, NULL},
};

static tl_record *record_of(lua_State *L, int index)
{
    return ((holder *)luaL_checkudata(L, index, RECORD))->record;
}

static int release(lua_State *L)
{
    holder *h = lua_touserdata(L, 1);
    tl_record_let_go(h->record);
    h->record = NULL;
    return 0;
}

/* ---------------------------------------------------------------- methods ----------------- */

static double number_at(lua_State *L, int index, const char *what)
{
    if (lua_type(L, index) != LUA_TNUMBER || !isfinite(lua_tonumber(L, index)))
        tl_lua_fail(L, "record: %s must be a finite number: it is %s", what, tl_lua_describe(L, index));
    return lua_tonumber(L, index);
}

static int peak(lua_State *L)
{
    const tl_record *r = record_of(L, 1);
    lua_pushnumber(L, tl_record_peak(r));
    lua_pushnumber(L, tl_record_peak_velocity(r));
    return 2;
}

static int arias(lua_State *L)
{
    lua_pushnumber(L, tl_record_arias(record_of(L, 1)));
    return 1;
}

static int acceleration(lua_State *L)
{
    lua_pushnumber(L, tl_record_acceleration(record_of(L, 1), number_at(L, 2, "the time")));
    return 1;
}

static int velocity(lua_State *L)
{
    lua_pushnumber(L, tl_record_velocity(record_of(L, 1), number_at(L, 2, "the time")));
    return 1;
}

static int displacement(lua_State *L)
{
    lua_pushnumber(L, tl_record_displacement(record_of(L, 1), number_at(L, 2, "the time")));
    return 1;
}

/* The periods that were asked for, in a userdata that stays on the stack. */
static double *read_periods(lua_State *L, int index, size_t *count)
{
    const bool given = !lua_isnoneornil(L, index);
    if (given && !lua_istable(L, index))
        tl_lua_fail(L, "spectrum: periods must be a list of numbers, s, not %s", tl_lua_describe(L, index));
    *count = given ? (size_t)lua_rawlen(L, index) : PERIODS;
    double *out = lua_newuserdatauv(L, (*count + 1) * sizeof *out, 0);
    for (size_t i = 0; i < *count; i++) {
        if (!given) {
            out[i] = i == 0 ? SHORTEST : LONGER * out[i - 1];
            continue;
        }
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        out[i] = number_at(L, -1, "each period of a spectrum");
        lua_pop(L, 1);
    }
    return out;
}

static int spectrum(lua_State *L)
{
    const tl_record *r = record_of(L, 1);
    lua_settop(L, 3);
    const double damping = lua_isnil(L, 2) ? 0.05 : number_at(L, 2, "the damping of a spectrum");
    size_t count;
    tl_error error;
    double *periods = read_periods(L, 3, &count);
    double *out = lua_newuserdatauv(L, (count + 1) * sizeof *out, 0);
    if (tl_record_spectrum(r, damping, periods, count, out, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    lua_createtable(L, 0, 2);
    tl_lua_push_rows(L, periods, count, 1, 0);
    lua_setfield(L, -2, "period");
    tl_lua_push_rows(L, out, count, 1, 0);
    lua_setfield(L, -2, "acceleration");
    return 1;
}

static int index_record(lua_State *L)
{
    static const luaL_Reg methods[] = {{"peak", peak},
                                       {"arias", arias},
                                       {"spectrum", spectrum},
                                       {"acceleration", acceleration},
                                       {"velocity", velocity},
                                       {"displacement", displacement},
                                       {NULL, NULL}};
    static const char *const names[] = {"peak",         "arias", "spectrum", "acceleration", "velocity",
                                        "displacement", "dt",    "count",    "duration",     NULL};
    const tl_record *r = record_of(L, 1);
    const char *name = lua_type(L, 2) == LUA_TSTRING ? lua_tostring(L, 2) : "";
    for (const luaL_Reg *m = methods; m->name; m++)
        if (strcmp(m->name, name) == 0) {
            lua_pushcfunction(L, m->func);
            return 1;
        }
    const double intervals = (double)(tl_record_count(r) - 1);
    if (strcmp(name, "dt") == 0)
        lua_pushnumber(L, tl_record_dt(r));
    else if (strcmp(name, "count") == 0)
        lua_pushinteger(L, (lua_Integer)tl_record_count(r));
    else if (strcmp(name, "duration") == 0)
        lua_pushnumber(L, intervals * tl_record_dt(r));
    else {
        tl_lua_names known = {0};
        tl_lua_names_list(&known, names);
        return tl_lua_unknown(L, "a record has no field", name, &known);
    }
    return 1;
}

/* ---------------------------------------------------------------- making ------------------ */

static holder *push_record(lua_State *L)
{
    holder *h = memset(lua_newuserdatauv(L, sizeof *h, 0), 0, sizeof *h);
    if (luaL_newmetatable(L, RECORD)) {
        lua_pushcfunction(L, release);
        lua_setfield(L, -2, "__gc");
        lua_pushcfunction(L, index_record);
        lua_setfield(L, -2, "__index");
    }
    lua_setmetatable(L, -2);
    return h;
}

static void read_band(lua_State *L, double band[2])
{
    const int type = lua_getfield(L, AT_TABLE, "band");
    if (type != LUA_TNIL) {
        if (type != LUA_TTABLE || lua_rawlen(L, -1) != 2)
            tl_lua_fail(L, "record: band must be {low, high}, two frequencies in Hz, not %s", tl_lua_describe(L, -1));
        for (int k = 0; k < 2; k++) {
            lua_rawgeti(L, -1, k + 1);
            band[k] = number_at(L, -1, "each frequency of band");
            lua_pop(L, 1);
        }
    }
    lua_pop(L, 1);
}

/* The samples of `at`, at the top of the stack, in a userdata that stays there. */
static double *read_samples(lua_State *L, size_t *count)
{
    if (!lua_istable(L, -1))
        tl_lua_fail(L, "record: at must be a list of numbers, not %s", tl_lua_describe(L, -1));
    const int list = lua_gettop(L);
    *count = (size_t)lua_rawlen(L, list);
    double *out = lua_newuserdatauv(L, (*count + 1) * sizeof *out, 0);
    for (size_t i = 0; i < *count; i++) {
        lua_rawgeti(L, list, (lua_Integer)i + 1);
        if (lua_type(L, -1) != LUA_TNUMBER)
            tl_lua_fail(L, "record: at[%I] must be a number, not %s", (lua_Integer)i + 1, tl_lua_describe(L, -1));
        out[i] = lua_tonumber(L, -1);
        lua_pop(L, 1);
    }
    return out;
}

static int module_record(lua_State *L)
{
    tl_lua_arity(L, 1, "record");
    lua_settop(L, 1);
    tl_record_options options = {.band = {0, 0}};
    tl_error error;
    tl_lua_read_function(L, AT_TABLE, "record", record_keys, &options);
    read_band(L, options.band);
    holder *h = push_record(L);
    const int made = lua_gettop(L);
    const bool listed = lua_getfield(L, AT_TABLE, "at") != LUA_TNIL;
    if (listed == (options.file != NULL))
        tl_lua_fail(L, "record: give either file, or samples in at");
    size_t count = 0;
    const double *samples = listed ? read_samples(L, &count) : NULL;
    const tl_status status = listed ? tl_record_make(samples, count, &options, &h->record, &error)
                                    : tl_record_read(&options, &h->record, &error);
    if (status != TL_OK)
        return tl_lua_raise(L, &error);
    lua_settop(L, made);
    return 1;
}

/* ---------------------------------------------------------------- drives ------------------ */

bool tl_lua_record_velocity(lua_State *L, const tl_record *records[3], tl_vec3 *constant)
{
    bool some = false;
    const int list = lua_gettop(L);
    if (!lua_istable(L, list) || lua_rawlen(L, list) != 3)
        return false;
    for (int k = 0; k < 3; k++) {
        lua_rawgeti(L, list, k + 1);
        const holder *h = luaL_testudata(L, -1, RECORD);
        records[k] = h ? h->record : NULL;
        some = some || h;
        lua_pop(L, 1);
    }
    for (int k = 0; some && k < 3; k++) {
        lua_rawgeti(L, list, k + 1);
        (&constant->x)[k] = records[k] ? 0 : number_at(L, -1, "a component of a velocity that is no record");
        lua_pop(L, 1);
    }
    return some;
}

const tl_lua_topic tl_lua_record_topics[] = {
    {.name = "record",
     .usage = "rec = talus.record{at = {0, 1, -1, 0}, dt = 0.01}",
     .function = "record",
     .keys = record_keys,
     .title = "Methods and fields of a record",
     .verbs = record_results,
     .call = module_record},
    {.name = NULL},
};
