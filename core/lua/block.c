/* block.c - what selections of blocks and blocks can do beyond what contacts can: filters, verbs, loads and drives,
 * shape and neighbours. */
#include "lua/block.h"

#include "lua/convert.h"
#include "lua/deformable.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"
#include "lua/record.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/boundary.h>
#include <talus/fields.h>

void tl_lua_set_block(lua_State *L, const char *name, tl_id id)
{
    if (id == TL_NO_ID)
        return;
    tl_lua_item_push_name(L, &tl_lua_block_kind, 1, &id);
    lua_setfield(L, -2, name);
}

/* ---------------------------------------------------------------- shape ------------------ */

static int free_mesh(lua_State *L)
{
    tl_block_mesh_free(lua_touserdata(L, 1));
    return 0;
}

/* Pushes an empty mesh that frees itself should an error be raised while it is in use. */
static tl_block_mesh *mesh_push(lua_State *L)
{
    return tl_lua_hold(L, sizeof(tl_block_mesh), "talus.mesh", free_mesh);
}

static void push_faces(lua_State *L, tl_model *model, const tl_block_mesh *mesh)
{
    lua_createtable(L, (int)mesh->face_count, 0);
    for (size_t face = 0; face < mesh->face_count; face++) {
        lua_createtable(L, 0, 3);
        lua_createtable(L, (int)(mesh->start[face + 1] - mesh->start[face]), 0);
        for (uint32_t i = mesh->start[face]; i < mesh->start[face + 1]; i++) {
            lua_pushinteger(L, (lua_Integer)mesh->loops[i] + 1);
            lua_rawseti(L, -2, (lua_Integer)(i - mesh->start[face]) + 1);
        }
        lua_setfield(L, -2, "vertices");
        tl_lua_set_vec3(L, "normal", mesh->normals[face]);
        const char *joint = tl_tag_name(model, mesh->tags[face]);
        if (joint && joint[0])
            tl_lua_set_text(L, "joint", joint);
        lua_rawseti(L, -2, (lua_Integer)face + 1);
    }
}

