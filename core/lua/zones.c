/* zones.c - selections of zones and gridpoints, in Lua: model:zones, model:gridpoints, what is done to gridpoints. */
#include "lua/zones.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- which ------------------ */

/* Columns of the table, for both kinds. */
typedef struct zone_args {
    const char *group, *solid;
    tl_vec3 near, containing;
    int32_t plastic, surface, fixed;
} zone_args;

static const tl_param zone_params[] = {
    TL_PARAM(TL_PARAM_STRING, zone_args, group, "", "zones of blocks of this group", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, zone_args, solid, "", "zones of this solid", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, zone_args, near, "m", "the one zone whose centroid is nearest to this point",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, zone_args, containing, "m", "zones that have this point inside or on a side",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_BOOL, zone_args, plastic, "", "zones that have ever yielded, or that never have",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_param gridpoint_params[] = {
    TL_PARAM(TL_PARAM_STRING, zone_args, group, "", "gridpoints of blocks of this group", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, zone_args, near, "m", "the one gridpoint that is nearest to this point",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_BOOL, zone_args, surface, "", "gridpoints on the surface of their body, or inside",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_BOOL, zone_args, fixed, "", "gridpoints held in some component, or in none",
             .flags = TL_PARAM_OPTIONAL),
};

/* Keys that both have; `one` and `many` are words. */
#define WHERE_KEYS(one, many)                                                                                          \
    {"id", "whole number or list of whole numbers", "the " many " of these ids"},                                      \
        {"block", "block or its id", many " of this block"},                                                           \
        {"blocks", "selection of blocks", many " of these blocks, hidden ones too"},                                   \
        {"inside", "{min = {x, y, z}, max = {x, y, z}}", many " in this box, by their centroids or places"},           \
    {                                                                                                                  \
        "where", "function(" one ")", many " for which the function answers true"                                      \
    }

static const tl_lua_key zone_keys[] = {WHERE_KEYS("zone", "zones"), {NULL, NULL, NULL}};
static const tl_lua_key gridpoint_keys[] = {WHERE_KEYS("gridpoint", "gridpoints"), {NULL, NULL, NULL}};

static const tl_lua_spec zones_spec = {"zones", zone_params, TL_LUA_COUNT(zone_params), zone_keys};
static const tl_lua_spec gridpoints_spec = {"gridpoints", gridpoint_params, TL_LUA_COUNT(gridpoint_params),
                                            gridpoint_keys};

/* The block at the top of the stack, given as itself or as its id. */
static tl_id read_block(lua_State *L, const char *context)
{
    const tl_lua_item *block = luaL_testudata(L, -1, TL_LUA_BLOCK);
    if (block && block->owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "%s: block belongs to another model", context);
    if (block)
        return block->name.block;
    const lua_Integer id = lua_isinteger(L, -1) ? lua_tointeger(L, -1) : 0;
    if (id < 1 || id > (lua_Integer)UINT32_MAX)
        tl_lua_fail(L, "%s: block must be a block or its id, a whole number from 1, not %s", context,
                    tl_lua_describe(L, -1));
    return (tl_id)id;
}

/* Reads `block` and `blocks`; what the filter points to is `*block`, or the selection, which is on the stack. */
static void read_blocks(lua_State *L, const char *context, tl_id *block, tl_zone_filter *filter)
{
    static const tl_id none = TL_NO_ID; /* an empty selection has no list, but NULL would mean all */
    const bool one = tl_lua_option(L, 2, "block") != LUA_TNIL;
    if (one) {
        *block = read_block(L, context);
        filter->blocks = block;
        filter->block_count = 1;
    }
    if (tl_lua_option(L, 2, "blocks") == LUA_TNIL)
        return;
    const tl_lua_selection *blocks = luaL_testudata(L, -1, TL_LUA_BLOCKS);
    if (one || !blocks || blocks->owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "%s: %s", context,
                    one ? "give block or blocks, not both"
                    : !blocks
                        ? lua_pushfstring(L, "blocks must be a selection of blocks, not %s", tl_lua_describe(L, -1))
                        : "blocks belong to another model");
    filter->blocks = blocks->count > 0 ? blocks->names : &none;
    filter->block_count = blocks->count;
}

/* The id at the top of the stack. */
static lua_Integer read_id(lua_State *L, const char *context)
{
    if (!lua_isinteger(L, -1) || lua_tointeger(L, -1) < 0)
        tl_lua_fail(L, "%s: id must be a whole number or a list of whole numbers, not %s", context,
                    tl_lua_describe(L, -1));
    return lua_tointeger(L, -1);
}

static int compare_ids(const void *a, const void *b)
{
    const lua_Integer x = *(const lua_Integer *)a, y = *(const lua_Integer *)b;
    return (x > y) - (x < y);
}

/* Keeps those of the selection at the top of the stack that `id` of the table asks for. */
static void keep_ids(lua_State *L, tl_lua_selection *found)
{
    const char *context = found->kind->items;
    if (tl_lua_option(L, 2, "id") == LUA_TNIL) {
        lua_pop(L, 1);
        return;
    }
    const int given = lua_gettop(L);
    const bool many = lua_istable(L, given);
    const size_t count = many ? lua_rawlen(L, given) : 1;
    if (many)
        tl_lua_check_list(L, given, lua_pushfstring(L, "%s: the list of ids", context), count);
    lua_Integer *list = lua_newuserdatauv(L, (count + 1) * sizeof *list, 0);
    for (size_t i = 0; i < count; i++) {
        if (many)
            lua_rawgeti(L, given, (lua_Integer)i + 1);
        else
            lua_pushvalue(L, given);
        list[i] = read_id(L, context);
        lua_pop(L, 1);
    }
    qsort(list, count, sizeof *list, compare_ids);
    size_t kept = 0;
    tl_zone_name *names = found->names;
    for (size_t i = 0; i < found->count; i++) {
        const lua_Integer id = found->kind->number(&(tl_lua_name){.zone = names[i]});
        if (bsearch(&id, list, count, sizeof *list, compare_ids))
            names[kept++] = names[i];
    }
    found->count = kept;
    lua_settop(L, given - 1);
}

/* model:zones and model:gridpoints. */
static int select_parts(lua_State *L, tl_model *model, const tl_lua_kind *kind, const tl_lua_spec *spec,
                        tl_status (*choose)(tl_model *, const tl_zone_filter *, tl_zone_name **, size_t *))
{
    const tl_vec3 any = {NAN, NAN, NAN};
    zone_args args = {.near = any, .containing = any, .plastic = -1, .surface = -1, .fixed = -1};
    tl_zone_filter filter = tl_zone_filter_default();
    tl_bounds box;
    tl_id block;
    tl_lua_read(L, 2, spec, true, &args);
    filter.group = args.group;
    filter.solid = args.solid;
    filter.near = isnan(args.near.x) ? NULL : &args.near;
    filter.containing = isnan(args.containing.x) ? NULL : &args.containing;
    filter.plastic = args.plastic;
    filter.surface = args.surface;
    filter.fixed = args.fixed;
    if (tl_lua_read_box(L, 2, spec->context, "inside", &box))
        filter.inside = &box;
    read_blocks(L, spec->context, &block, &filter);
    const int where = tl_lua_read_where(L, kind);
    tl_lua_selection *found = tl_lua_selection_push(L, kind, 1);
    tl_zone_name *names = NULL;
    const tl_status status = choose(model, &filter, &names, &found->count);
    found->names = names;
    tl_lua_ok(L, model, status);
    keep_ids(L, found);
    if (where)
        tl_lua_selection_filter(L, lua_gettop(L), where);
    return 1;
}

static int model_zones(lua_State *L, tl_model *model)
{
    return select_parts(L, model, &tl_lua_zone_kind, &zones_spec, tl_zones_select);
}

static int model_gridpoints(lua_State *L, tl_model *model)
{
    return select_parts(L, model, &tl_lua_gridpoint_kind, &gridpoints_spec, tl_gridpoints_select);
}

/* ---------------------------------------------------------------- what is asked of one ---- */

static lua_Integer number(const tl_lua_name *name)
{
    return ((lua_Integer)name->zone.body << 32) + name->zone.number;
}

static tl_status zone_field(tl_model *model, const tl_lua_item *item, size_t index, tl_field_value *value)
{
    return tl_zone_field(model, item->name.zone, index, value);
}

static tl_status gridpoint_field(tl_model *model, const tl_lua_item *item, size_t index, tl_field_value *value)
{
    return tl_gridpoint_field(model, item->name.zone, index, value);
}

static tl_status zone_values(tl_model *model, const tl_lua_selection *of, const char *name, double *out, size_t *width)
{
    return tl_zones_values(model, of ? of->names : NULL, of ? of->count : 0, name, out, width);
}

static tl_status gridpoint_values(tl_model *model, const tl_lua_selection *of, const char *name, double *out,
                                  size_t *width)
{
    return tl_gridpoints_values(model, of ? of->names : NULL, of ? of->count : 0, name, out, width);
}

/* `id`, exact, and `block`, as a block and not as a number. */
static bool part_extra(lua_State *L, tl_model *model, const tl_lua_item *item, const char *name)
{
    const bool block = strcmp(name, "block") == 0;
    if (!block && strcmp(name, "id") != 0)
        return false;
    size_t index;
    tl_field_value value;
    tl_lua_field_named(item->kind, name, &index);
    tl_lua_ok(L, model, item->kind->field(model, item, index, &value));
    if (block)
        tl_lua_item_push_name(L, &tl_lua_block_kind, 3, &(tl_id){(tl_id)value.number[0]});
    else
        lua_pushinteger(L, number(&item->name));
    return true;
}

/* A state of its solid, too. */
static bool zone_extra(lua_State *L, tl_model *model, const tl_lua_item *item, const char *name)
{
    size_t index, width;
    if (part_extra(L, model, item, name))
        return true;
    if (tl_lua_field_named(item->kind, name, &index) || tl_zones_values(model, NULL, 0, name, NULL, &width) != TL_OK)
        return false;
    double value[6];
    tl_lua_ok(L, model, tl_zones_values(model, &item->name.zone, 1, name, value, &width));
    if (isnan(value[0]))
        return false;
    if (width == 1)
        lua_pushnumber(L, value[0]);
    else
        tl_lua_push_numbers(L, value, width);
    return true;
}

static const tl_lua_key no_extra_keys[] = {{NULL, NULL, NULL}};

/* ---------------------------------------------------------------- verbs of gridpoints ----- */

typedef struct hold_args {
    int32_t x, y, z;
} hold_args;

static const tl_param hold_params[] = {
    TL_PARAM(TL_PARAM_BOOL, hold_args, x, "", "the motion along x", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, hold_args, y, "", "the motion along y", .def = {0.0}),
    TL_PARAM(TL_PARAM_BOOL, hold_args, z, "", "the motion along z", .def = {0.0}),
};

/* The components that the table at index 2 names; all of them when it names none. */
static unsigned read_components(lua_State *L, const char *verb)
{
    hold_args args;
    const tl_lua_spec spec = {verb, hold_params, TL_LUA_COUNT(hold_params), NULL};
    tl_lua_read(L, 2, &spec, false, &args);
    lua_pushnil(L);
    if (!lua_istable(L, 2) || !lua_next(L, 2))
        return TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    const unsigned what = (args.x ? TL_FIX_X : 0u) | (args.y ? TL_FIX_Y : 0u) | (args.z ? TL_FIX_Z : 0u);
    if (what == 0)
        tl_lua_fail(L, "%s: no component is named: give x = true, y = true or z = true, or nothing for all", verb);
    return what;
}

static tl_status fix(lua_State *L, const tl_lua_selection *of)
{
    const unsigned what = read_components(L, "fix");
    return tl_gridpoints_fix(of->owner->model, of->names, of->count, what);
}

static tl_status let_go(lua_State *L, const tl_lua_selection *of)
{
    const unsigned what = read_components(L, "free");
    return tl_gridpoints_free(of->owner->model, of->names, of->count, what);
}

static const tl_param load_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_load, force, "N", "force on each, in the place of what it had",
             .flags = TL_PARAM_REQUIRED),
};

