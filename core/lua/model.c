/* model.c - the model as a Lua object: talus.model, its fields and its short methods. */
#include "lua/model.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/joint.h"
#include "lua/living.h"
#include "lua/quality.h"
#include "lua/quiet.h"
#include "lua/run.h"
#include "lua/view.h"
#include "lua/wave_checks.h"
#include "lua/zones.h"

#include <math.h>
#include <string.h>
#include <talus/elements.h>
#include <talus/zones.h>

/* ---------------------------------------------------------------- life ------------------- */

static int model_create(lua_State *L)
{
    tl_lua_arity(L, 1, "talus.model");
    lua_settop(L, 1);
    tl_lua_spec spec = tl_lua_spec_of("model", NULL);
    spec.context = "talus.model";
    tl_model_config config = tl_model_config_default();
    tl_lua_read(L, 1, &spec, false, &config);
    if (tl_lua_option(L, 1, "threads") == LUA_TNIL)
        tl_lua_default_threads(L, &config.threads);
    tl_lua_model *object = tl_lua_model_push(L);
    tl_error error;
    if (tl_model_create(&config, &object->model, &error) != TL_OK)
        return tl_lua_raise(L, &error);
    tl_lua_model_begin(L, object);
    tl_model_set_gravity(object->model, config.gravity); /* now that remarks are heard */
    return 1;
}

static int model_collect(lua_State *L)
{
    tl_lua_model *object = luaL_checkudata(L, 1, TL_LUA_MODEL_TYPE);
    tl_lua_view_end(L, object);
    tl_model_destroy(object->model);
    object->model = NULL;
    return 0;
}

static int model_text(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "tostring");
    lua_pushfstring(L, "model of %I blocks", (lua_Integer)tl_block_count(model));
    return 1;
}

/* ---------------------------------------------------------------- methods ---------------- */

static int model_damping(lua_State *L, tl_model *model)
{
    const char *damping = tl_lua_text(L, 2, "damping", "the damping's name");
    tl_args args;
    tl_lua_args(L, 3, lua_pushfstring(L, "damping '%s'", damping), NULL, &args);
    if (tl_lua_damps_all(damping))
        tl_lua_waves_keep(L, model, damping);
    const tl_lua_selection *fields = tl_lua_free_fields(L, model); /* before something is changed */
    tl_lua_ok(L, model, tl_model_damping(model, damping, &args));
    tl_lua_free_field_damp(L, model, fields);
    return 0;
}

static const tl_lua_key insitu_keys[] = {
    {"stress", "{xx =, yy =, zz =, xy =, yz =, zx =}",
     "stress at the height of `at`, Pa, tension positive; components left out are 0. yx, zy and xz "
     "are the same as xy, yz and zx"},
    {"gradient", "{xx =, yy =, zz =, xy =, yz =, zx =}",
     "change of the stress with height z, Pa/m; components left out are 0"},
    {"blocks", "selection of blocks", "puts the stress in their zones, and on their contacts with any; all without it"},
    {NULL, NULL, NULL},
};

/* Reads the blocks, which stay on the stack. */
static void read_insitu_blocks(lua_State *L, tl_insitu *insitu)
{
    static const tl_id none = TL_NO_ID; /* an empty selection has no list, but NULL would mean all */
    if (tl_lua_option(L, 2, "blocks") == LUA_TNIL)
        return;
    const tl_lua_selection *blocks = luaL_testudata(L, -1, TL_LUA_BLOCKS);
    if (!blocks)
        tl_lua_fail(L, "insitu: blocks must be a selection of blocks, not %s", tl_lua_describe(L, -1));
    if (blocks->owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "insitu: blocks belong to another model");
    insitu->blocks = blocks->count > 0 ? blocks->names : &none;
    insitu->block_count = blocks->count;
}

static int model_insitu(lua_State *L, tl_model *model)
{
    tl_insitu insitu = tl_insitu_default();
    tl_lua_read_function(L, 2, "insitu", insitu_keys, &insitu);
    if (!lua_istable(L, 2))
        return tl_lua_fail(L, "insitu: give the parameters in a table");
    bool stress = tl_lua_read_tensor(L, 2, "insitu", "stress", &insitu.stress);
    bool gradient = tl_lua_read_tensor(L, 2, "insitu", "gradient", &insitu.gradient);
    if (!stress && !gradient)
        return tl_lua_fail(L, "insitu: give stress = {xx = ...}, gradient = {zz = ...} or both");
    read_insitu_blocks(L, &insitu);
    tl_lua_ok(L, model, tl_model_insitu(model, &insitu));
    return 0;
}