/* A list of the blocks it touches; the model's userdata is at index 3. */
static void push_neighbours(lua_State *L, tl_model *model, tl_id id)
{
    tl_lua_selection *found = tl_lua_selection_push(L, &tl_lua_block_kind, 3);
    tl_id *ids = NULL;
    tl_status status = tl_block_neighbours(model, id, &ids, &found->count);
    found->names = ids;
    tl_lua_ok(L, model, status);
    lua_createtable(L, (int)found->count, 0);
    for (size_t i = 0; i < found->count; i++) {
        tl_lua_item_push(L, 3, found, i);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static bool block_extra(lua_State *L, tl_model *model, const tl_lua_item *item, const char *name)
{
    const tl_id id = item->name.block;
    bool vertices = strcmp(name, "vertices") == 0;
    if (strcmp(name, "neighbours") == 0) {
        push_neighbours(L, model, id);
        return true;
    }
    if (!vertices && strcmp(name, "faces") != 0)
        return false;
    tl_block_mesh *mesh = mesh_push(L);
    tl_lua_ok(L, model, tl_block_mesh_get(model, id, mesh));
    if (vertices)
        tl_lua_push_rows(L, &mesh->vertices->x, mesh->vertex_count, 3, 3);
    else
        push_faces(L, model, mesh);
    tl_block_mesh_free(mesh);
    return true;
}

/* ---------------------------------------------------------------- filter ----------------- */

typedef struct block_args {
    const char *group, *joint, *boundary;
    tl_vec3 containing;
    tl_points region;
    int32_t fixed;
} block_args;

static const tl_param block_params[] = {
    TL_PARAM(TL_PARAM_STRING, block_args, group, "", "blocks of this group", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, block_args, containing, "m", "blocks that contain this point", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_POINTS, block_args, region, "m", "blocks whose centroid is in the convex hull of these points",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, block_args, joint, "", "blocks with a face on this joint or plane",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, block_args, boundary, "",
             "blocks with an outer face on this side of the model: \"xmin\", \"xmax\" ... \"zmax\"",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_BOOL, block_args, fixed, "",
             "blocks held in every component, of deformable ones all gridpoints, or the others",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_lua_key block_keys[] = {
    {"id", "whole number or list of whole numbers", "the blocks of these ids"},
    {"inside", "{min = {x, y, z}, max = {x, y, z}}", "blocks whose centroid is in this box"},
    {"above", "{dip =, dip_direction =, origin = {x, y, z}}",
     "blocks whose centroid is above this plane, or above all planes of a list"},
    {"below", "{dip =, dip_direction =, origin = {x, y, z}}",
     "blocks whose centroid is below this plane, or below all planes of a list"},
    {"hidden", "true, false or \"any\"", "hidden blocks, visible ones (the default), or both"},
    {"where", "function(block)", "blocks for which the function answers true"},
    {NULL, NULL, NULL},
};

static const tl_lua_spec blocks_spec = {"blocks", block_params, TL_LUA_COUNT(block_params), block_keys};

static const tl_param halfspace_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_halfspace, dip, "deg", "angle below the horizontal", .flags = TL_PARAM_REQUIRED,
             .min = 0.0, .max = 90.0),
    TL_PARAM(TL_PARAM_REAL, tl_halfspace, dip_direction, "deg", "clockwise from north (+y)", .flags = TL_PARAM_REQUIRED,
             .min = 0.0, .max = 360.0),
    TL_PARAM(TL_PARAM_VEC3, tl_halfspace, origin, "m", "a point of the plane", .flags = TL_PARAM_REQUIRED),
};

/* Reads the filter's planes at `key`, one or a list; pushes what they hang on. */
static const tl_halfspace *read_halfspaces(lua_State *L, const char *key, size_t *count)
{
    if (tl_lua_option(L, 2, key) == LUA_TNIL)
        return NULL;
    const int given = lua_gettop(L);
    const bool many = lua_istable(L, given) && lua_rawlen(L, given) > 0;
    *count = many ? lua_rawlen(L, given) : 1;
    if (many)
        tl_lua_check_list(L, given, lua_pushfstring(L, "blocks: the list of planes '%s'", key), *count);
    tl_halfspace *planes = lua_newuserdatauv(L, *count * sizeof *planes, 0);
    const int top = lua_gettop(L);
    for (size_t i = 0; i < *count; i++) {
        tl_lua_spec spec = {NULL, halfspace_params, TL_LUA_COUNT(halfspace_params), NULL};
        spec.context =
            many ? lua_pushfstring(L, "blocks, %s, plane %d", key, (int)i + 1) : lua_pushfstring(L, "blocks, %s", key);
        if (many)
            lua_rawgeti(L, given, (lua_Integer)i + 1);
        else
            lua_pushvalue(L, given);
        tl_lua_read(L, lua_gettop(L), &spec, false, &planes[i]);
        lua_settop(L, top);
    }
    return planes;
}

/* Ids that are asked for, ascending; `list` is NULL when any will do. */
typedef struct block_ids {
    tl_id *list;
    size_t count;
} block_ids;

static int compare_ids(const void *a, const void *b)
{
    tl_id x = *(const tl_id *)a, y = *(const tl_id *)b;
    return (x > y) - (x < y);
}

/* The id at `index`. */
static tl_id read_id(lua_State *L, int index)
{
    static const tl_param id = {
        .size = sizeof id, .type = TL_PARAM_INT, .name = "id", .unit = "", .min = 1.0, .max = 4294967295.0};
    static const tl_lua_spec spec = {"blocks", &id, 1, NULL};
    int top = lua_gettop(L);
    int64_t number;
    tl_lua_read_one(L, index, &spec, "id", &number);
    lua_settop(L, top);
    return (tl_id)number;
}

/* Reads the filter's `id`; pushes what the list hangs on. */
static block_ids read_ids(lua_State *L)
{
    block_ids ids = {NULL, 0};
    if (tl_lua_option(L, 2, "id") == LUA_TNIL)
        return ids;
    int given = lua_gettop(L);
    bool many = lua_istable(L, given);
    ids.count = many ? lua_rawlen(L, given) : 1;
    if (many)
        tl_lua_check_list(L, given, "blocks: the list of ids", ids.count);
    ids.list = lua_newuserdatauv(L, (ids.count + 1) * sizeof *ids.list, 0);
    for (size_t i = 0; i < ids.count; i++) {
        if (many)
            lua_rawgeti(L, given, (lua_Integer)i + 1);
        ids.list[i] = read_id(L, many ? -1 : given);
        lua_settop(L, given + 1);
    }
    qsort(ids.list, ids.count, sizeof *ids.list, compare_ids);
    return ids;
}

/* Keeps those of the selection that are in the list. Both ascend. */
static void keep_ids(tl_lua_selection *found, const block_ids *ids)
{
    size_t kept = 0, k = 0;
    tl_id *of = found->names;
    for (size_t i = 0; i < found->count; i++) {
        while (k < ids->count && ids->list[k] < of[i])
            k++;
        if (k < ids->count && ids->list[k] == of[i])
            of[kept++] = of[i];
    }
    found->count = kept;
}

/* The filter's `hidden`: -1 any, 0 visible, 1 hidden ones. */
static int read_hidden(lua_State *L)
{
    int type = tl_lua_option(L, 2, "hidden");
    if (type == LUA_TNIL)
        return 0;
    if (type == LUA_TBOOLEAN)
        return lua_toboolean(L, -1);
    if (type != LUA_TSTRING || strcmp(lua_tostring(L, -1), "any") != 0)
        tl_lua_fail(L, "blocks: hidden must be true, false or \"any\", not %s", tl_lua_describe(L, -1));
    return -1;
}

/* Reads the table at index 2; all it points to is in `args`, `inside` or on the stack. */
static void read_filter(lua_State *L, block_args *args, tl_bounds *inside, tl_block_filter *filter)
{
    tl_lua_read(L, 2, &blocks_spec, true, args);
    *filter = tl_block_filter_default();
    filter->group = args->group;
    filter->joint = args->joint;
    filter->fixed = args->fixed;
    if (!isnan(args->containing.x))
        filter->containing = &args->containing;
    if (tl_lua_read_box(L, 2, "blocks", "inside", inside))
        filter->inside = inside;
    filter->above = read_halfspaces(L, "above", &filter->above_count);
    filter->below = read_halfspaces(L, "below", &filter->below_count);
    filter->region = args->region.count > 0 ? args->region.at : NULL;
    filter->region_count = args->region.count;
    filter->hidden = read_hidden(L);
}

/* Keeps the blocks with an outer face on a side. Both lists ascend. */
static tl_status keep_on_side(tl_model *model, tl_lua_selection *found, int32_t side)
{
    const tl_vec3 none = {NAN, NAN, NAN};
    const tl_boundary_action find = {.where = {side, none, none, {none, none}, none, NAN, NAN}};
    tl_boundary_result result;
    tl_status status = found->count ? tl_model_boundary(model, &find, 1, false, &result) : TL_OK;
    if (status == TL_E_NOT_FOUND) /* a corner is the farthest on that side, and no face */
        found->count = 0;
    if (found->count == 0)
        return TL_OK;
    if (status != TL_OK)
        return status;
    keep_ids(found, &(block_ids){result.blocks, result.block_count});
    tl_boundary_free(&result);
    return TL_OK;
}

void tl_lua_blocks_select(lua_State *L, tl_model *model, const tl_block_filter *filter, tl_lua_selection *found)
{
    tl_id *ids = NULL;
    const tl_status status = tl_blocks_select(model, filter, &ids, &found->count);
    found->names = ids;
    tl_lua_ok(L, model, status);
}

static int model_blocks(lua_State *L, tl_model *model)
{
    block_args args = {.containing = {NAN, NAN, NAN}, .fixed = -1};
    tl_bounds inside;
    tl_block_filter filter;
    read_filter(L, &args, &inside, &filter);
    block_ids ids = read_ids(L);
    if (ids.list && ids.count == 1)
        filter.id = ids.list[0];
    int32_t side = args.boundary ? tl_lua_side(L, "blocks", args.boundary) : TL_SIDE_ANY;
    int where = tl_lua_read_where(L, &tl_lua_block_kind);
    tl_lua_selection *found = tl_lua_selection_push(L, &tl_lua_block_kind, 1);
    tl_lua_blocks_select(L, model, &filter, found);
    if (ids.list)
        keep_ids(found, &ids);
    if (side != TL_SIDE_ANY)
        tl_lua_ok(L, model, keep_on_side(model, found, side));
    if (where)
        tl_lua_selection_filter(L, lua_gettop(L), where);
    return 1;
}

/* ---------------------------------------------------------------- verbs ------------------ */

static tl_status hide(tl_model *model, const tl_id *ids, size_t count)
{
    return tl_blocks_hide(model, ids, count, true);
}

static tl_status show(tl_model *model, const tl_id *ids, size_t count)
{
    return tl_blocks_hide(model, ids, count, false);
}

typedef struct fix_args {
    int32_t x, y, z, rotation;
} fix_args;

static const tl_param fix_params[] = {
    TL_PARAM(TL_PARAM_BOOL, fix_args, x, "", "hold the motion along x", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, fix_args, y, "", "hold the motion along y", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, fix_args, z, "", "hold the motion along z", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, fix_args, rotation, "", "hold the rotation", .def = {0.0}),
};

static const tl_lua_spec fix_spec = {"fix", fix_params, TL_LUA_COUNT(fix_params), NULL};

static tl_status fix(lua_State *L, const tl_lua_selection *b)
{
    fix_args args;
    tl_lua_read(L, 2, &fix_spec, false, &args);
    unsigned what = (args.x ? TL_FIX_X : 0u) | (args.y ? TL_FIX_Y : 0u) | (args.z ? TL_FIX_Z : 0u) |
                    (args.rotation ? TL_FIX_ROTATION : 0u);
    lua_pushnil(L);
    if (!lua_istable(L, 2) || !lua_next(L, 2))
        what = TL_FIX_ALL;
    else if (what == 0)
        tl_lua_fail(L, "fix: nothing is to be held; to let blocks go use selection:free()");
    return tl_blocks_fix(b->owner->model, b->names, b->count, what);
}

static const tl_param set_params[] = {
    TL_PARAM(TL_PARAM_REAL, tl_block_set, density, "kg/m3", "density", .min = 0.0, .max = INFINITY,
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN | TL_PARAM_MAX_OPEN),
    TL_PARAM(TL_PARAM_STRING, tl_block_set, group, "", "name of the group", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, tl_block_set, velocity, "m/s",
             "velocity of the centroid; of several blocks of a body, that of their common one",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, tl_block_set, angular_velocity, "rad/s", "angular velocity", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, tl_block_set, solid, "",
             "of deformable blocks: the solid of all their zones, by its name; stress stays, and states of the same "
             "names",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_lua_spec set_spec = {"set", set_params, TL_LUA_COUNT(set_params), NULL};

static tl_status set(lua_State *L, const tl_lua_selection *b)
{
    tl_block_set wanted = tl_block_set_default();
    tl_lua_read(L, 2, &set_spec, false, &wanted);
    if (isnan(wanted.density) && !wanted.group && isnan(wanted.velocity.x) && isnan(wanted.angular_velocity.x) &&
        !wanted.solid)
        tl_lua_fail(L, "set: give density, group, velocity, angular_velocity or solid");
    return tl_blocks_set(b->owner->model, b->names, b->count, &wanted);
}

/* Bounds over all vertices of the blocks in their present place. */
static int bounds(lua_State *L, const tl_lua_selection *b)
{
    if (b->count == 0)
        return tl_lua_fail(L, "bounds: the selection is empty");
    tl_block_mesh *mesh = mesh_push(L);
    tl_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < b->count; i++) {
        tl_lua_ok(L, b->owner->model, tl_block_mesh_get(b->owner->model, ((const tl_id *)b->names)[i], mesh));
        for (size_t k = 0; k < mesh->vertex_count; k++) {
            tl_vec3 v = mesh->vertices[k];
            low = (tl_vec3){fmin(low.x, v.x), fmin(low.y, v.y), fmin(low.z, v.z)};
            high = (tl_vec3){fmax(high.x, v.x), fmax(high.y, v.y), fmax(high.z, v.z)};
        }
        tl_block_mesh_free(mesh);
    }
    lua_createtable(L, 0, 2);
    tl_lua_set_vec3(L, "min", low);
    tl_lua_set_vec3(L, "max", high);
    return 1;
}

static const char *const key_names[] = {
    [TL_LUA_VELOCITY] = "velocity",
    [TL_LUA_ANGULAR_VELOCITY] = "angular_velocity",
};

const tl_lua_key tl_lua_drive_keys[] = {
    {"velocity", "{x, y, z} or function(t)",
     "velocity of the centroid, m/s; the function gives {x, y, z} or three numbers for a time t, "
     "s: the middle of each step. x, y or z may be a talus.record, whose time counts from the call. Zero when left "
     "out"},
    {"angular_velocity", "{x, y, z} or function(t)", "angular velocity, rad/s, likewise"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- drives ------------------
 *
 * A drive given by functions of the script is kept as an *anchor*: a userdata whose user values are the functions.
 * Anchors are in a table that is a user value of the model's userdata. So a function that refers to its model does
 * not keep it alive. When a drive ends the kernel touches no Lua state: it marks the anchor, which goes with the next
 * verb.
 *
 * The functions are called in a step, on the thread and in the frame of the run, in protected calls. An error ends
 * the run and is then raised as it was. */

/* Pushes a new anchor and hangs it on the model at `model_index`; it counts as ended until the kernel has taken it. */
static tl_lua_anchor *push_anchor(lua_State *L, int model_index)
{
    tl_lua_anchor *a = lua_newuserdatauv(L, sizeof *a, TL_LUA_MOTIONS);
    a->ended = true;
    lua_getiuservalue(L, model_index, 1);
    lua_pushvalue(L, -2);
    lua_rawsetp(L, -2, a);
    lua_pop(L, 1);
    return a;
}

static void on_release(void *user)
{
    tl_lua_anchor *a = user;
    a->ended = true;
}

/* ---------------------------------------------------------------- in a step -------------- */

typedef struct call {
    int key;
    double t;
    tl_vec3 velocity;
} call;

/* Raises at the place where the function at index 2 is defined. */
static int bad_velocity(lua_State *L, const call *c, const char *what)
{
    lua_pushnumber(L, c->t);
    tl_lua_push_number_text(L, -1);
    return tl_lua_fail_in(L, 2, "drive: %s(%s) must give three finite numbers: it gave %s", key_names[c->key],
                          lua_tostring(L, -1), what);
}

/* Three numbers from index `first` on. */
static tl_vec3 read_velocity(lua_State *L, const call *c, int first)
{
    double v[3];
    for (int k = 0; k < 3; k++) {
        if (lua_type(L, first + k) != LUA_TNUMBER)
            bad_velocity(L, c, tl_lua_describe(L, first + k));
        v[k] = lua_tonumber(L, first + k);
        if (!isfinite(v[k]))
            bad_velocity(L, c, tl_lua_describe(L, first + k));
    }
    return (tl_vec3){v[0], v[1], v[2]};
}

/* Runs protected. Arguments: the call, the function. */
static int call_function(lua_State *L)
{
    call *c = lua_touserdata(L, 1);
    lua_pushvalue(L, 2);
    lua_pushnumber(L, c->t);
    lua_call(L, 1, LUA_MULTRET);
    int given = lua_gettop(L) - 2;
    luaL_checkstack(L, 16, "too many values");
    if (given == 1 && lua_istable(L, 3)) {
        if (lua_rawlen(L, 3) != 3)
            bad_velocity(L, c, lua_pushfstring(L, "a list of %I", (lua_Integer)lua_rawlen(L, 3)));
        const char *key = tl_lua_stray_key(L, 3, 3);
        if (key)
            bad_velocity(L, c, lua_pushfstring(L, "a list with the key %s", key));
        for (int k = 1; k <= 3; k++)
            lua_rawgeti(L, 3, k);
        c->velocity = read_velocity(L, c, 4);
    } else if (given == 3) {
        c->velocity = read_velocity(L, c, 3);
    } else {
        bad_velocity(L, c, given == 1 ? tl_lua_describe(L, 3) : lua_pushfstring(L, "%d values", given));
    }
    return 0;
}

static bool evaluate(tl_lua_anchor *a, int key, double t, tl_vec3 *velocity)
{
    lua_State *L = tl_lua_run_state();
    call c = {.key = key, .t = t};
    lua_pushcfunction(L, call_function);
    lua_pushlightuserdata(L, &c);
    lua_getiuservalue(L, TL_LUA_AT_MODEL, 1);
    lua_rawgetp(L, -1, a);
    lua_getiuservalue(L, -1, key);
    lua_replace(L, -3);
    lua_pop(L, 1);
    if (lua_pcall(L, 2, 0, 0) != LUA_OK) {
        tl_lua_run_keep_error();
        return false;
    }
    *velocity = c.velocity;
    return true;
}

static bool velocity_at(void *user, double t, tl_vec3 *velocity)
{
    return evaluate(user, TL_LUA_VELOCITY, t, velocity);
}

static bool angular_velocity_at(void *user, double t, tl_vec3 *velocity)
{
    return evaluate(user, TL_LUA_ANGULAR_VELOCITY, t, velocity);
}

void tl_lua_anchor_push(lua_State *L, int model_index, tl_drive *drive)
{
    bool moves = lua_isfunction(L, -2), turns = lua_isfunction(L, -1);
    tl_lua_anchor *a = push_anchor(L, model_index);
    lua_insert(L, -3);
    lua_setiuservalue(L, -3, TL_LUA_ANGULAR_VELOCITY);
    lua_setiuservalue(L, -2, TL_LUA_VELOCITY);
    *drive = tl_drive_default();
    drive->velocity_at = moves ? velocity_at : NULL;
    drive->angular_velocity_at = turns ? angular_velocity_at : NULL;
    drive->user = a;
    drive->release = on_release;
}

/* ---------------------------------------------------------------- loads, drives and reactions ---- */

static tl_status load(lua_State *L, const tl_lua_selection *b)
{
    tl_load given = tl_load_default();
    tl_lua_read_function(L, 2, "load", NULL, &given);
    if (!lua_istable(L, 2))
        tl_lua_fail(L, "load: give force, moment and at in a table; load{} takes the load off");
    return tl_blocks_load(b->owner->model, b->names, b->count, &given);
}

/* Reads one of the two velocities of the table at index 2; true when it is given. A function goes to
 * the anchor at the top of the stack. */
static bool read_motion(lua_State *L, int key, tl_vec3 *constant, tl_drive_fn *function, tl_drive_fn ours,
                        const tl_record *records[3])
{
    static const tl_param vectors[] = {
        [TL_LUA_VELOCITY] = TL_PARAM(TL_PARAM_VEC3, tl_drive, velocity, "m/s", "", .def = {0.0}),
        [TL_LUA_ANGULAR_VELOCITY] = TL_PARAM(TL_PARAM_VEC3, tl_drive, angular_velocity, "rad/s", "", .def = {0.0}),
    };
    int type = lua_getfield(L, 2, key_names[key]);
    if (type == LUA_TFUNCTION) {
        lua_setiuservalue(L, -2, key);
        *function = ours;
        return true;
    }
    if (key == TL_LUA_VELOCITY && tl_lua_record_velocity(L, records, constant)) {
        lua_pop(L, 1);
        return true;
    }
    if (type != LUA_TNIL) {
        int top = lua_gettop(L);
        tl_drive read;
        tl_lua_spec spec = {"drive", &vectors[key], 1, NULL};
        if (type != LUA_TTABLE)
            tl_lua_fail(L, "drive: %s must be a list of 3 numbers or a function(t), not %s", key_names[key],
                        tl_lua_describe(L, -1));
        tl_lua_read_one(L, top, &spec, key_names[key], &read);
        *constant = key == TL_LUA_VELOCITY ? read.velocity : read.angular_velocity;
        lua_settop(L, top);
    }
    lua_pop(L, 1);
    return type != LUA_TNIL;
}

static tl_status drive(lua_State *L, const tl_lua_selection *b)
{
    tl_lua_spec spec = {"drive", NULL, 0, tl_lua_drive_keys};
    tl_lua_read(L, 2, &spec, false, NULL);
    lua_settop(L, 2);
    lua_getiuservalue(L, 1, 1);
    tl_lua_anchor *a = push_anchor(L, 3);
    tl_drive given = tl_drive_default();
    given.user = a;
    given.release = on_release;
    bool moves = false;
    if (lua_istable(L, 2)) {
        moves = read_motion(L, TL_LUA_VELOCITY, &given.velocity, &given.velocity_at, velocity_at, given.record);
        moves |= read_motion(L, TL_LUA_ANGULAR_VELOCITY, &given.angular_velocity, &given.angular_velocity_at,
                             angular_velocity_at, NULL);
    }
    if (!moves)
        tl_lua_fail(L, "drive: give velocity, angular_velocity or both; to hold blocks use "
                       "selection:fix(), to let them go selection:free()");
    tl_status status = tl_blocks_drive(b->owner->model, b->names, b->count, &given);
    if (status == TL_OK && b->count > 0)
        a->ended = false;
    return status;
}

static int reaction(lua_State *L, const tl_lua_selection *blocks)
{
    tl_model *model = tl_lua_living(L, blocks->owner);
    tl_vec3 force;
    tl_lua_ok(L, model, tl_blocks_reaction(model, blocks->names, blocks->count, &force));
    tl_lua_push_numbers(L, &force.x, 3);
    return 1;
}

static const tl_lua_verb block_verbs[] = {
    {.name = "hide", .plain = hide, .done = "hidden"},
    {.name = "show", .plain = show},
    {.name = "delete", .plain = tl_blocks_delete, .done = "deleted"},
    {.name = "join", .plain = tl_blocks_join, .done = "joined"},
    {.name = "unjoin", .plain = tl_blocks_unjoin},
    {.name = "fix", .arguments = 1, .act = fix, .done = "held"},
    {.name = "free", .plain = tl_blocks_free, .done = "set free"},
    {.name = "reset_displacement", .plain = tl_blocks_reset_displacement},
    {.name = "set", .arguments = 1, .act = set, .done = "changed"},
    {.name = "load", .arguments = 1, .act = load, .done = "loaded"},
    {.name = "drive", .arguments = 1, .act = drive, .done = "driven"},
    {.name = "reaction", .ask = reaction},
    {.name = "deformable", .arguments = 1, .ask = tl_lua_deformable},
    {.name = "bounds", .ask = bounds},
    {.name = NULL},
};

static tl_status block_field(tl_model *model, const tl_lua_item *item, size_t index, tl_field_value *value)
{
    return tl_block_field(model, item->name.block, index, value);
}

static tl_status block_values(tl_model *model, const tl_lua_selection *of, const char *name, double *out, size_t *width)
{
    return tl_blocks_values(model, of ? of->names : NULL, of ? of->count : 0, name, out, width);
}

static const tl_lua_key block_extra_keys[] = {
    {"vertices", "list of {x, y, z}", "vertices in their present place"},
    {"faces", "list of {vertices =, normal =, joint =}",
     "faces: vertex numbers from 1, outward normal, name of the joint plane or nil"},
    {"neighbours", "list of blocks", "blocks it is in contact with"},
    {NULL, NULL, NULL},
};

static lua_Integer block_number(const tl_lua_name *name)
{
    return name->block;
}

const tl_lua_kind tl_lua_block_kind = {
    .item = "block",
    .items = "blocks",
    .item_type = TL_LUA_BLOCK,
    .selection_type = TL_LUA_BLOCKS,
    .name_size = sizeof(tl_id),
    .number = block_number,
    .bearer = "law",
    .fields = tl_block_fields,
    .field = block_field,
    .values = block_values,
    .extra = block_extra,
    .extra_keys = block_extra_keys,
    .verbs = block_verbs,
};

static const tl_lua_key block_methods[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of blocks, the i-th one, all in order of id"},
    {"sel:sum(field)", "", "sum of a field of numbers; of a vector field a vector"},
    {"sel:max(field), sel:min(field)", "", "largest and smallest value of a field of numbers"},
    {"sel:values(field)", "",
     "list of the field's values, in the order of the selection: much faster than one by one. A "
     "vector is {x, y, z}; with \"flat\" after the field {x, y, z, x, y, z, ...}"},
    {"sel:bounds()", "", "{min = {x, y, z}, max = {x, y, z}} over all vertices"},
    {"sel:where(function(block) ... end)", "", "those for which the function answers true"},
    {"sel:hide(), sel:show()", "", "hidden blocks are not cut and not selected unless asked for"},
    {"sel:delete()", "", "removes the blocks"},
    {"sel:join(), sel:unjoin()", "",
     "makes one rigid body of the blocks and of what they were joined to; makes each a body of its "
     "own. Momentum and angular momentum are kept"},
    {"sel:load{...}", "", "a force and a moment: talus help load"},
    {"sel:drive{...}", "", "a prescribed motion, until sel:free(): talus help drive"},
    {"sel:fix{x =, y =, z =, rotation =}", "",
     "holds components of the motion; all of it when nothing is named: talus help fix"},
    {"sel:free()", "", "lets fixed and driven blocks go"},
    {"sel:reaction()", "", "sum of the forces that hold their bodies, N: {x, y, z}, of held components only"},
    {"sel:reset_displacement()", "", "displacements count from now"},
    {"sel:deformable{zone =, solid =}", "", "divides them into zones: talus help deformable"},
    {"sel:set{density =, group =, velocity =, angular_velocity =, solid =}", "", "changes properties: talus help set"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_block_topics[] = {
    {.name = "blocks",
     .usage = "selection = model:blocks{...}",
     .doc = "Selects blocks, visible ones unless asked otherwise; all conditions must hold.",
     .spec = &blocks_spec,
     .kind = &tl_lua_block_kind,
     .title = "Methods of the selection",
     .verbs = block_methods,
     .arguments = 1,
     .method = model_blocks},
    {.name = "fix",
     .usage = "selection:fix{x = true, rotation = true}  or  selection:fix()",
     .doc = "Holds components of the motion of the blocks' bodies, besides what is held already; "
            "all of it when nothing is named.",
     .spec = &fix_spec},
    {.name = "set",
     .usage = "selection:set{group = \"wedge\", velocity = {0, 0, -1}}",
     .doc = "Changes properties of blocks; what is not named stays.",
     .spec = &set_spec},
    {.name = "load", .usage = "selection:load{force = {0, 0, -1e3}, at = {x, y, z}}", .function = "load"},
    {.name = "drive",
     .usage = "selection:drive{velocity = function(t) return 0.1 * math.sin(t), 0, 0 end}",
     .doc = "Prescribes the motion of the blocks' bodies, in the place of any fixing, until "
            "selection:free(). A function is called in the middle of a step: it may read the "
            "model, but not change it. A body that is driven to turn is not cut in two.",
     .keys = tl_lua_drive_keys},
    {.name = NULL},
};
