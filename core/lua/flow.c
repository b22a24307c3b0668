/* flow.c - water that flows in joints, in Lua: model:water("flow") and model:flow.
 *
 * The kind takes heads and drains as three points each, and apertures by joint as one text. An aperture that is a
 * function is asked once for each wet joint; the states of its nodes then have what it gave. */
#include "lua/flow.h"

#include "lua/convert.h"
#include "lua/element.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elements.h>
#include <talus/number.h>
#include <talus/plugins.h>
#include <talus/vmath.h>

/* Roles of elements of the kind, its state "role"; others are drains. */
enum { JOINT, HEAD };

/* ---------------------------------------------------------------- heads and drains ------- */

static void push_vec3(lua_State *L, tl_vec3 v)
{
    const double x[] = {v.x, v.y, v.z};
    lua_createtable(L, 3, 0);
    for (int k = 0; k < 3; k++) {
        lua_pushnumber(L, x[k]);
        lua_rawseti(L, -2, k + 1);
    }
}

/* Appends a point to the list at index `list`. */
static void append(lua_State *L, int list, tl_vec3 v)
{
    push_vec3(L, v);
    lua_rawseti(L, list, (lua_Integer)lua_rawlen(L, list) + 1);
}

typedef struct given_head {
    double head;
} given_head;

/* Appends the three points of the head at the top of the stack. */
static void read_head(lua_State *L, int list, int number)
{
    static const tl_param params[] = {
        TL_PARAM(TL_PARAM_REAL, given_head, head, "m", "head above z = 0", .flags = TL_PARAM_REQUIRED)};
    static const tl_lua_key keys[] = {{"inside", "box", ""}, {NULL, NULL, NULL}};
    const int at = lua_gettop(L);
    const char *context = lua_pushfstring(L, "water 'flow', head %d", number);
    const tl_lua_spec spec = {context, params, TL_LUA_COUNT(params), keys};
    given_head given;
    tl_bounds box;
    tl_lua_read(L, at, &spec, false, &given);
    if (!tl_lua_read_box(L, at, context, "inside", &box))
        tl_lua_fail(L, "%s: inside is missing: the box of the edges of joints that have the head", context);
    append(L, list, box.min);
    append(L, list, box.max);
    append(L, list, tl_v3(given.head, 0, 0));
}

/* Appends the three points of the drain at the top of the stack. */
static void read_drain(lua_State *L, int list, int number)
{
    const int at = lua_gettop(L);
    double x[7];
    for (int k = 0; k < 7; k++) {
        const int type = lua_rawgeti(L, at, k < 6 ? k / 3 + 1 : 3);
        if (k < 6 && type == LUA_TTABLE)
            lua_rawgeti(L, -1, k % 3 + 1);
        if (lua_type(L, -1) != LUA_TNUMBER || lua_rawlen(L, at) != 3)
            tl_lua_fail(L, "water 'flow', drain %d: give {from, to, radius}: two points, each {x, y, z}, and a number",
                        number);
        x[k] = lua_tonumber(L, -1);
        lua_settop(L, at);
    }
    append(L, list, tl_v3(x[0], x[1], x[2]));
    append(L, list, tl_v3(x[3], x[4], x[5]));
    append(L, list, tl_v3(x[6], 0, 0));
}

/* Puts points in the place of the list `name` of the table at index `table`. */
static void convert(lua_State *L, int table, const char *name, void (*read)(lua_State *, int, int))
{
    const int top = lua_gettop(L);
    if (lua_getfield(L, table, name) == LUA_TNIL) {
        lua_settop(L, top);
        return;
    }
    const int from = lua_gettop(L);
    if (!lua_istable(L, from))
        tl_lua_fail(L, "water 'flow': %s must be a list, not %s", name, tl_lua_describe(L, from));
    const size_t count = lua_rawlen(L, from);
    tl_lua_check_list(L, from, lua_pushfstring(L, "water 'flow': %s", name), count);
    lua_newtable(L);
    const int list = lua_gettop(L);
    for (size_t i = 1; i <= count; i++) {
        if (lua_rawgeti(L, from, (lua_Integer)i) != LUA_TTABLE)
            tl_lua_fail(L, "water 'flow': entry %d of %s must be a table, not %s", (int)i, name,
                        tl_lua_describe(L, -1));
        read(L, list, (int)i);
        lua_settop(L, list);
    }
    if (count == 0)
        lua_pushnil(L);
    lua_setfield(L, table, name);
    lua_settop(L, top);
}

