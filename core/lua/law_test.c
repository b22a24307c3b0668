/* law_test.c - talus.law_test: a joint law on one contact point, and its curve as lists. */
#include "lua/law_test.h"

#include "lua/convert.h"
#include "lua/fail.h"

#include <math.h>
#include <string.h>

/* Where the function keeps its argument on the Lua stack. */
#define AT_TABLE 1

static const tl_lua_key law_test_keys[] = {
    {"params", "{NAME = value}", "parameters of the law, as for model:joint"},
    {"path", "list of numbers or legs",
     "shear displacements, m, one after the other from 0; or legs, tables {shear = m, closure = m, "
     "normal_stress = Pa, time = s, speed = m/s, steps =}: values at the end of the leg, what is "
     "not named stays; a leg with only a time waits"},
    {NULL, NULL, NULL},
};

static const tl_lua_key law_test_results[] = {
    {"time, shear", "", "lists: seconds, and shear displacement, m; the first point is the start"},
    {"shear_stress, normal_stress", "", "lists, Pa, compression positive"},
    {"closure, dilation", "",
     "lists, m: how far the walls have approached, and how far they have parted since the start"},
    {"work", "", "list, J/m2: work of the walls, and what was stored at the start"},
    {"stored, heat", "",
     "lists, J/m2: elastic energy, and energy turned to heat, as the law tells them. Work - stored "
     "- heat is the error of the law's energies and of the steps"},
    {"slipping, open, failed", "", "lists of true and false, as the law flags the point"},
    {"states", "", "a list for each state of the law, by its name; of vectors where it is one"},
    {"ends", "", "for each leg, the place of its last point in the lists"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- path ------------------- */

/* The leg at the top of the stack, number `k`. */
static tl_law_leg read_leg(lua_State *L, size_t k)
{
    tl_law_leg leg = {NAN, NAN, NAN, NAN, NAN, 0};
    const char *context = lua_pushfstring(L, "law_test, path[%I]", (lua_Integer)k);
    if (lua_type(L, -2) != LUA_TNUMBER && lua_type(L, -2) != LUA_TTABLE)
        tl_lua_fail(L, "%s must be a shear displacement in m or a table {shear = ...}, not %s", context,
                    tl_lua_describe(L, -2));
    tl_lua_spec spec = tl_lua_spec_of("law_leg", NULL);
    spec.context = context;
    if (lua_type(L, -2) == LUA_TNUMBER)
        tl_lua_read_one(L, -2, &spec, "shear", &leg);
    else
        tl_lua_read(L, -2, &spec, false, &leg);
    return leg;
}

/* Reads the path into a userdata that stays on the stack. */
static void read_path(lua_State *L, tl_law_test *test)
{
    if (lua_getfield(L, AT_TABLE, "path") != LUA_TTABLE)
        tl_lua_fail(L, "law_test: path must be a list of legs, as in {0.005, -0.005}, not %s", tl_lua_describe(L, -1));
    int path = lua_gettop(L);
    test->count = (size_t)lua_rawlen(L, path);
    for (lua_pushnil(L); lua_next(L, path); lua_pop(L, 1))
        if (!lua_isinteger(L, -2) || lua_tointeger(L, -2) < 1 || lua_tointeger(L, -2) > (lua_Integer)test->count)
            tl_lua_fail(L, "law_test: path must be a list of legs, without names and gaps: a "
                           "single leg is {{shear = ...}}");
    tl_law_leg *legs = lua_newuserdatauv(L, test->count * sizeof *legs, 0);
    test->path = legs;
    for (size_t k = 0; k < test->count; k++) {
        int top = lua_gettop(L);
        lua_rawgeti(L, path, (lua_Integer)k + 1);
        legs[k] = read_leg(L, k + 1);
        lua_settop(L, top);
    }
}

/* ---------------------------------------------------------------- curve ------------------ */

typedef struct curve {
    const tl_law_point *points;
    size_t count;
} curve;

/* Distance of one point's numbers from those of the next. */
#define STEP (sizeof(tl_law_point) / sizeof(double))

/* Sets the table on the stack's top: a list of a number of each point, which is at `first` in the first one. */
static void set_list(lua_State *L, const char *name, const curve *c, const double *first)
{
    tl_lua_push_rows(L, first, c->count, STEP, 0);
    lua_setfield(L, -2, name);
}

static void set_flags(lua_State *L, const char *name, const curve *c, uint32_t flag)
{
    lua_createtable(L, (int)c->count, 0);
    for (size_t i = 0; i < c->count; i++) {
        lua_pushboolean(L, (c->points[i].flags & flag) != 0);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, name);
}

static void set_dilation(lua_State *L, const curve *c)
{
    lua_createtable(L, (int)c->count, 0);
    for (size_t i = 0; i < c->count; i++) {
        lua_pushnumber(L, c->points[0].closure - c->points[i].closure);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "dilation");
}

static void set_states(lua_State *L, const tl_kind *law, const curve *c)
{
    size_t column = 0;
    lua_createtable(L, 0, (int)law->state_count);
    for (uint32_t k = 0; k < law->state_count; k++) {
        const tl_state *state = &law->states[k];
        bool vector = state->kind == TL_STATE_TANGENT;
        tl_lua_push_rows(L, c->points->state + column, c->count, STEP, vector ? 3 : 0);
        lua_setfield(L, -2, state->name);
        column += vector ? 3 : 1;
    }
    lua_setfield(L, -2, "states");
}

static void push_curve(lua_State *L, const tl_kind *law, const curve *c, const size_t *ends, size_t legs)
{
    lua_createtable(L, 0, 16);
    set_list(L, "time", c, &c->points->time);
    set_list(L, "shear", c, &c->points->shear);
    set_list(L, "shear_stress", c, &c->points->shear_stress);
    set_list(L, "normal_stress", c, &c->points->normal_stress);
    set_list(L, "closure", c, &c->points->closure);
    set_dilation(L, c);
    set_list(L, "work", c, &c->points->work);
    set_list(L, "stored", c, &c->points->stored);
    set_list(L, "heat", c, &c->points->heat);
    set_flags(L, "slipping", c, TL_POINT_SLIPPING);
    set_flags(L, "open", c, TL_POINT_OPEN);
    set_flags(L, "failed", c, TL_POINT_FAILED);
    set_states(L, law, c);
    lua_createtable(L, (int)legs, 0);
    for (size_t k = 0; k < legs; k++) {
        lua_pushinteger(L, (lua_Integer)ends[k] + 1);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    lua_setfield(L, -2, "ends");
}

static int module_law_test(lua_State *L)
{
    tl_lua_arity(L, 1, "law_test");
    lua_settop(L, 1);
    tl_law_test test;
    tl_error error;
    tl_lua_read_function(L, AT_TABLE, "law_test", law_test_keys, &test);
    read_path(L, &test);
    lua_getfield(L, AT_TABLE, "params");
    const char *context = lua_pushfstring(L, "law_test, law '%s'", test.law);
    tl_args args;
    tl_lua_args(L, -2, context, NULL, &args);
    test.params = &args;
    size_t count;
    if (tl_law_test_points(&test, &count, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    tl_law_point *points = lua_newuserdatauv(L, count * sizeof *points, 0);
    size_t *ends = lua_newuserdatauv(L, test.count * sizeof *ends, 0);
    const tl_kind *law;
    if (tl_law_test_run(&test, points, ends, &law, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    const curve c = {points, count};
    push_curve(L, law, &c, ends, test.count);
    return 1;
}

const tl_lua_topic tl_lua_law_test_topics[] = {
    {.name = "law_test",
     .usage = "curve = talus.law_test{law = \"coulomb\", params = {kn = 1e10, ks = 1e9, friction = "
              "30}, normal_stress = 1e6, path = {0.005, -0.005}}",
     .function = "law_test",
     .keys = law_test_keys,
     .title = "Fields of the curve",
     .verbs = law_test_results,
     .call = module_law_test},
    {.name = NULL},
};