static tl_status load(lua_State *L, const tl_lua_selection *of)
{
    static const tl_lua_spec spec = {"load", load_params, TL_LUA_COUNT(load_params), NULL};
    tl_load given;
    tl_lua_read(L, 2, &spec, false, &given);
    return tl_gridpoints_load(of->owner->model, of->names, of->count, given.force);
}

static const tl_param drive_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_drive, at, "m", "where the gradient gives no velocity", .def = {0.0}),
};

static const tl_lua_key drive_keys[] = {
    {"velocity", "{x, y, z} or function(t)",
     "velocity, m/s; the function gives it for a time t, s: the middle of each step. Zero when left out"},
    {"gradient", "{{xx, xy, xz}, {yx, yy, yz}, {zx, zy, zz}}",
     "1/s: gradient times the place from `at` comes to the velocity"},
    {NULL, NULL, NULL},
};

/* Reads the gradient of the table at index 2; false: it has none. */
static bool read_gradient(lua_State *L, double gradient[3][3])
{
    if (tl_lua_option(L, 2, "gradient") == LUA_TNIL)
        return false;
    const int rows = lua_gettop(L);
    for (int i = 0; i < 3; i++) {
        const bool row = lua_istable(L, rows) && lua_rawlen(L, rows) == 3 &&
                         lua_rawgeti(L, rows, i + 1) == LUA_TTABLE && lua_rawlen(L, -1) == 3;
        for (int j = 0; j < 3; j++) {
            if (!row || lua_rawgeti(L, rows + 1, j + 1) != LUA_TNUMBER || !isfinite(lua_tonumber(L, -1)))
                tl_lua_fail(L, "drive: gradient must be a list of 3 lists of 3 finite numbers, 1/s");
            gradient[i][j] = lua_tonumber(L, -1);
        }
        lua_settop(L, rows);
    }
    return true;
}

