/* deformable.c - solids, and blocks that get zones, in Lua: model:solid, selection:deformable. */
#include "lua/deformable.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- solids ----------------- */

static int model_solid(lua_State *L, tl_model *model)
{
    const char *name = tl_lua_text(L, 2, "solid", "the solid's name");
    const bool kinded = !lua_isnil(L, 4) || lua_type(L, 3) == LUA_TSTRING;
    const char *kind = kinded ? tl_lua_text(L, 3, "solid", "the name of its kind") : NULL;
    const char *context = lua_pushfstring(L, "solid '%s'", name);
    if (!kind && !lua_istable(L, 3))
        tl_lua_fail(L, "%s: give a kind of solid, or a table of properties to change, not %s", context,
                    tl_lua_describe(L, 3));
    tl_args args;
    tl_lua_args(L, kind ? 4 : 3, context, NULL, &args);
    tl_lua_ok(L, model, tl_model_solid(model, name, kind, &args));
    return 0;
}

/* ---------------------------------------------------------------- sizes of zones --------- */

/* Places on the stack of selection:deformable. */
enum { AT_BLOCKS = 1, AT_TABLE, AT_FUNCTION, AT_ERROR };

/* A function of the script that tells the wanted edge. */
typedef struct edge_of {
    lua_State *L;
    tl_lua_model *owner;
    tl_vec3 place;
    double edge;
    bool failed; /* its error is at AT_ERROR */
} edge_of;

/* Runs protected. Arguments: the edge_of, the function. */
static int call_edge(lua_State *L)
{
    edge_of *of = lua_touserdata(L, 1);
    lua_pushvalue(L, 2);
    tl_lua_push_numbers(L, &of->place.x, 3);
    lua_call(L, 1, 1);
    const double edge = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : NAN;
    if (!(edge > 0) || isinf(edge))
        tl_lua_fail_in(L, 2, "deformable: zone must give the edge of zones there, a number above 0 m: it gave %s",
                       tl_lua_describe(L, -1));
    of->edge = edge;
    return 0;
}

static double edge_at(void *user, tl_vec3 place)
{
    edge_of *of = user;
    lua_State *L = of->L;
    if (of->failed)
        return NAN;
    of->place = place;
    lua_pushcfunction(L, call_edge);
    lua_pushlightuserdata(L, of);
    lua_pushvalue(L, AT_FUNCTION);
    if (tl_lua_call_reading(L, of->owner, 2, 0) == LUA_OK)
        return of->edge;
    of->failed = true;
    lua_replace(L, AT_ERROR);
    return NAN;
}

/* ---------------------------------------------------------------- zoning ----------------- */

static const tl_param deformable_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_zoning, solid, "", "name of the solid that the zones are made of: model:solid",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_STRING, tl_zoning, file, "",
             "or a mesh whose tetrahedra fill the blocks: legacy VTK, or gmsh 2.2 as text",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_FILE),
};

static const tl_lua_key deformable_keys[] = {
    {"zone", "number or function({x, y, z})",
     "wanted edge of zones, m, > 0, the same everywhere or at a place; required without a file. Larger than a block: "
     "zones between its corners and its centroid"},
    {NULL, NULL, NULL},
};

static const tl_lua_spec deformable_spec = {"deformable", deformable_params, TL_LUA_COUNT(deformable_params),
                                            deformable_keys};

/* Reads what the table asks for; a function goes to its place on the stack. */
static void read_zoning(lua_State *L, edge_of *of, tl_zoning *how)
{
    if (!lua_istable(L, AT_TABLE))
        tl_lua_fail(L, "deformable: give the parameters in a table, as in {zone = 1.0, solid = \"granite\"}, not %s",
                    tl_lua_describe(L, AT_TABLE));
    tl_lua_read(L, AT_TABLE, &deformable_spec, true, how);
    lua_settop(L, AT_TABLE);
    const bool read = how->file != NULL;
    const int type = lua_getfield(L, AT_TABLE, "zone");
    if (read && type != LUA_TNIL)
        tl_lua_fail(L, "deformable: give zone, the edge of zones, or file, a mesh of them, not both");
    if (type == LUA_TFUNCTION) {
        how->edge_at = edge_at;
        how->user = of;
    } else if (!read && (type != LUA_TNUMBER || !(lua_tonumber(L, -1) > 0))) {
        tl_lua_fail(
            L, "deformable: zone must be the wanted edge of zones, a number above 0 m or a function({x, y, z}), not %s",
            tl_lua_describe(L, -1));
    }
    how->edge = type == LUA_TNUMBER ? lua_tonumber(L, -1) : NAN;
    lua_pushnil(L);
}

