/* solid_test.c - talus.solid_test: a solid on one zone, and its curve as lists. */
#include "lua/solid_test.h"

#include "lua/convert.h"
#include "lua/fail.h"

#include <math.h>
#include <string.h>

/* Where the function keeps its argument on the Lua stack. */
#define AT_TABLE 1

static const tl_lua_key solid_test_keys[] = {
    {"params", "{NAME = value}", "parameters of the solid, as for model:solid"},
    {"path", "list of legs",
     "tables {strain = {zz = -0.01}, stress = {xx = -1e6, yy = -1e6}, steps =}: components that are driven to strains, "
     "and those that are held at stresses, at the end of the leg. A component that is not named keeps its stress"},
    {"stress", "{xx =, yy =, zz =, xy =, yz =, zx =}", "stress at the start, Pa; 0 where it is left out"},
    {NULL, NULL, NULL},
};

static const tl_lua_key solid_test_results[] = {
    {"stress, strain", "",
     "tables of lists by component, curve.stress.zz[i], Pa; tension positive, shear strains those "
     "of the tensor; the first point is the start"},
    {"work", "", "list, J/m3: work of the stresses, and what was stored at the start"},
    {"stored, dissipated", "",
     "lists, J/m3: elastic energy, and energy turned to heat, as the solid tells them. Work - stored - dissipated is "
     "the error of the solid's energies and of the steps"},
    {"shear, tension, joint", "", "lists of true and false: how the zone yields in the step"},
    {"states", "", "a list for each state of the solid, by its name; of lists where it is an axis or a tensor"},
    {"ends", "", "for each leg, the place of its last point in the lists"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- path ------------------- */

static const tl_sym3 nothing = {NAN, NAN, NAN, NAN, NAN, NAN};

/* Components under a key of the table at the top; NaN where they are not named. */
static tl_sym3 read_components(lua_State *L, const char *context, const char *key)
{
    tl_sym3 out = nothing;
    if (lua_getfield(L, -1, key) != LUA_TNIL) {
        tl_lua_spec spec = tl_lua_spec_of("components", NULL);
        spec.context = lua_pushfstring(L, "%s, %s", context, key);
        tl_lua_read(L, -2, &spec, false, &out);
    }
    return out;
}

/* The leg at the top of the stack, number `k`. */
static tl_solid_leg read_leg(lua_State *L, size_t k)
{
    static const tl_lua_key keys[] = {{"strain", "", ""}, {"stress", "", ""}, {NULL, NULL, NULL}};
    tl_solid_leg leg = {nothing, nothing, 0};
    const int at = lua_gettop(L);
    const char *context = lua_pushfstring(L, "solid_test, path[%I]", (lua_Integer)k);
    if (lua_type(L, at) != LUA_TTABLE)
        tl_lua_fail(L, "%s must be a table {strain = {...}, stress = {...}}, not %s", context, tl_lua_describe(L, at));
    tl_lua_spec spec = tl_lua_spec_of("solid_leg", keys);
    spec.context = context;
    tl_lua_read(L, at, &spec, false, &leg);
    lua_pushvalue(L, at);
    leg.strain = read_components(L, context, "strain");
    lua_pushvalue(L, at);
    leg.stress = read_components(L, context, "stress");
    return leg;
}

/* Reads the path into a userdata that stays on the stack. */
static void read_path(lua_State *L, tl_solid_test *test)
{
    if (lua_getfield(L, AT_TABLE, "path") != LUA_TTABLE)
        tl_lua_fail(L, "solid_test: path must be a list of legs, as in {{strain = {zz = -0.01}}}, not %s",
                    tl_lua_describe(L, -1));
    int path = lua_gettop(L);
    test->count = (size_t)lua_rawlen(L, path);
    tl_lua_check_list(L, path, "solid_test: path", test->count);
    tl_solid_leg *legs = lua_newuserdatauv(L, test->count * sizeof *legs + 1, 0);
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
    const tl_solid_point *points;
    size_t count;
} curve;

/* Distance of one point's numbers from those of the next. */
#define STEP (sizeof(tl_solid_point) / sizeof(double))

/* Sets the table on the stack's top: a list of a number of each point, which is at `first` in the first one. */
static void set_list(lua_State *L, const char *name, const curve *c, const double *first)
{
    tl_lua_push_rows(L, first, c->count, STEP, 0);
    lua_setfield(L, -2, name);
}

static void set_components(lua_State *L, const char *name, const curve *c, const double first[6])
{
    static const char *const components[6] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    lua_createtable(L, 0, 6);
    for (int k = 0; k < 6; k++)
        set_list(L, components[k], c, first + k);
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

static void set_states(lua_State *L, const tl_kind *solid, const curve *c)
{
    static const size_t widths[] = {
        [TL_STATE_SCALAR] = 1, [TL_STATE_TANGENT] = 3, [TL_STATE_AXIS] = 3, [TL_STATE_TENSOR] = 6};
    size_t column = 0;
    lua_createtable(L, 0, (int)solid->state_count);
    for (uint32_t k = 0; k < solid->state_count; k++) {
        const size_t width = widths[solid->states[k].kind];
        tl_lua_push_rows(L, c->points->state + column, c->count, STEP, width > 1 ? width : 0);
        lua_setfield(L, -2, solid->states[k].name);
        column += width;
    }
    lua_setfield(L, -2, "states");
}

static void push_curve(lua_State *L, const tl_kind *solid, const curve *c, const size_t *ends, size_t legs)
{
    lua_createtable(L, 0, 16);
    set_components(L, "stress", c, c->points->stress);
    set_components(L, "strain", c, c->points->strain);
    set_list(L, "work", c, &c->points->work);
    set_list(L, "stored", c, &c->points->stored);
    set_list(L, "dissipated", c, &c->points->dissipated);
    set_flags(L, "shear", c, TL_ZONE_SHEAR);
    set_flags(L, "tension", c, TL_ZONE_TENSION);
    set_flags(L, "joint", c, TL_ZONE_JOINT);
    set_states(L, solid, c);
    lua_createtable(L, (int)legs, 0);
    for (size_t k = 0; k < legs; k++) {
        lua_pushinteger(L, (lua_Integer)ends[k] + 1);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    lua_setfield(L, -2, "ends");
}

static int module_solid_test(lua_State *L)
{
    tl_lua_arity(L, 1, "solid_test");
    lua_settop(L, 1);
    tl_solid_test test = {.solid = NULL};
    tl_error error;
    tl_lua_read_function(L, AT_TABLE, "solid_test", solid_test_keys, &test);
    test.stress = (tl_sym3){0, 0, 0, 0, 0, 0};
    (void)tl_lua_read_tensor(L, AT_TABLE, "solid_test", "stress", &test.stress);
    read_path(L, &test);
    lua_getfield(L, AT_TABLE, "params");
    const char *context = lua_pushfstring(L, "solid_test, solid '%s'", test.solid);
    tl_args args;
    tl_lua_args(L, -2, context, NULL, &args);
    test.params = &args;
    size_t count;
    if (tl_solid_test_points(&test, &count, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    tl_solid_point *points = lua_newuserdatauv(L, count * sizeof *points, 0);
    size_t *ends = lua_newuserdatauv(L, test.count * sizeof *ends, 0);
    const tl_kind *solid;
    if (tl_solid_test_run(&test, points, ends, &solid, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    const curve c = {points, count};
    push_curve(L, solid, &c, ends, test.count);
    return 1;
}

const tl_lua_topic tl_lua_solid_test_topics[] = {
    {.name = "solid_test",
     .usage =
         "curve = talus.solid_test{solid = \"elastic\", params = {young = 1e10, poisson = 0.25}, path = {{stress = "
         "{xx = -1e6, yy = -1e6}, strain = {zz = -0.01}}}}",
     .function = "solid_test",
     .keys = solid_test_keys,
     .title = "Fields of the curve",
     .verbs = solid_test_results,
     .call = module_solid_test},
    {.name = NULL},
};