/* Prescribes motion. An anchor holds a function: block.c. */
static tl_status drive(lua_State *L, const tl_lua_selection *of)
{
    static const tl_lua_spec spec = {"drive", drive_params, TL_LUA_COUNT(drive_params), drive_keys};
    static const tl_param vector[] = {TL_PARAM(TL_PARAM_VEC3, tl_drive, velocity, "m/s", "", .def = {0.0})};
    static const tl_lua_spec one = {"drive", vector, 1, NULL};
    tl_drive given = tl_drive_default(), read;
    tl_lua_read(L, 2, &spec, true, &given);
    const tl_vec3 at = given.at;
    lua_settop(L, 2);
    lua_getiuservalue(L, 1, 1);
    const int type = tl_lua_option(L, 2, "velocity");
    if (type == LUA_TFUNCTION) {
        lua_pushnil(L);
        tl_lua_anchor_push(L, 3, &given);
    } else if (type == LUA_TTABLE) {
        tl_lua_read_one(L, lua_gettop(L), &one, "velocity", &read);
        given.velocity = read.velocity;
    } else if (type != LUA_TNIL) {
        tl_lua_fail(L, "drive: velocity must be a list of 3 numbers or a function(t), not %s", tl_lua_describe(L, -1));
    }
    given.at = at;
    if (!read_gradient(L, given.gradient) && type == LUA_TNIL)
        tl_lua_fail(L, "drive: give velocity, gradient or both; to hold gridpoints use fix, to let them go free");
    const tl_status status = tl_gridpoints_drive(of->owner->model, of->names, of->count, &given);
    if (status == TL_OK && of->count > 0 && given.user)
        ((tl_lua_anchor *)given.user)->ended = false;
    return status;
}