/* ---------------------------------------------------------------- apertures -------------- */

/* Names of planes come after those of joints, and "*" before all. */
static int rank_of(const char *name)
{
    return strcmp(name, "*") == 0 ? 0 : strchr(name, ':') ? 2 : 1;
}

static int compare_names(const void *a, const void *b)
{
    const char *const *x = a, *const *y = b;
    const int p = rank_of(*x), q = rank_of(*y);
    return p != q ? p - q : strcmp(*x, *y);
}

/* Makes one number and a text of the table of apertures by joint at index `from`. */
static void by_joint(lua_State *L, int table, int from)
{
    size_t count = 0, at = 0;
    for (lua_pushnil(L); lua_next(L, from); lua_pop(L, 1), count++)
        if (lua_type(L, -2) != LUA_TSTRING || lua_type(L, -1) != LUA_TNUMBER)
            tl_lua_fail(L, "water 'flow': aperture by joint must have names of joints and numbers, m, not %s = %s",
                        tl_lua_describe(L, -2), tl_lua_describe(L, -1));
    const char **name = lua_newuserdatauv(L, (count + 1) * sizeof *name, 0);
    for (lua_pushnil(L); lua_next(L, from); lua_pop(L, 1))
        name[at++] = lua_tostring(L, -2); /* the table keeps it */
    qsort(name, count, sizeof *name, compare_names);
    if (count == 0 || strcmp(name[0], "*") != 0)
        tl_lua_fail(L, "water 'flow': aperture by joint needs \"*\", for joints that it does not name");
    luaL_Buffer text;
    lua_getfield(L, from, "*");
    lua_setfield(L, table, "aperture");
    luaL_buffinit(L, &text);
    for (size_t i = 1; i < count; i++) {
        char number[32];
        lua_getfield(L, from, name[i]);
        tl_text_print(number, sizeof number, "%.17g", lua_tonumber(L, -1));
        lua_pop(L, 1);
        luaL_addstring(&text, i > 1 ? "," : "");
        luaL_addstring(&text, name[i]);
        luaL_addstring(&text, "=");
        luaL_addstring(&text, number);
    }
    luaL_pushresult(&text);
    lua_setfield(L, table, "apertures");
}