/* model:timestep(): where the step comes from. */
static int push_timestep_report(lua_State *L, tl_model *model)
{
    tl_timestep_report report;
    tl_lua_ok(L, model, tl_model_timestep_report(model, &report));
    lua_createtable(L, 0, 6);
    tl_lua_set_number(L, "dt", report.dt);
    tl_lua_set_block(L, "block", report.block);
    tl_lua_set_block(L, "partner", report.partner);
    if (report.block != TL_NO_ID)
        TL_LUA_SET_NUMBERS(L, {"mass", report.mass}, {"stiffness", report.stiffness});
    tl_zone_name point;
    if (report.by == TL_STEP_BY_ZONES && tl_model_timestep_gridpoint(model, &point) == TL_OK)
        tl_lua_set_count(L, "gridpoint", point.number);
    tl_lua_push_timestep(L, model, &report);
    lua_setfield(L, -2, "message");
    return 1;
}

static int model_timestep(lua_State *L, tl_model *model)
{
    if (lua_isnil(L, 2))
        return push_timestep_report(L, model);
    tl_timestep timestep = tl_timestep_default();
    tl_lua_read_function(L, 2, "timestep", NULL, &timestep);
    tl_lua_ok(L, model, tl_model_timestep(model, &timestep));
    return 0;
}

/* model:mass_scaling(): what the last step has added. */
static int push_mass_added(lua_State *L, const tl_model *model)
{
    tl_mass_added added = tl_model_mass_added(model);
    lua_createtable(L, 0, 6);
    lua_pushboolean(L, added.on);
    lua_setfield(L, -2, "on");
    if (isnan(added.dt))
        return 1;
    TL_LUA_SET_NUMBERS(L, {"dt", added.dt}, {"most", added.most}, {"added", added.share});
    const tl_gridpoints_added points = tl_model_gridpoints_added(model);
    tl_lua_set_count(L, "bodies", added.bodies);
    tl_lua_set_count(L, "gridpoints", points.gridpoints);
    if (added.worst != TL_NO_ID) {
        lua_createtable(L, 0, 2);
        tl_lua_set_count(L, "block", added.worst); /* a number: it may have been deleted */
        tl_lua_set_number(L, "factor", added.factor);
        if (points.worst.body != TL_NO_ID)
            tl_lua_set_count(L, "gridpoint", points.worst.number);
        lua_setfield(L, -2, "worst");
    }
    return 1;
}

static int model_mass_scaling(lua_State *L, tl_model *model)
{
    if (lua_isnil(L, 2))
        return push_mass_added(L, model);
    tl_mass_scaling scaling = tl_mass_scaling_default();
    tl_lua_spec spec = tl_lua_spec_of("mass_scaling", NULL);
    if (lua_istable(L, 2))
        tl_lua_read(L, 2, &spec, false, &scaling);
    else
        tl_lua_read_one(L, 2, &spec, "on", &scaling);
    tl_lua_ok(L, model, tl_model_mass_scaling(model, &scaling));
    return 0;
}

static int model_energy(lua_State *L, tl_model *model)
{
    tl_energy energy;
    tl_zone_energy zones;
    tl_element_energy elements;
    tl_lua_ok(L, model, tl_model_energy(model, &energy));
    tl_lua_ok(L, model, tl_model_zone_energy(model, &zones));
    tl_lua_ok(L, model, tl_model_element_energy(model, &elements));
    lua_createtable(L, 0, 9);
#define SET(name, unit, doc) tl_lua_set_number(L, #name, energy.name);
    TL_ENERGY(SET)
#undef SET
#define SET(name, unit, doc) tl_lua_set_number(L, #name, zones.name);
    TL_ZONE_ENERGY(SET)
#undef SET
    TL_LUA_SET_NUMBERS(L, {"elements", elements.stored}, {"element_loss", elements.lost});
    return 1;
}

