/* water.c - water in joints, in Lua: model:water, which places elements of the kind "water". */
#include "lua/water.h"

#include "lua/convert.h"
#include "lua/element.h"
#include "lua/fail.h"
#include "lua/flow.h"
#include "lua/item.h"
#include "lua/living.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elements.h>

#define KIND "water"

/* Puts a copy of the table at index 3 at the top, with the source, the joints as one text, and no function. */
static void push_parameters(lua_State *L, const char *source)
{
    lua_newtable(L);
    const int to = lua_gettop(L);
    if (!lua_isnil(L, 3) && !lua_istable(L, 3))
        tl_lua_fail(L, "water: give the parameters in a table, not %s", tl_lua_describe(L, 3));
    lua_pushnil(L);
    while (lua_istable(L, 3) && lua_next(L, 3)) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_settable(L, to);
    }
    if (lua_getfield(L, to, "joints") == LUA_TTABLE) {
        const int list = lua_gettop(L);
        const size_t count = lua_rawlen(L, list);
        luaL_Buffer text;
        tl_lua_check_list(L, list, "water: joints", count);
        if (count == 0)
            tl_lua_fail(L, "water: joints is an empty list: name joints, or leave it out for all");
        luaL_buffinit(L, &text);
        for (size_t i = 1; i <= count; i++) {
            if (lua_rawgeti(L, list, (lua_Integer)i) != LUA_TSTRING)
                tl_lua_fail(L, "water: joints must be names of joints, not %s", tl_lua_describe(L, -1));
            luaL_addvalue(&text);
            if (i < count)
                luaL_addchar(&text, ',');
        }
        luaL_pushresult(&text);
        lua_setfield(L, to, "joints");
    }
    lua_settop(L, to);
    lua_pushstring(L, source);
    lua_setfield(L, to, "source");
}

/* Asks the function at index `function` for the pressures at some places: a list of them is pushed. The places are
 * those of nodes to come, so the function may only read the model. */
static const double *ask_pressures(lua_State *L, tl_model *model, int function, const tl_args *args)
{
    tl_vec3 *places;
    size_t count;
    tl_lua_ok(L, model, tl_model_element_places(model, KIND, args, 1, &places, &count));
    const tl_lua_asked asked = {0, DBL_MAX, true, "water: pressure must give a number of at least 0, Pa"};
    return tl_lua_ask_places(L, function, places, 0, count, &asked);
}

/* Gives the nodes of a field their pressures, in the order in which they were asked for. */
static tl_status put_pressures(tl_model *model, const tl_lua_selection *made, const double *pressure)
{
    tl_status status = TL_OK;
    const tl_id *ids = made->names;
    for (size_t i = 0; i < made->count && status == TL_OK; i++) {
        tl_element_info info;
        status = tl_element_get(model, ids[i], &info);
        for (size_t k = 0; status == TL_OK && k < info.nodes; k++)
            status = tl_element_put(model, ids[i], k, "source", *pressure++);
    }
    return status;
}

/* Takes all water away. */
static int drain(lua_State *L, tl_model *model)
{
    const char *const kinds[] = {KIND, TL_LUA_FLOW};
    tl_lua_selection *all = NULL;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        tl_element_filter filter = {.size = sizeof filter, .kind = kinds[k]};
        all = tl_lua_elements_push(L, model, &filter);
        tl_lua_ok(L, model, tl_elements_delete(model, all->names, all->count));
        all->count = 0;
    }
    return 1;
}

static int model_water(lua_State *L, tl_model *model)
{
    const char *source = tl_lua_text(L, 2, "water", "where the pressure comes from");
    if (strcmp(source, "none") == 0 && lua_isnil(L, 3))
        return drain(L, model);
    push_parameters(L, source);
    if (strcmp(source, TL_LUA_FLOW) == 0)
        return tl_lua_flow_place(L, model);
    const int table = lua_gettop(L), function = table + 1;
    const bool field = strcmp(source, "field") == 0;
    if (lua_getfield(L, table, "pressure") == LUA_TFUNCTION && field) {
        lua_pushnil(L);
        lua_setfield(L, table, "pressure");
    } else if (field) {
        tl_lua_fail(L, "water: pressure of a field must be a function(x, y, z) that gives Pa, not %s",
                    tl_lua_describe(L, -1));
    }
    tl_args args;
    tl_lua_args(L, table, "water", NULL, &args);
    const double *pressure = field ? ask_pressures(L, model, function, &args) : NULL;
    const tl_lua_selection *made = tl_lua_elements_make(L, model, KIND, &args);
    if (field)
        tl_lua_ok(L, model, put_pressures(model, made, pressure));
    return 1;
}