static void push_zoned(lua_State *L, const tl_lua_selection *blocks, const tl_zoned *made, size_t bytes)
{
    lua_createtable(L, 0, 9);
    TL_LUA_SET_COUNTS(L, {"blocks", made->blocks}, {"zones", made->zones}, {"gridpoints", made->gridpoints},
                      {"clusters", made->clusters}, {"memory", bytes});
    if (made->blocks == 0)
        return;
    TL_LUA_SET_NUMBERS(L, {"smallest_altitude", made->least_altitude}, {"altitude_ratio", made->least_share},
                       {"time_step", made->time_step}, {"inertia", made->inertia});
    lua_getiuservalue(L, AT_BLOCKS, 1);
    tl_lua_item_push_name(L, blocks->kind, lua_gettop(L), &made->worst);
    lua_setfield(L, -3, "worst_block");
    lua_pop(L, 1);
}

int tl_lua_deformable(lua_State *L, const tl_lua_selection *blocks)
{
    tl_model *model = tl_lua_living(L, blocks->owner);
    edge_of of = {.L = L, .owner = blocks->owner};
    tl_zoning how = tl_zoning_default();
    tl_zoned made = {0};
    lua_settop(L, AT_TABLE);
    read_zoning(L, &of, &how);
    const size_t before = tl_model_memory(model).total;
    const tl_status status = tl_blocks_deform(model, blocks->names, blocks->count, &how, &made);
    if (of.failed) {
        lua_settop(L, AT_ERROR);
        return lua_error(L);
    }
    tl_lua_ok(L, model, status);
    const size_t after = tl_model_memory(model).total;
    push_zoned(L, blocks, &made, after > before ? after - before : 0);
    return 1;
}

/* ---------------------------------------------------------------- help ------------------- */

static const tl_lua_key deformable_results[] = {
    {"blocks, zones, gridpoints, clusters", "", "how many have been made"},
    {"smallest_altitude", "", "of a zone over its largest side, m"},
    {"altitude_ratio", "", "smallest altitude over the wanted edge; of a file over the mean edge of the zone (rms)"},
    {"worst_block", "", "the block that has it"},
    {"time_step", "", "step that the gridpoints would allow if nothing touched them, s"},
    {"inertia", "",
     "largest ratio of the inertia of a block's gridpoints to that of the block: about 1 + 2/n^2 of n zones to an "
     "edge. "
     "Blocks that topple or rock in time want 8 zones to an edge, or stay rigid"},
    {"memory", "", "that the model has grown by, bytes"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_deformable_topics[] = {
    {.name = "solid",
     .usage = "model:solid(\"granite\", \"SOLID\", {...})  or  model:solid(\"granite\", {young = 2e9})",
     .doc = "Names a solid, the material of zones: a kind of solid with its properties. Without a kind it changes "
            "properties of one that has been named. Zones keep their stress, and the states that the new kind has by "
            "the same names.",
     .has_type = true,
     .type = TL_KIND_SOLID,
     .arguments = 3,
     .method = model_solid},
    {.name = "deformable",
     .usage = "report = selection:deformable{zone = 1.0, solid = \"granite\"}",
     .doc =
         "Divides blocks into zones: tetrahedra of constant strain, whose corners are gridpoints. They are free of "
         "stress where the blocks are, and move as the blocks did. Joined blocks come all at once: they share "
         "gridpoints, "
         "so zones go on over the faces between them. With {file = \"rock.msh\", solid = \"granite\"} the tetrahedra "
         "of a mesh that was made elsewhere become the zones of the blocks in which they lie. They must fill these "
         "within 1e-6 of their size. Nothing is done where one block cannot be divided.",
     .spec = &deformable_spec,
     .title = "Fields of the report",
     .verbs = deformable_results},
    {.name = NULL},
};