/* Three numbers that a function gave, from stack index `from` on, or a list of them there. */
static tl_vec3 read_vector(lua_State *L, int function, int from)
{
    double v[3];
    if (lua_istable(L, from)) {
        for (int k = 1; k <= 3; k++)
            lua_rawgeti(L, from, k);
        from = lua_gettop(L) - 2;
    }
    for (int k = 0; k < 3; k++) {
        v[k] = lua_type(L, from + k) == LUA_TNUMBER ? lua_tonumber(L, from + k) : NAN;
        if (!isfinite(v[k]))
            tl_lua_fail_in(L, function, "set: velocity must give three finite numbers: one is %s",
                           tl_lua_describe(L, from + k));
    }
    return (tl_vec3){v[0], v[1], v[2]};
}

/* Velocities of all, by the function at the top of the stack, of place and velocity. Pushes what holds them. */
static tl_vec3 *ask_velocities(lua_State *L, tl_model *model, const tl_lua_selection *of)
{
    const int function = lua_gettop(L);
    size_t width;
    tl_vec3 *velocity = lua_newuserdatauv(L, (of->count + 1) * sizeof *velocity, 0);
    double *place = lua_newuserdatauv(L, (3 * of->count + 1) * sizeof *place, 0);
    double *now = lua_newuserdatauv(L, (3 * of->count + 1) * sizeof *now, 0);
    tl_lua_ok(L, model, tl_gridpoints_values(model, of->names, of->count, "position", place, &width));
    tl_lua_ok(L, model, tl_gridpoints_values(model, of->names, of->count, "velocity", now, &width));
    const int top = lua_gettop(L);
    for (size_t i = 0; i < of->count; i++) {
        lua_pushvalue(L, function);
        tl_lua_push_numbers(L, place + 3 * i, 3);
        tl_lua_push_numbers(L, now + 3 * i, 3);
        lua_call(L, 2, LUA_MULTRET);
        luaL_checkstack(L, 8, "too many values");
        lua_settop(L, lua_gettop(L) > top + 3 ? lua_gettop(L) : top + 3);
        velocity[i] = read_vector(L, function, top + 1);
        lua_settop(L, top);
    }
    return velocity;
}

