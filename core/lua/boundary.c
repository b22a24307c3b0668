/* boundary.c - model:boundary{...}: outer faces of the model, selected, held or loaded. */
#include "lua/boundary.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"
#include "lua/quiet.h"
#include "lua/record.h"

#include <math.h>
#include <string.h>
#include <talus/boundary.h>

#define RESULT_TYPE "talus.boundary"
#define SIDES 6

typedef struct boundary_args {
    const char *side;
    tl_vec3 facing;
    double within, tolerance;
    int32_t fixed, roller, rotation, quiet, free_field;
    const char *joint;
    double p_velocity, s_velocity, density;
    double pressure, water_level, unit_weight;
    tl_vec3 traction, at;
    int32_t add;
} boundary_args;

static const tl_param boundary_params[] = {
    TL_PARAM(TL_PARAM_STRING, boundary_args, side, "",
             "faces in this plane of the box about all blocks: \"xmin\", \"xmax\", \"ymin\", "
             "\"ymax\", \"zmin\" or \"zmax\"",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, boundary_args, facing, "",
             "faces that look so: their normal is within an angle of this vector", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, boundary_args, within, "deg", "this angle", .def = {45.0}, .min = 0.0, .max = 180.0),
    TL_PARAM(TL_PARAM_REAL, boundary_args, tolerance, "m",
             "how far off the plane, or out of the box, a corner may be; 1e-3 of the block's size when left out",
             .min = 0.0, .max = INFINITY, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_BOOL, boundary_args, fixed, "", "holds the bodies in all components", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, boundary_args, roller, "",
             "holds the bodies across their faces; those of rigid blocks must look along x, y or z", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, boundary_args, rotation, "", "with roller: holds the rotation of rigid blocks, too",
             .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, boundary_args, quiet, "",
             "lets waves out, by dashpots (Lysmer and Kuhlemeyer 1969), of rigid blocks behind springs, and bears what "
             "it bore",
             .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, boundary_args, free_field, "",
             "a vertical side of rigid blocks in level rows moves as the ground far away: as a column of such levels, "
             "whose base is that of the call or is held",
             .def = {0.0}),
    TL_PARAM(TL_PARAM_STRING, boundary_args, joint, "",
             "of quiet rigid blocks and free fields: the joint whose law has the stiffness kn and ks of what was cut "
             "off; \"*\" when "
             "left out",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, boundary_args, p_velocity, "m/s",
             "in the place of joint: velocity of pressure waves in what was cut off",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, boundary_args, s_velocity, "m/s", "likewise of shear waves",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, boundary_args, density, "kg/m3",
             "of what was cut off at quiet rigid blocks and free fields; that of the blocks when left out",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, boundary_args, pressure, "Pa", "pressure on the faces, inward", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, boundary_args, water_level, "m",
             "height z of still water before the faces: it presses on what lies below", .min = -INFINITY,
             .max = INFINITY, .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_REAL, boundary_args, unit_weight, "N/m3", "of this water", .def = {9810.0}, .min = 0.0,
             .max = 1e50, .flags = TL_PARAM_MIN_OPEN),
    TL_PARAM(TL_PARAM_VEC3, boundary_args, traction, "Pa", "force per area on the faces", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, boundary_args, at, "m",
             "point at whose height stress holds; the gradient counts from there", .def = {0.0, 0.0, 0.0}),
    TL_PARAM(TL_PARAM_BOOL, boundary_args, add, "", "adds to the loads that the bodies have, in the place of taking it",
             .def = {0.0}),
};

static const tl_lua_key boundary_keys[] = {
    {"plane", "{normal = {x, y, z}, at = {x, y, z}}", "faces in this plane that look along its normal"},
    {"box", "{min = {x, y, z}, max = {x, y, z}}", "faces with all corners in this box"},
    {"stress", "{xx =, yy =, zz =, xy =, yz =, zx =}",
     "stress, Pa, tension positive: the traction on a face is stress times its outward normal"},
    {"gradient", "{xx =, yy =, zz =, xy =, yz =, zx =}", "change of the stress with height z, Pa/m"},
    {"velocity", "{x, y, z} or function(t)",
     "prescribes the velocity of the faces, m/s; rigid bodies move with it whole"},
    {"input", "{x, y, z}, each a record or 0",
     "of quiet faces: velocity of a wave that comes in, by the traction 2 rho c v (Joyner and Chen 1975)"},
    {"xmin, xmax", "\"roller\", \"fixed\", \"free_field\" or a table of what is to be done",
     "several sides in one call"},
    {"ymin, ymax", "\"roller\", \"fixed\" or a table of what is to be done", "likewise"},
    {"zmin, zmax", "\"roller\", \"fixed\" or a table of what is to be done", "likewise"},
    {NULL, NULL, NULL},
};