static int model_contact_area(lua_State *L, tl_model *model)
{
    tl_contact_area rule = tl_contact_area_default();
    tl_lua_read_function(L, 2, "contact_area", NULL, &rule);
    tl_lua_ok(L, model, tl_model_contact_area(model, &rule));
    return 0;
}

static int model_state_hash(lua_State *L, tl_model *model)
{
    char text[33];
    tl_lua_ok(L, model, tl_state_hash(model, text));
    lua_pushstring(L, text);
    return 1;
}

/* ---------------------------------------------------------------- fields ----------------- */

static tl_status set_gravity(tl_model *m, const tl_model_config *to)
{
    return tl_model_set_gravity(m, to->gravity);
}

static tl_status set_rotation(tl_model *m, const tl_model_config *to)
{
    return tl_model_set_rotation(m, (tl_rotation_rule)to->rotation);
}

static tl_status set_contact_points(tl_model *m, const tl_model_config *to)
{
    return tl_model_set_contact_points(m, (tl_contact_points)to->contact_points);
}

static tl_status set_reuse_geometry(tl_model *m, const tl_model_config *to)
{
    return tl_model_set_reuse_geometry(m, to->reuse_geometry);
}

/* How a field is set, or why it cannot be. */
static const struct {
    const char *name;
    tl_status (*set)(tl_model *m, const tl_model_config *to);
    const char *refusal;
} model_fields[] = {
    {"gravity", set_gravity, NULL},
    {"rotation", set_rotation, NULL},
    {"reuse_geometry", set_reuse_geometry, NULL},
    {"contact_points", set_contact_points, NULL},
    {"mass_scaled", NULL, "can only be read; set it with model:mass_scaling(true)"},
    {"time", NULL, "can only be read"},
    {"cycles", NULL, "can only be read"},
    {"dt", NULL, "can only be read; set it with model:timestep{dt = ...}"},
    {"threads", NULL, "is chosen when the model is made: talus.model{threads = ...}"},
    {"seed", NULL, "is chosen when the model is made: talus.model{seed = ...}"},
};

enum { FIELDS = sizeof model_fields / sizeof *model_fields };

/* Upvalue 1 is the table of methods. */
static int unknown_field(lua_State *L, const char *what, const char *name)
{
    tl_lua_names names = {0};
    for (size_t i = 0; i < FIELDS; i++)
        tl_lua_names_add(&names, model_fields[i].name);
    for (lua_pushnil(L); lua_next(L, lua_upvalueindex(1)); lua_pop(L, 1))
        tl_lua_names_add(&names, lua_tostring(L, -2));
    return tl_lua_unknown(L, what, name, &names);
}

/* Raises an error where the name is that of what selections do. */
static void fail_as_verb(lua_State *L, const char *name)
{
    static const tl_lua_kind *const kinds[] = {&tl_lua_block_kind, &tl_lua_zone_kind, &tl_lua_gridpoint_kind};
    for (size_t k = 0; k < TL_LUA_COUNT(kinds); k++)
        for (const tl_lua_verb *verb = kinds[k]->verbs; verb->name; verb++)
            if (strcmp(verb->name, name) == 0)
                tl_lua_fail(L, "a model has no field '%s'; a selection has it: model:%s{...}:%s", name, kinds[k]->items,
                            name);
}

/* Upvalue 1 is the table of methods. */
static int model_index(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "index");
    lua_pushvalue(L, 2);
    if (lua_rawget(L, lua_upvalueindex(1)) != LUA_TNIL)
        return 1;
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a model has no field %s", tl_lua_describe(L, 2));
    const char *name = lua_tostring(L, 2);
    const tl_param *setting = tl_lua_param_named("model", name);
    if (setting) {
        tl_model_config config = tl_model_settings(model);
        tl_lua_push_param(L, setting, &config);
    } else if (strcmp(name, "time") == 0)
        lua_pushnumber(L, tl_model_time(model));
    else if (strcmp(name, "cycles") == 0)
        lua_pushinteger(L, (lua_Integer)tl_model_cycles(model));
    else if (strcmp(name, "mass_scaled") == 0)
        lua_pushboolean(L, tl_model_mass_added(model).on);
    else if (strcmp(name, "dt") == 0) {
        double dt;
        tl_lua_ok(L, model, tl_model_dt(model, &dt));
        lua_pushnumber(L, dt);
    } else {
        fail_as_verb(L, name);
        return unknown_field(L, "a model has no field", name);
    }
    return 1;
}