static const tl_param set_params[] = {
    TL_PARAM(TL_PARAM_VEC3, tl_load, force, "m/s", "", .def = {0.0}),
};

static const tl_lua_key set_keys[] = {
    {"velocity", "{x, y, z} or function({x, y, z}, {x, y, z})",
     "velocity, m/s; the function gives it for a place and the velocity now, as a list or as three numbers"},
    {NULL, NULL, NULL},
};

static tl_status set(lua_State *L, const tl_lua_selection *of)
{
    static const tl_lua_spec spec = {"set", NULL, 0, set_keys};
    static const tl_lua_spec one = {"set", set_params, 1, NULL};
    tl_model *model = of->owner->model;
    tl_lua_read(L, 2, &spec, false, NULL);
    const int type = tl_lua_option(L, 2, "velocity");
    if (type == LUA_TFUNCTION)
        return tl_gridpoints_velocity(model, of->names, of->count, ask_velocities(L, model, of));
    if (type != LUA_TTABLE)
        tl_lua_fail(L, "set: give velocity, a list of 3 numbers or a function, not %s", tl_lua_describe(L, -1));
    tl_load read;
    tl_lua_read_one(L, lua_gettop(L), &one, "force", &read);
    tl_vec3 *velocity = lua_newuserdatauv(L, (of->count + 1) * sizeof *velocity, 0);
    for (size_t i = 0; i < of->count; i++)
        velocity[i] = read.force;
    return tl_gridpoints_velocity(model, of->names, of->count, velocity);
}

static int reaction(lua_State *L, const tl_lua_selection *of)
{
    tl_model *model = tl_lua_living(L, of->owner);
    tl_vec3 force;
    tl_lua_ok(L, model, tl_gridpoints_reaction(model, of->names, of->count, &force));
    tl_lua_push_numbers(L, &force.x, 3);
    return 1;
}

typedef struct solid_args {
    const char *solid;
} solid_args;

static const tl_param solid_params[] = {
    TL_PARAM(TL_PARAM_STRING, solid_args, solid, "", "the solid that they get, by its name",
             .flags = TL_PARAM_REQUIRED),
};

static tl_status set_zones(lua_State *L, const tl_lua_selection *of)
{
    static const tl_lua_spec spec = {"set", solid_params, TL_LUA_COUNT(solid_params), NULL};
    solid_args given;
    tl_lua_read(L, 2, &spec, false, &given);
    return tl_zones_solid(of->owner->model, of->names, of->count, given.solid);
}

static const tl_lua_verb zone_verbs[] = {
    {.name = "set", .arguments = 1, .act = set_zones, .done = "changed"},
    {.name = NULL},
};

static const tl_lua_verb gridpoint_verbs[] = {
    {.name = "fix", .arguments = 1, .act = fix, .done = "held"},
    {.name = "free", .arguments = 1, .act = let_go, .done = "set free"},
    {.name = "load", .arguments = 1, .act = load, .done = "loaded"},
    {.name = "drive", .arguments = 1, .act = drive, .done = "driven"},
    {.name = "set", .arguments = 1, .act = set, .done = "changed"},
    {.name = "reaction", .ask = reaction},
    {.name = NULL},
};

/* ---------------------------------------------------------------- kinds ------------------ */