/* The keys as they stand in a table. */
static const tl_lua_key table_keys[] = {
    {"plane", "", ""}, {"box", "", ""},  {"stress", "", ""}, {"gradient", "", ""}, {"velocity", "", ""},
    {"input", "", ""}, {"xmin", "", ""}, {"xmax", "", ""},   {"ymin", "", ""},     {"ymax", "", ""},
    {"zmin", "", ""},  {"zmax", "", ""}, {NULL, NULL, NULL},
};

static const tl_lua_spec boundary_spec = {"boundary", boundary_params, TL_LUA_COUNT(boundary_params), boundary_keys};

static const tl_lua_key boundary_results[] = {
    {"area", "", "of the outer faces, or their outer parts, m2; without any the call is refused"},
    {"blocks", "", "a selection of their blocks, hidden ones, too"},
    {"faces", "", "each a table {block =, face =, area =, normal =, centroid =}; block.faces[face] is the face"},
    {"force, moment", "", "of the load in all, N, and N m about {0, 0, 0}"},
    {"reaction", "", "now: the force that holds the bodies in their held components, N"},
    {"xmin, xmax", "", "where sides are given: these fields of each, in the place of those above"},
    {"ymin, ymax", "", "where sides are given: these fields of each, likewise"},
    {"zmin, zmax", "", "where sides are given: these fields of each, likewise"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- results ---------------- */

/* What the kernel has found, freed with the Lua object. */
typedef struct holder {
    tl_boundary_result result[SIDES];
} holder;

static int free_results(lua_State *L)
{
    holder *h = lua_touserdata(L, 1);
    for (size_t i = 0; i < SIDES; i++)
        tl_boundary_free(&h->result[i]);
    return 0;
}

static holder *push_holder(lua_State *L)
{
    return tl_lua_hold(L, sizeof(holder), "talus.boundary_holder", free_results);
}

/* result.reaction, and names that a result does not have. */
static int result_index(lua_State *L)
{
    static const char *const names[] = {"area", "blocks", "faces", "force", "moment", "reaction", NULL};
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "the result of boundary has no field %s", tl_lua_describe(L, 2));
    if (strcmp(lua_tostring(L, 2), "reaction") != 0) {
        tl_lua_names known = {0};
        tl_lua_names_list(&known, names);
        return tl_lua_unknown(L, "the result of boundary has no field", lua_tostring(L, 2), &known);
    }
    lua_pushliteral(L, "blocks");
    lua_rawget(L, 1);
    luaL_checkudata(L, -1, TL_LUA_BLOCKS);
    lua_getfield(L, -1, "reaction");
    lua_insert(L, -2);
    lua_call(L, 1, 1);
    return 1;
}

static void push_face(lua_State *L, const tl_boundary_face *face)
{
    lua_createtable(L, 0, 5);
    tl_lua_set_block(L, "block", face->block);
    tl_lua_set_count(L, "face", face->face + 1);
    tl_lua_set_number(L, "area", face->area);
    tl_lua_set_vec3(L, "normal", face->normal);
    tl_lua_set_vec3(L, "centroid", face->centroid);
}

/* Pushes the table of one result; the model's userdata is at index 1. */
static void push_result(lua_State *L, tl_boundary_result *r)
{
    lua_createtable(L, 0, 6);
    tl_lua_set_number(L, "area", r->area);
    tl_lua_set_vec3(L, "force", r->force);
    tl_lua_set_vec3(L, "moment", r->moment);
    lua_createtable(L, (int)r->face_count, 0);
    for (size_t i = 0; i < r->face_count; i++) {
        push_face(L, &r->faces[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "faces");
    tl_lua_selection *blocks = tl_lua_selection_push(L, &tl_lua_block_kind, 1);
    blocks->names = r->blocks;
    blocks->count = r->block_count;
    r->blocks = NULL;
    lua_setfield(L, -2, "blocks");
    if (luaL_newmetatable(L, RESULT_TYPE)) {
        lua_pushcfunction(L, result_index);
        lua_setfield(L, -2, "__index");
    }
    lua_setmetatable(L, -2);
}

/* ---------------------------------------------------------------- arguments -------------- */

static const char *name_of(int32_t side)
{
    return tl_side_names()[side - TL_SIDE_XMIN];
}

static void read_plane(lua_State *L, int index, tl_boundary_where *where)
{
    static const tl_param params[] = {
        TL_PARAM(TL_PARAM_VEC3, tl_boundary_where, normal, "", "outward normal, of any length",
                 .flags = TL_PARAM_REQUIRED),
        TL_PARAM(TL_PARAM_VEC3, tl_boundary_where, at, "m", "a point of the plane", .flags = TL_PARAM_REQUIRED),
    };
    if (lua_getfield(L, index, "plane") == LUA_TNIL)
        return;
    tl_lua_spec spec = {"boundary, plane", params, TL_LUA_COUNT(params), NULL};
    tl_lua_read(L, -1, &spec, false, where);
}

/* One action, with room for its drive. */
typedef struct asked {
    tl_boundary_action action;
    tl_drive drive;
    bool free_field;
} asked;

/* Reads a velocity, or a function that gives one. */
static void read_velocity(lua_State *L, int index, asked *of)
{
    static const tl_param params[] = {TL_PARAM(TL_PARAM_VEC3, tl_drive, velocity, "m/s", "", .def = {0.0})};
    const int type = lua_getfield(L, index, "velocity");
    if (type == LUA_TNIL) {
        lua_pop(L, 1);
        return;
    }
    of->action.drive = &of->drive;
    if (type == LUA_TFUNCTION) {
        lua_pushnil(L);
        tl_lua_anchor_push(L, 1, &of->drive);
        return;
    }
    of->drive = tl_drive_default();
    if (tl_lua_record_velocity(L, of->drive.record, &of->drive.velocity))
        return;
    if (type != LUA_TTABLE)
        tl_lua_fail(L, "boundary: velocity must be a list of 3 numbers or a function(t), not %s",
                    tl_lua_describe(L, -1));
    const tl_lua_spec spec = {"boundary", params, 1, NULL};
    tl_drive read;
    tl_lua_read_one(L, lua_gettop(L), &spec, "velocity", &read);
    of->drive.velocity = read.velocity;
}

/* What is to be done, of the table at `index` and the parameters read of it. */
static void read_deeds(lua_State *L, int index, const boundary_args *args, tl_boundary_action *a)
{
    a->quiet = args->quiet;
    a->fixed = args->fixed;
    a->roller = args->roller;
    a->rotation = args->rotation;
    a->at = args->at;
    const bool behind = args->joint || !isnan(args->p_velocity) || !isnan(args->s_velocity) || !isnan(args->density);
    const bool input = tl_lua_option(L, index, "input") != LUA_TNIL;
    lua_pop(L, 1);
    if (!a->quiet && (input || (behind && !args->free_field)))
        tl_lua_fail(L, "boundary: joint, p_velocity, s_velocity, density and input go with quiet = true");
    if (args->free_field && (a->quiet || a->fixed || a->roller))
        tl_lua_fail(L, "boundary: a free field moves and lets waves out by itself: give it without quiet, fixed and "
                       "roller");
    if (a->rotation && !a->roller)
        tl_lua_fail(L, "boundary: rotation is held with roller = true, or by fixed = true");
    a->loads = tl_lua_read_tensor(L, index, "boundary", "stress", &a->stress);
    a->loads = tl_lua_read_tensor(L, index, "boundary", "gradient", &a->gradient) || a->loads;
    if (!isnan(args->pressure)) {
        a->stress.xx -= args->pressure;
        a->stress.yy -= args->pressure;
        a->stress.zz -= args->pressure;
        a->loads = true;
    }
    if (!isnan(args->traction.x)) {
        a->traction = args->traction;
        a->loads = true;
    }
    if (isnan(args->water_level))
        return;
    if (a->loads)
        tl_lua_fail(L, "boundary: water_level is a load by itself: give pressure, stress, gradient and traction in "
                       "another call with add = true");
    a->gradient = (tl_sym3){.xx = args->unit_weight, .yy = args->unit_weight, .zz = args->unit_weight};
    a->level = a->at.z = args->water_level;
    a->loads = true;
}

/* Reads the table at `index`, which says where and what. */
static void read_action(lua_State *L, int index, boundary_args *args, asked *of)
{
    tl_boundary_action *a = &of->action;
    *a = tl_boundary_action_default();
    tl_lua_spec spec = boundary_spec;
    spec.keys = table_keys;
    tl_lua_read(L, index, &spec, false, args);
    of->free_field = args->free_field;
    if (args->side)
        a->where.side = tl_lua_side(L, "boundary", args->side);
    read_plane(L, index, &a->where);
    tl_lua_read_box(L, index, "boundary", "box", &a->where.box);
    a->where.facing = args->facing;
    a->where.within = args->within;
    a->where.tolerance = args->tolerance;
    read_deeds(L, index, args, a);
    read_velocity(L, index, of);
}

static bool is_anywhere(const tl_boundary_where *w)
{
    return w->side == TL_SIDE_ANY && isnan(w->normal.x) && isnan(w->box.min.x) && isnan(w->facing.x);
}

/* Reads what the value at the top of the stack says of a side: "roller", "fixed" or a table. */
static void read_side_value(lua_State *L, int32_t side, double tolerance, asked *of)
{
    tl_boundary_action *a = &of->action;
    const char *name = name_of(side);
    const char *word = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    boundary_args args;
    *a = tl_boundary_action_default();
    of->free_field = false;
    if (lua_istable(L, -1)) {
        read_action(L, lua_gettop(L), &args, of);
        if (!is_anywhere(&a->where))
            tl_lua_fail(L, "boundary: %s says where; side, plane, box and facing do not go with it", name);
        if (args.add)
            tl_lua_fail(L, "boundary: add stands beside %s, for all sides", name);
    } else if (strcmp(word, "roller") == 0)
        a->roller = true;
    else if (strcmp(word, "fixed") == 0)
        a->fixed = true;
    else if (strcmp(word, "free_field") == 0)
        of->free_field = true;
    else
        tl_lua_fail(
            L, "boundary: %s must be \"roller\", \"fixed\", \"free_field\" or a table of what is to be done, not %s",
            name, tl_lua_describe(L, -1));
    a->where.side = side;
    if (isnan(a->where.tolerance))
        a->where.tolerance = tolerance;
}

/* Reads the sides of the table at index 2; returns their number. */
static size_t read_sides(lua_State *L, double tolerance, asked *actions)
{
    size_t count = 0;
    for (int32_t i = 0; i < SIDES; i++) {
        int top = lua_gettop(L);
        if (lua_getfield(L, 2, name_of(TL_SIDE_XMIN + i)) != LUA_TNIL)
            read_side_value(L, TL_SIDE_XMIN + i, tolerance, &actions[count++]);
        lua_settop(L, top);
    }
    return count;
}

/* ---------------------------------------------------------------- the call --------------- */

static bool does_nothing(const tl_boundary_action *a)
{
    return !a->loads && !a->fixed && !a->roller && !a->quiet && !a->drive;
}

/* Reads the argument at index 2; returns the number of sides, or 0 for one action that says itself where. */
static size_t read_call(lua_State *L, asked *actions, bool *add)
{
    *add = false;
    if (lua_type(L, 2) == LUA_TSTRING) {
        actions[0] = (asked){.action = tl_boundary_action_default()};
        actions[0].action.where.side = tl_lua_side(L, "boundary", lua_tostring(L, 2));
        return 0;
    }
    if (!lua_istable(L, 2))
        tl_lua_fail(L, "boundary: a side (\"xmin\") or a table is expected, not %s", tl_lua_describe(L, 2));
    boundary_args args;
    asked one;
    read_action(L, 2, &args, &one);
    *add = args.add;
    size_t count = read_sides(L, args.tolerance, actions);
    if (count && (!is_anywhere(&one.action.where) || !does_nothing(&one.action) || one.free_field))
        tl_lua_fail(L, "boundary: with xmin and the like only tolerance and add are given beside; "
                       "what is to be done goes into their tables");
    if (!count && is_anywhere(&one.action.where))
        tl_lua_fail(L, "boundary: say where: side, plane, box or facing, or sides as in {xmin = \"roller\"}");
    if (!count)
        actions[0] = one;
    return count;
}

/* Writes a vector over the one in the field `name` of the table at the top of the stack; needs no memory. */
static void rewrite(lua_State *L, const char *name, tl_vec3 v)
{
    const double *number = &v.x;
    lua_getfield(L, -1, name);
    for (int k = 0; k < 3; k++) {
        lua_pushnumber(L, number[k]);
        lua_rawseti(L, -2, k + 1);
    }
    lua_pop(L, 1);
}

/* Does what is to be done, after the tables of the results are made: a call that fails changes nothing. At the top of
 * the stack is one table or, of sides, a table of them. */
static void act(lua_State *L, tl_model *model, const tl_boundary_action *actions, size_t sides, bool add, holder *done)
{
    tl_lua_ok(L, model, tl_model_boundary(model, actions, sides ? sides : 1, add, done->result));
    for (size_t i = 0; i < (sides ? sides : 1); i++)
        if (actions[i].drive && actions[i].drive->user)
            ((tl_lua_anchor *)actions[i].drive->user)->ended = false;
    for (size_t i = 0; i < (sides ? sides : 1); i++) {
        if (sides)
            lua_getfield(L, -1, name_of(actions[i].where.side));
        rewrite(L, "force", done->result[i].force);
        rewrite(L, "moment", done->result[i].moment);
        if (sides)
            lua_pop(L, 1);
    }
}

static int model_boundary(lua_State *L, tl_model *model)
{
    asked given[SIDES];
    tl_boundary_action actions[SIDES], found[SIDES];
    bool add, free_field[SIDES], planned[SIDES];
    size_t sides = read_call(L, given, &add);
    size_t count = sides ? sides : 1;
    for (size_t i = 0; i < count; i++) {
        actions[i] = given[i].action;
        actions[i].drive = actions[i].drive ? &given[i].drive : NULL;
        free_field[i] = given[i].free_field;
        found[i] = actions[i];
        found[i].loads = found[i].fixed = found[i].roller = found[i].quiet = false;
        found[i].drive = NULL;
    }
    holder *h = push_holder(L), *done = push_holder(L);
    tl_lua_ok(L, model, tl_model_boundary(model, found, count, add, h->result));
    tl_lua_quiet quiet[SIDES];
    const tl_lua_sides call = {actions, h->result, free_field, count, add, sides > 0};
    const size_t quiets = tl_lua_quiet_plan(L, model, &call, quiet, planned);
    bool acts = false;
    for (size_t i = 0; i < count; i++) {
        actions[i].quiet = actions[i].quiet && !planned[i];
        acts = acts || !does_nothing(&actions[i]);
    }
    if (sides)
        lua_createtable(L, 0, (int)sides);
    for (size_t i = 0; i < count; i++) {
        push_result(L, &h->result[i]);
        if (sides)
            lua_setfield(L, -2, name_of(actions[i].where.side));
    }
    if (acts)
        act(L, model, actions, sides, add, done);
    for (size_t i = 0; i < quiets; i++)
        tl_lua_quiet_place(L, model, &quiet[i]);
    return 1;
}

const tl_lua_topic tl_lua_boundary_topics[] = {
    {.name = "boundary",
     .usage = "result = model:boundary{side = \"xmax\", stress = {xx = -1e6}}  or  "
              "model:boundary{xmin = \"roller\", zmin = \"fixed\", zmax = {pressure = 1e5}}",
     .doc = "Finds outer faces of the model: those, or parts of those, that lie on no other block. Holds their bodies, "
            "or puts a traction on them as a load: its force and moment about each body's centroid take the place of "
            "the load the body had, keep their direction and go with the body. What one call puts on a body adds up. "
            "When a face is cut, each part of it gets its share. Of deformable blocks the triangles of faces that are "
            "meant bear the traction, as they are in each step, or hold their gridpoints; what is done to a triangle "
            "takes the place of all that was done to it before, or with add is added. Quiet faces of rigid blocks are "
            "elements of the kind quiet: model:elements{kind = \"quiet\"}; those of a free field are of the kind "
            "free_field. A body that was held is let go, and bears "
            "on as a load what held it: across the face, or in all components if it was held in all.",
     .spec = &boundary_spec,
     .title = "Fields of the result",
     .verbs = boundary_results,
     .arguments = 1,
     .method = model_boundary},
    {.name = NULL},
};