static int model_assign(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "assignment");
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "a model has no field %s", tl_lua_describe(L, 2));
    const char *name = lua_tostring(L, 2);
    size_t i = 0;
    while (i < FIELDS && strcmp(model_fields[i].name, name) != 0)
        i++;
    if (i == FIELDS)
        return unknown_field(L, "a model has no field to set", name);
    if (!model_fields[i].set)
        return tl_lua_fail(L, "model.%s %s", name, model_fields[i].refusal);
    tl_lua_spec spec = tl_lua_spec_of("model", NULL);
    tl_model_config config;
    tl_lua_read_one(L, 3, &spec, name, &config);
    tl_lua_ok(L, model, model_fields[i].set(model, &config));
    return 0;
}

void tl_lua_model_open(lua_State *L)
{
    if (luaL_newmetatable(L, TL_LUA_MODEL_TYPE)) {
        lua_pushvalue(L, -2); /* the methods */
        const luaL_Reg meta[] = {{"__index", model_index},   {"__newindex", model_assign}, {"__gc", model_collect},
                                 {"__close", model_collect}, {"__tostring", model_text},   {NULL, NULL}};
        luaL_setfuncs(L, meta, 1);
        lua_pushliteral(L, "a model");
        lua_setfield(L, -2, "__metatable");
    }
    lua_pop(L, 2);
    lua_pushcfunction(L, model_create);
}

static const tl_lua_key model_members[] = {
    {"model.gravity", "", "acceleration of gravity {x, y, z}, m/s2; may be assigned"},
    {"model.rotation", "", "\"exact\" or \"paper\"; may be assigned"},
    {"model.contact_points", "",
     "\"consistent\" or \"corners\" (not of faces that meet another at less than 20 degrees); may be assigned"},
    {"model.reuse_geometry", "", "true or false; may be assigned"},
    {"model.time, model.cycles", "", "simulated time, s, and steps so far"},
    {"model.mass_scaled", "", "whether mass scaling is on"},
    {"model.dt", "", "the step the next cycle will use, s"},
    {"model.threads, model.seed", "", "as given when it was made"},
    {NULL, NULL, NULL},
};

static const tl_lua_key generate_results[] = {
    {"before, after", "", "number of blocks before and after"},
    {"cuts, refused, coincident", "",
     "cuts made, refused because a side would be too thin, and fallen on an existing face"},
    {"smallest_volume, smallest_edge, smallest_face", "", "of the model after, m3, m and m2"},
    {"volume_error", "", "relative change of the volume that is not accounted for"},
    {"slivers", "",
     "blocks that this call made with an aspect over 50, or with less than 0.001 of the mean volume of a block; "
     "model:filter{auto = true} joins those that decide the time step"},
    {"report", "",
     "where a file was read: what holds of it all by name, and a list of {name =, ...} of the objects to which "
     "something "
     "was done, or that were refused"},
    {NULL, NULL, NULL},
};

static const tl_lua_key timestep_results[] = {
    {"dt", "", "the step the next cycle will use, s; 0 where nothing can move and no law is set"},
    {"block", "", "the block that controls it, or nil"},
    {"partner", "", "the block at the stiffest contact, or nil"},
    {"gridpoint", "", "the number of the gridpoint in its block where zones control it, or nil"},
    {"mass, stiffness", "",
     "of the block's body or that gridpoint, kg; of what holds the gridpoint, or of the contact, of all its contacts "
     "or of the part of its largest "
     "face that counts, N/m"},
    {"message", "", "the same in a sentence"},
    {NULL, NULL, NULL},
};

static const tl_lua_key mass_scaling_results[] = {
    {"on", "", "whether inertia is scaled; the other fields are there after mass_scaling{dt =} only"},
    {"dt, most", "", "the step, s, and the largest share, as given"},
    {"added", "", "mass that the last step has added, as a share of that of the bodies that can move"},
    {"bodies, gridpoints", "", "how many have got some; a deformable body by some gridpoint"},
    {"worst", "",
     "{block =, factor =}: the number of the block with the highest factor, and its inertia over "
     "its own; of a deformable one {block =, gridpoint =, factor =}, and the mass of the gridpoint; nil when none has "
     "got any"},
    {NULL, NULL, NULL},
};