const tl_lua_kind tl_lua_zone_kind = {
    .item = "zone",
    .items = "zones",
    .item_type = TL_LUA_ZONE,
    .selection_type = TL_LUA_ZONES,
    .name_size = sizeof(tl_zone_name),
    .number = number,
    .bearer = "solid",
    .fields = tl_zone_fields,
    .field = zone_field,
    .values = zone_values,
    .extra = zone_extra,
    .extra_keys = no_extra_keys,
    .verbs = zone_verbs,
};

const tl_lua_kind tl_lua_gridpoint_kind = {
    .item = "gridpoint",
    .items = "gridpoints",
    .item_type = TL_LUA_GRIDPOINT,
    .selection_type = TL_LUA_GRIDPOINTS,
    .name_size = sizeof(tl_zone_name),
    .number = number,
    .bearer = "solid",
    .fields = tl_gridpoint_fields,
    .field = gridpoint_field,
    .values = gridpoint_values,
    .extra = part_extra,
    .extra_keys = no_extra_keys,
    .verbs = gridpoint_verbs,
};

/* ---------------------------------------------------------------- help ------------------- */

static const tl_lua_key zone_methods[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of zones, the i-th one, all in order of id"},
    {"sel:sum(field)", "", "sum of a field of numbers, or of a state of a solid; of a vector a vector"},
    {"sel:max(field), sel:min(field)", "",
     "largest and smallest value of a field of numbers, of a component, as \"stress.zz\" (of \"principal\" x is the "
     "largest, z the least), or of a state"},
    {"sel:values(field)", "",
     "list of the field's values, in the order of the selection; likewise a state of a solid, by its name, NaN where "
     "the zone's solid has no such state. With \"flat\" after it vectors and tensors are not lists of their own"},
    {"sel:where(function(zone) ... end)", "", "those for which the function answers true"},
    {"sel:set{solid = \"fault\"}", "",
     "gives them another solid, named by model:solid. Stress stays, and states that both solids have by the same "
     "names; "
     "what it changes of the stored energy counts as work by hand"},
    {NULL, NULL, NULL},
};

static const tl_lua_key gridpoint_methods[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of gridpoints, the i-th one, all in order of id"},
    {"sel:sum(field), sel:max(field), sel:min(field)", "",
     "sum, largest and smallest value of a field of numbers, or of a component, as \"displacement.z\""},
    {"sel:values(field)", "", "list of the field's values, in the order of the selection; \"flat\" as of blocks"},
    {"sel:where(function(gridpoint) ... end)", "", "those for which the function answers true"},
    {"sel:fix{x =, y =, z =}", "",
     "holds components of their motion at their velocity, which is 0 unless it was set; all when none is named"},
    {"sel:free{x =, y =, z =}", "", "lets components go; all when none is named"},
    {"sel:load{force = {x, y, z}}", "", "a force on each, N, in the place of what it had"},
    {"sel:drive{velocity =, gradient =, at =}", "",
     "prescribes their motion in all components, until sel:free(): velocity, m/s, is {x, y, z} or a function(t), "
     "called "
     "in the middle of each step; gradient, three rows of three numbers, 1/s, adds gradient times the place from at"},
    {"sel:set{velocity =}", "", "velocities, m/s: {x, y, z} or a function(place, velocity)"},
    {"sel:reaction()", "", "sum of the forces that hold their held components, N: {x, y, z}"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_zone_topics[] = {
    {.name = "zones",
     .usage = "selection = model:zones{...}",
     .doc = "Selects zones of deformable blocks, of visible ones unless asked otherwise; all conditions must hold. "
            "Beside its fields a zone has the states of its solid by their names, as zone.plastic_shear.",
     .spec = &zones_spec,
     .kind = &tl_lua_zone_kind,
     .title = "Methods of the selection",
     .verbs = zone_methods,
     .arguments = 1,
     .method = model_zones},
    {.name = "gridpoints",
     .usage = "selection = model:gridpoints{...}",
     .doc = "Selects gridpoints, the corners of zones; all conditions must hold.",
     .spec = &gridpoints_spec,
     .kind = &tl_lua_gridpoint_kind,
     .title = "Methods of the selection",
     .verbs = gridpoint_methods,
     .arguments = 1,
     .method = model_gridpoints},
    {.name = NULL},
};