/* A parameter as it will be: what the table has, or the kind's default. */
static double number_of(lua_State *L, int table, const tl_kind *kind, const char *name)
{
    double value = NAN;
    for (uint32_t k = 0; k < kind->param_count; k++)
        if (strcmp(kind->params[k].name, name) == 0)
            value = kind->params[k].def[0];
    if (lua_getfield(L, table, name) == LUA_TNUMBER)
        value = lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

/* Asks a function for apertures of the elements to be: a list of numbers is pushed. Heads and drains come first. */
static const double *ask_apertures(lua_State *L, tl_model *model, int table, int function, const tl_args *args)
{
    tl_vec3 *places;
    size_t count;
    const tl_kind *kind = tl_plugin_find(TL_KIND_ELEMENT, TL_LUA_FLOW);
    tl_lua_ok(L, model, tl_model_element_middles(model, TL_LUA_FLOW, args, 1, &places, &count));
    size_t ends = 0;
    for (int k = 0; k < 2; k++) {
        ends += lua_getfield(L, table, k ? "drains" : "heads") == LUA_TTABLE ? lua_rawlen(L, -1) / 3 : 0;
        lua_pop(L, 1);
    }
    const double residual = number_of(L, table, kind, "residual"), maximum = number_of(L, table, kind, "maximum");
    char must[160];
    tl_text_print(must, sizeof must,
                  "water 'flow': aperture must give a number above residual = %g and at most maximum = %g, m", residual,
                  maximum);
    const tl_lua_asked asked = {residual, maximum, false, must};
    return tl_lua_ask_places(L, function, places, ends, count, &asked);
}

/* Gives the nodes of elements the apertures, in the order in which they were asked for. */
static tl_status put_apertures(tl_model *model, const tl_lua_selection *made, const double *aperture)
{
    tl_status status = TL_OK;
    const tl_id *ids = made->names;
    for (size_t i = 0; i < made->count && status == TL_OK; i++) {
        tl_element_info info;
        status = tl_element_get(model, ids[i], &info);
        for (size_t k = 0; status == TL_OK && k < info.nodes; k++)
            status = tl_element_put(model, ids[i], k, "touching", aperture[i]);
        if (status == TL_OK) /* it is counted for the new aperture */
            status = tl_element_put(model, ids[i], SIZE_MAX, "void", 0);
    }
    return status == TL_OK ? tl_elements_renew(model) : status;
}

/* ---------------------------------------------------------------- methods ---------------- */

int tl_lua_flow_place(lua_State *L, tl_model *model)
{
    const int table = lua_gettop(L);
    tl_args args;
    lua_pushnil(L);
    lua_setfield(L, table, "source");
    convert(L, table, "heads", read_head);
    convert(L, table, "drains", read_drain);
    const int type = lua_getfield(L, table, "aperture"), function = lua_gettop(L);
    if (type == LUA_TTABLE) {
        by_joint(L, table, function);
    } else if (type == LUA_TFUNCTION) { /* any that is allowed: each joint gets its own */
        lua_pushnumber(L, number_of(L, table, tl_plugin_find(TL_KIND_ELEMENT, TL_LUA_FLOW), "maximum"));
        lua_setfield(L, table, "aperture");
    }
    tl_lua_args(L, table, "water 'flow'", NULL, &args);
    const double *aperture = type == LUA_TFUNCTION ? ask_apertures(L, model, table, function, &args) : NULL;
    const tl_lua_selection *made = tl_lua_elements_make(L, model, TL_LUA_FLOW, &args);
    if (aperture)
        tl_lua_ok(L, model, put_apertures(model, made, aperture));
    return 1;
}

static double state_of(lua_State *L, tl_model *model, tl_id id, const char *name)
{
    double value;
    tl_lua_ok(L, model, tl_element_value(model, id, SIZE_MAX, name, &value));
    return value;
}

int tl_lua_model_flow(lua_State *L, tl_model *model)
{
    const tl_element_filter filter = {.size = sizeof filter, .kind = TL_LUA_FLOW};
    lua_createtable(L, 0, 4);
    const int result = lua_gettop(L);
    tl_lua_selection *all = tl_lua_elements_push(L, model, &filter);
    tl_id *ids = all->names;
    lua_newtable(L); /* heads */
    lua_newtable(L); /* drains */
    size_t joints = 0;
    double closed = 0;
    for (size_t i = 0; i < all->count; i++) {
        const int role = (int)state_of(L, model, ids[i], "role");
        if (role == JOINT) {
            closed += state_of(L, model, ids[i], "closed");
            ids[joints++] = ids[i];
            continue;
        }
        lua_createtable(L, 0, 3);
        tl_lua_set_number(L, "flow", state_of(L, model, ids[i], "flow"));
        lua_pushboolean(L, state_of(L, model, ids[i], "closed") != 0);
        lua_setfield(L, -2, "closed");
        if (role == HEAD)
            tl_lua_set_number(L, "head", state_of(L, model, ids[i], "head"));
        const int list = result + (role == HEAD ? 2 : 3);
        lua_rawseti(L, list, (lua_Integer)lua_rawlen(L, list) + 1);
    }
    all->count = joints;
    lua_setfield(L, result, "drains");
    lua_setfield(L, result, "heads");
    lua_setfield(L, result, "joints");
    lua_pushinteger(L, (lua_Integer)closed);
    lua_setfield(L, result, "closed");
    return 1;
}