#define KEY(name, unit, doc) {#name, "", doc},
static const tl_lua_key energy_terms[] = {
    TL_ENERGY(KEY) TL_ZONE_ENERGY(KEY){"elements", "", "held by elements, part of stored, J"},
    {"element_loss", "", "turned to heat by elements until now, part of friction, J"},
    {NULL, NULL, NULL}};
#undef KEY

const tl_lua_topic tl_lua_model_topics[] = {
    {.name = "model",
     .usage = "model = talus.model{gravity = {0, 0, -9.81}, ...}",
     .function = "model",
     .title = "Fields of the model",
     .verbs = model_members},
    {.name = "generate",
     .usage = "summary = model:generate(\"GENERATOR\", {...})",
     .doc =
         "Creates or cuts blocks; acts on visible blocks only, wholly or not at all. A list of tables, {{...}, "
         "{...}}, in the place of one: once for each, in their order and in one go. What an earlier entry makes and a "
         "later one cuts gets no ids, so ids are not those of a call for each entry.",
     .has_type = true,
     .type = TL_KIND_GENERATOR,
     .title = "Fields of the summary",
     .verbs = generate_results,
     .arguments = 2,
     .method = tl_lua_model_generate},
    {.name = "joint",
     .usage = "model:joint(\"J1\", \"LAW\", {...})  or  model:joint(\"J1\", {friction = 30})",
     .doc =
         "Sets the law of a joint set (\"J1\"), of one of its planes (\"J1:3\") or of every joint not named otherwise "
         "(\"*\"). A table, or a selection of blocks or contacts, in the place of the name: of contacts between "
         "groups or selections. Without a law's name it changes properties. The law that names more wins: first by "
         "how many of the two blocks it names, then by how closely it names the joint (plane, set, *), then the one "
         "named later.",
     .title = "Keys of a table in the place of the name",
     .verbs = tl_lua_joint_keys,
     .has_type = true,
     .type = TL_KIND_LAW,
     .arguments = 3,
     .method = tl_lua_model_joint},
    {.name = "insitu",
     .usage = "model:insitu{stress = {zz = -1e6}, gradient = {zz = 2e4}, at = {0, 0, 0}}",
     .function = "insitu",
     .keys = insitu_keys,
     .arguments = 1,
     .method = model_insitu},
    {.name = "damping",
     .usage = "model:damping(\"DAMPING\", {...})",
     .doc = "Chooses how motion is damped; \"none\" is no damping, and the default.",
     .has_type = true,
     .type = TL_KIND_DAMPING,
     .arguments = 2,
     .method = model_damping},
    {.name = "timestep",
     .usage = "model:timestep{fraction = 0.3}  or  report = model:timestep()",
     .function = "timestep",
     .title = "Fields of the report",
     .verbs = timestep_results,
     .arguments = 1,
     .method = model_timestep},
    {.name = "mass_scaling",
     .usage = "model:mass_scaling(true)  or  model:mass_scaling{dt = 1e-4}  or  added = model:mass_scaling()",
     .function = "mass_scaling",
     .title = "Fields of what it tells",
     .verbs = mass_scaling_results,
     .arguments = 1,
     .method = model_mass_scaling},
    {.name = "contact_area",
     .usage = "model:contact_area{fraction = 0.01}",
     .function = "contact_area",
     .arguments = 1,
     .method = model_contact_area},
    {.name = "energy",
     .usage = "energy = model:energy()",
     .doc = "The energy of the bodies that are free to move, at the last force evaluation, counted "
            "from the first step. After model:relax stored, potential and friction keep their meaning; damping and "
            "external also hold what its own inertia and stops have taken and given, so balance goes on from what it "
            "was.",
     .title = "Fields of the energy",
     .verbs = energy_terms,
     .method = model_energy},
    {.name = "state_hash",
     .usage = "text = model:state_hash()",
     .doc = "A digest of all that what comes next depends on, settings too: models with the same "
            "text go on alike, to the last bit. Takes about as long as a step.",
     .method = model_state_hash},
    {.name = NULL},
};