static const tl_lua_key keys[] = {
    {"level", "number", "of a level table: its height z, m"},
    {"dip", "number", "of a table that dips, degrees: with dip_direction and origin in the place of level"},
    {"dip_direction", "number", "likewise, degrees"},
    {"origin", "{x, y, z}", "a point of it, m"},
    {"unit_weight", "number", "of the water under a table, N/m3; 9810 when left out"},
    {"factor", "number", "of the pressure under a table, as drains leave it; 1 when left out"},
    {"pressure", "number or function(x, y, z)",
     "uniform pressure, Pa; or of a field, asked once for each node and then kept"},
    {"joints", "name or list of names", "joints that have this water, \"A\", \"A:3\" or \"*\"; all when left out"},
    {"aperture", "number, {JOINT = number} or function(x, y, z)",
     "of \"flow\", m: hydraulic aperture of walls that just touch, of all joints, by joint with \"*\" for the others, "
     "or "
     "asked once for each wet joint, at its middle; it grows as the joint opens and falls as it closes"},
    {"residual", "number", "likewise: least aperture; 2e-5 when left out"},
    {"maximum", "number", "likewise: largest aperture that counts; 2e-3 when left out"},
    {"viscosity", "number", "likewise, Pa s; 1e-3 when left out"},
    {"heads", "list of {inside = {min = {x, y, z}, max = {x, y, z}}, head = number}",
     "likewise: heads, m above z = 0, of the edges of wet joints whose middle lies in a box"},
    {"drains", "list of {{x, y, z}, {x, y, z}, radius}", "likewise: holes of a radius, m, in which the pressure is 0"},
    {"steady", "true or false", "likewise: true, when left out, for water in balance; false: joints store water"},
    {"every", "number",
     "likewise: steps between two solutions; 100 of steady flow and 1 of stored water when left out"},
    {"bulk", "number", "likewise: bulk modulus of water that is stored, Pa; 2e9 when left out"},
    {"initial_head", "number", "likewise: head at the beginning where flow is not steady; without it pressure is 0, m"},
    {"drain_gap", "number", "mean opening beyond which a joint runs dry, m; 0.05 when left out"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_water_topics[] = {
    {.name = "water",
     .usage =
         "selection = model:water(\"table\", {level = 20})  or  model:water(\"uniform\", {pressure = 65e3, joints = "
         "{\"J1\"}})  or  model:water(\"field\", {pressure = function(x, y, z) return 9810 * z end})  or  "
         "model:water(\"none\")  or  model:water(\"flow\", {aperture = 2e-4, heads = {{inside = {min = {-2, -2, -2}, "
         "max = "
         "{2, 2, 2}}, head = 20}}})",
     .doc =
         "Lets water press on the walls of joints: on the polygons in which a face of one block faces one of "
         "another, in contact or not. A later call takes the place of earlier water on the same walls; \"none\" takes "
         "it away, from some joints or from all. A joint keeps its water until its mean opening passes drain_gap; "
         "then it is dry. Of \"flow\" pressures are found by the cubic law, between heads and drains, with apertures "
         "that follow the joints: model:flow tells what flows. What the laws see is the effective force. Keyblocks "
         "take water as a force. The elements "
         "have the states area, opening and dry, their nodes pressure.",
     .keys = keys,
     .arguments = 2,
     .method = model_water},
    {.name = "flow",
     .usage = "model:water(\"flow\", {aperture = 2e-4, steady = false}); result = model:flow()",
     .doc =
         "What flows in the joints, as of the last solution: lists heads and drains, in the order in which they were "
         "given, of tables with flow, m3/s into the rock, and closed, true when it reaches no joint any more; joints, "
         "the selection of wet joints, with area, aperture, "
         "flow, head and closed; and closed, how many of them reach neither a head nor a drain.",
     .arguments = 0,
     .method = tl_lua_model_flow},
    {.name = NULL},
};
