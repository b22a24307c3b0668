/* lists.c - what there is: model:joints(), model:laws(), model:groups(); talus.laws(), talus.dampings(), talus.generators(). */
#include "lua/lists.h"

#include "lua/convert.h"
#include "lua/front.h"
#include "lua/living.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

static const tl_lua_key joints_results[] = {
    {"name, planes", "", "of the joint set; number of its planes so far"},
    {"law", "", "name of the law of the set as a whole; nil while it has none"},
    {NULL, NULL, NULL},
};
static const tl_lua_key laws_results[] = {
    {"joint, law", "", "\"*\", \"J1\" or \"J1:3\", and the name of the law that was set for it"},
    {"parameters", "", "{NAME = value}, as they are now; one that may be left out and was is nil"},
    {NULL, NULL, NULL},
};
static const tl_lua_key groups_results[] = {
    {"name", "", "of the group"},
    {"blocks, volume", "", "number of its blocks, hidden ones, too, and their volume, m3"},
    {NULL, NULL, NULL},
};
static const tl_lua_key kinds_results[] = {
    {"name, doc, plugin", "", "its name, what it does, the plugin it is of"},
    {"parameters", "", "list of the names of its parameters"},
    {"states", "", "list of the names of its states"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- parameters ------------- */

static const tl_param *param_at(const tl_kind *kind, uint32_t i)
{
    return (const tl_param *)(const void *)((const char *)kind->params +
                                            (size_t)i * kind->param_stride);
}

static const tl_state *state_at(const tl_kind *kind, uint32_t i)
{
    return (const tl_state *)(const void *)((const char *)kind->states +
                                            (size_t)i * kind->state_stride);
}

/* Pushes the value of a parameter, nil for one that was left out. */
static void push_param(lua_State *L, const tl_param *param, const void *params)
{
    const char *at = (const char *)params + param->offset;
    double real;
    int64_t whole;
    int32_t small;
    tl_vec3 v;
    switch (param->type) {
    case TL_PARAM_REAL:
        memcpy(&real, at, sizeof real);
        if (isnan(real))
            lua_pushnil(L);
        else
            lua_pushnumber(L, real);
        break;
    case TL_PARAM_INT:
        memcpy(&whole, at, sizeof whole);
        lua_pushinteger(L, (lua_Integer)whole);
        break;
    case TL_PARAM_BOOL:
        memcpy(&small, at, sizeof small);
        lua_pushboolean(L, small);
        break;
    case TL_PARAM_ENUM:
        memcpy(&small, at, sizeof small);
        lua_pushstring(L, param->choices[small]);
        break;
    case TL_PARAM_VEC3:
        memcpy(&v, at, sizeof v);
        if (isnan(v.x))
            lua_pushnil(L);
        else
            tl_lua_push_vec3(L, v);
        break;
    default: lua_pushnil(L);
    }
}

/* ---------------------------------------------------------------- of a model ------------- */

static int model_joints(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "joints");
    tl_lua_arity(L, 1, "joints");
    size_t count = tl_joint_count(model);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        tl_joint_info joint = tl_joint_at(model, i);
        lua_createtable(L, 0, 3);
        tl_lua_set_text(L, "name", joint.name);
        tl_lua_set_count(L, "planes", joint.planes);
        tl_lua_set_text(L, "law", joint.law ? joint.law->name : NULL);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

/* Pushes "*", "J1" or "J1:3". */
static void push_pattern(lua_State *L, tl_model *model, tl_tag joint)
{
    if (joint.joint == 0)
        lua_pushliteral(L, "*");
    else if (joint.plane == 0)
        lua_pushstring(L, tl_joint_at(model, joint.joint - 1).name);
    else
        lua_pushstring(L, tl_tag_name(model, joint));
}

static int model_laws(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "laws");
    tl_lua_arity(L, 1, "laws");
    size_t count = tl_law_count(model);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        tl_law_info law = tl_law_at(model, i);
        lua_createtable(L, 0, 3);
        push_pattern(L, model, law.joint);
        lua_setfield(L, -2, "joint");
        tl_lua_set_text(L, "law", law.law->name);
        lua_createtable(L, 0, (int)law.law->param_count);
        for (uint32_t k = 0; k < law.law->param_count; k++) {
            push_param(L, param_at(law.law, k), law.params);
            lua_setfield(L, -2, param_at(law.law, k)->name);
        }
        lua_setfield(L, -2, "parameters");
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static int model_groups(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "groups");
    tl_lua_arity(L, 1, "groups");
    size_t count = tl_group_count(model), listed = 0;
    size_t *blocks = lua_newuserdatauv(L, (count + 1) * sizeof *blocks, 0);
    double *volumes = lua_newuserdatauv(L, (count + 1) * sizeof *volumes, 0);
    tl_groups_tally(model, blocks, volumes);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        if (blocks[i] == 0)
            continue;
        lua_createtable(L, 0, 3);
        tl_lua_set_text(L, "name", tl_group_name(model, i));
        tl_lua_set_count(L, "blocks", blocks[i]);
        tl_lua_set_number(L, "volume", volumes[i]);
        lua_rawseti(L, -2, (lua_Integer)++listed);
    }
    return 1;
}

/* ---------------------------------------------------------------- of the program --------- */

static void push_kind(lua_State *L, const tl_kind *kind)
{
    lua_createtable(L, 0, 5);
    tl_lua_set_text(L, "name", kind->name);
    tl_lua_set_text(L, "doc", kind->doc ? kind->doc : "");
    const tl_plugin *plugin = tl_plugin_of(kind, NULL);
    tl_lua_set_text(L, "plugin", plugin ? plugin->id : NULL);
    lua_createtable(L, (int)kind->param_count, 0);
    for (uint32_t i = 0; i < kind->param_count; i++) {
        lua_pushstring(L, param_at(kind, i)->name);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "parameters");
    lua_createtable(L, (int)kind->state_count, 0);
    for (uint32_t i = 0; i < kind->state_count; i++) {
        lua_pushstring(L, state_at(kind, i)->name);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "states");
}

/* The kinds of a type. Upvalue 1 is the type, upvalue 2 the function's name. */
static int module_kinds(lua_State *L)
{
    tl_lua_arity(L, 0, lua_tostring(L, lua_upvalueindex(2)));
    tl_kind_type type = (tl_kind_type)lua_tointeger(L, lua_upvalueindex(1));
    lua_newtable(L);
    const tl_kind *kind;
    for (size_t i = 0; (kind = tl_plugin_kind(type, i)) != NULL; i++) {
        push_kind(L, kind);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

void tl_lua_lists_open(lua_State *L)
{
    static const struct {
        const char *name;
        tl_kind_type type;
    } lists[] = {{"laws", TL_KIND_LAW},
                 {"dampings", TL_KIND_DAMPING},
                 {"generators", TL_KIND_GENERATOR},
                 {"screens", TL_KIND_SCREEN}};
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        lua_pushinteger(L, lists[i].type);
        lua_pushfstring(L, "talus.%s", lists[i].name);
        lua_pushcclosure(L, module_kinds, 2);
        lua_setfield(L, -2, lists[i].name);
    }
}

/* ---------------------------------------------------------------- parameters in force -----
 *
 * Model:parameters(): all parameters that a model has now, with those the script has left out. */

#define NAME_COLUMNS 20

static void set_number(lua_State *L, const char *name, double number)
{
    lua_pushnumber(L, number);
    lua_setfield(L, -2, name);
}

static void set_text(lua_State *L, const char *name, const char *text)
{
    lua_pushstring(L, text);
    lua_setfield(L, -2, name);
}

/* ---------------------------------------------------------------- one parameter ---------- */

/* Room for the text of a parameter's value. */
#define VALUE_TEXT 200

static double number_of(const tl_param *param, const void *params)
{
    const char *at = (const char *)params + param->offset;
    double real;
    int64_t whole;
    int32_t choice;
    switch (param->type) {
    case TL_PARAM_REAL: memcpy(&real, at, sizeof real); return real;
    case TL_PARAM_INT: memcpy(&whole, at, sizeof whole); return (double)whole;
    default: memcpy(&choice, at, sizeof choice); return choice;
    }
}

static tl_vec3 vector_of(const tl_param *param, const void *params)
{
    tl_vec3 v;
    memcpy(&v, (const char *)params + param->offset, sizeof v);
    return v;
}

/* Texts and lists of points are the script's and may be gone. */
static bool is_told(const tl_param *param)
{
    return param->type != TL_PARAM_STRING && param->type != TL_PARAM_POINTS;
}

/* Pushes the value; nil for a number that was left out. */
static void push_value(lua_State *L, const tl_param *param, const void *params)
{
    if (param->type == TL_PARAM_VEC3) {
        tl_lua_push_vec3(L, vector_of(param, params));
        return;
    }
    double number = number_of(param, params);
    if (param->type == TL_PARAM_INT)
        lua_pushinteger(L, (lua_Integer)number);
    else if (param->type == TL_PARAM_BOOL)
        lua_pushboolean(L, number != 0);
    else if (param->type == TL_PARAM_ENUM)
        lua_pushstring(L, param->choices[(int)number]);
    else if (isnan(number))
        lua_pushnil(L);
    else
        lua_pushnumber(L, number);
}

/* Six digits where they tell the number, else as many as it takes. */
static const char *number_text(double number, char text[32])
{
    tl_text_print(text, 32, "%.6g", number);
    if (tl_number_read(text, NULL) != number)
        tl_text_print(text, 32, "%.15g", number);
    return text;
}

/* "30 deg (default)" */
static void value_text(const tl_param *param, const void *params, char text[VALUE_TEXT])
{
    char value[120], digits[32];
    bool standard = !(param->flags & TL_PARAM_REQUIRED);
    double number = param->type == TL_PARAM_VEC3 ? 0 : number_of(param, params);
    if (param->type == TL_PARAM_VEC3) {
        tl_vec3 v = vector_of(param, params);
        char x[32], y[32], z[32];
        snprintf(value, sizeof value, "{%s, %s, %s}", number_text(v.x, x), number_text(v.y, y),
                 number_text(v.z, z));
        standard = standard && v.x == param->def[0] && v.y == param->def[1] && v.z == param->def[2];
    } else if (param->type == TL_PARAM_BOOL) {
        snprintf(value, sizeof value, "%s", number != 0 ? "true" : "false");
    } else if (param->type == TL_PARAM_ENUM) {
        snprintf(value, sizeof value, "%s", param->choices[(int)number]);
    } else if (isnan(number)) {
        snprintf(value, sizeof value, "not given");
    } else {
        snprintf(value, sizeof value, "%s", number_text(number, digits));
    }
    if (param->type != TL_PARAM_VEC3)
        standard = standard && !(param->flags & TL_PARAM_OPTIONAL) && number == param->def[0];
    bool unit = param->unit && param->unit[0] && !isnan(number);
    snprintf(text, VALUE_TEXT, "%s%s%s%s", value, unit ? " " : "", unit ? param->unit : "",
             standard ? " (default)" : "");
}

static void print_row(const char *name, const char *text)
{
    printf("%-*s%s\n", NAME_COLUMNS, name, text);
}

static void print_params(const tl_param *params, size_t count, const void *values)
{
    for (size_t i = 0; i < count; i++) {
        char name[80], text[VALUE_TEXT];
        if (!is_told(&params[i]))
            continue;
        snprintf(name, sizeof name, "  %s", params[i].name);
        value_text(&params[i], values, text);
        print_row(name, text);
    }
}

/* Pushes a table of the parameters of a plugin in use, by name. */
static void push_params(lua_State *L, const tl_plugin_setting *setting)
{
    lua_newtable(L);
    for (uint32_t i = 0; i < setting->kind->param_count; i++) {
        const tl_param *param = &setting->kind->params[i];
        if (!is_told(param))
            continue;
        push_value(L, param, setting->params);
        lua_setfield(L, -2, param->name);
    }
}

/* ---------------------------------------------------------------- parts ------------------ */

/* Settings of talus.model{...}, from its table of parameters. */
static void add_config(lua_State *L, tl_model *model, bool prints)
{
    tl_model_config config = tl_model_settings(model);
    size_t count;
    const tl_param *params = tl_function_params("model", &count, NULL);
    for (size_t i = 0; i < count; i++) {
        push_value(L, &params[i], &config);
        lua_setfield(L, -2, params[i].name);
        char text[VALUE_TEXT];
        value_text(&params[i], &config, text);
        if (prints)
            print_row(params[i].name, text);
    }
}

/* The name of a choice of a parameter of a kernel function. */
static const char *choice_name(const char *function, const char *name, int32_t choice)
{
    size_t count;
    const tl_param *params = tl_function_params(function, &count, NULL);
    for (size_t i = 0; i < count; i++)
        if (strcmp(params[i].name, name) == 0)
            return params[i].choices[choice];
    return "?";
}

static void add_timestep(lua_State *L, tl_model *model, bool prints)
{
    tl_timestep now = tl_model_timestep_now(model);
    const char *rule = choice_name("timestep", "rule", now.rule);
    double dt;
    bool known = tl_model_dt(model, &dt) == TL_OK;
    lua_createtable(L, 0, 5);
    set_text(L, "rule", rule);
    set_number(L, "fraction", now.fraction);
    if (!isnan(now.dt))
        set_number(L, "given", now.dt);
    if (known)
        set_number(L, "dt", dt);
    else
        set_text(L, "message", tl_model_error(model)->text);
    lua_setfield(L, -2, "timestep");
    if (!prints)
        return;
    char text[VALUE_TEXT];
    if (isnan(now.dt))
        tl_text_print(text, sizeof text, "rule %s, fraction %.10g of the critical step", rule,
                      now.fraction);
    else
        tl_text_print(text, sizeof text, "given, %.10g s", now.dt);
    print_row("timestep", text);
    if (known) {
        tl_text_print(text, sizeof text, "%.6g s", dt);
        print_row("  dt", text);
    } else {
        print_row("  dt", tl_model_error(model)->text);
    }
}

static void add_mass_scaling(lua_State *L, const tl_model *model, bool prints)
{
    const tl_mass_added scaling = tl_model_mass_added(model);
    bool partial = !isnan(scaling.dt);
    char text[VALUE_TEXT];
    lua_createtable(L, 0, 3);
    lua_pushboolean(L, scaling.on);
    lua_setfield(L, -2, "on");
    snprintf(text, sizeof text, "%s", scaling.on ? "of all bodies that can move" : "off");
    if (scaling.on && partial) {
        set_number(L, "dt", scaling.dt);
        set_number(L, "most", scaling.most);
        tl_text_print(text, sizeof text, "for dt = %.10g s, adding at most %.10g of the mass",
                      scaling.dt, scaling.most);
    }
    lua_setfield(L, -2, "mass_scaling");
    if (prints)
        print_row("mass_scaling", text);
}

static void add_damping(lua_State *L, const tl_model *model, bool prints)
{
    tl_plugin_setting damping = tl_model_damping_now(model);
    lua_createtable(L, 0, 2);
    if (damping.kind) {
        set_text(L, "name", damping.kind->name);
        push_params(L, &damping);
    } else {
        lua_newtable(L);
    }
    lua_setfield(L, -2, "parameters");
    lua_setfield(L, -2, "damping");
    if (!prints)
        return;
    print_row("damping", damping.kind ? damping.kind->name : "none (default)");
    if (damping.kind)
        print_params(damping.kind->params, damping.kind->param_count, damping.params);
}

static void print_law(const char *joint, const tl_plugin_setting *law)
{
    char name[100];
    snprintf(name, sizeof name, "joint %s", joint);
    print_row(name, law->kind->name);
    print_params(law->kind->params, law->kind->param_count, law->params);
}

/* The joint sets, each with the joint whose law it has. */
static void add_joints(lua_State *L, tl_model *model, bool prints)
{
    const char *joint, *ruled_by;
    lua_newtable(L);
    for (size_t i = 0; tl_model_joint_at(model, i, &joint, &ruled_by); i++) {
        set_text(L, joint, ruled_by ? ruled_by : "");
        char name[100], text[VALUE_TEXT];
        snprintf(name, sizeof name, "joint %s", joint);
        snprintf(text, sizeof text, "as joint %s", ruled_by);
        if (prints && (!ruled_by || strcmp(ruled_by, joint) != 0))
            print_row(name, ruled_by ? text : "no law");
    }
    lua_setfield(L, -2, "joints");
}

static void add_laws(lua_State *L, tl_model *model, bool prints)
{
    const char *joint;
    tl_plugin_setting law;
    lua_newtable(L);
    for (size_t i = 0; tl_model_law_at(model, i, &joint, &law); i++) {
        lua_createtable(L, 0, 2);
        set_text(L, "law", law.kind->name);
        push_params(L, &law);
        lua_setfield(L, -2, "parameters");
        lua_setfield(L, -2, joint);
        if (prints)
            print_law(joint, &law);
    }
    lua_setfield(L, -2, "laws");
    add_joints(L, model, prints);
    if (prints && !tl_model_law_at(model, 0, &joint, &law))
        print_row("joint *", "no law");
}

static void add_areas(lua_State *L, tl_model *model, bool prints)
{
    tl_contact_area rule;
    lua_newtable(L);
    for (size_t i = 0; tl_model_contact_area_at(model, i, &rule); i++) {
        bool absolute = !isnan(rule.absolute);
        char name[100], text[VALUE_TEXT];
        lua_createtable(L, 0, 2);
        set_number(L, absolute ? "absolute" : "fraction", absolute ? rule.absolute : rule.fraction);
        lua_setfield(L, -2, rule.joint ? rule.joint : "*");
        if (absolute)
            tl_text_print(text, sizeof text, "%.10g m2", rule.absolute);
        else if (rule.fraction > 0)
            tl_text_print(text, sizeof text, "%.10g of the smaller block's mean face area",
                          rule.fraction);
        else
            snprintf(text, sizeof text, "none%s", rule.joint ? "" : " (default)");
        snprintf(name, sizeof name, "  joint %s", rule.joint ? rule.joint : "");
        if (prints)
            print_row(rule.joint ? name : "contact_area", text);
    }
    lua_setfield(L, -2, "contact_area");
}

/* model:parameters() */
static int model_parameters(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "parameters");
    tl_lua_arity(L, 1, "parameters");
    bool prints = !tl_lua_options_of(L)->quiet;
    lua_createtable(L, 0, 12);
    add_config(L, model, prints);
    add_timestep(L, model, prints);
    add_mass_scaling(L, model, prints);
    add_damping(L, model, prints);
    add_laws(L, model, prints);
    add_areas(L, model, prints);
    fflush(stdout);
    return 1;
}

static const tl_lua_key parameters_fields[] = {
    {"gravity, seed", "", "and all others that talus.model{...} takes"},
    {"timestep", "",
     "rule and fraction; given: the step that was given, s, or nil; dt: the step the next cycle "
     "will use, s, or message: why it is not known"},
    {"mass_scaling", "", "on; dt and most, where they were given"},
    {"damping", "", "name, nil where none was chosen; parameters: a table of them by name"},
    {"laws", "",
     "by joint (\"*\", \"J1\", \"J1:3\"): law, its name; parameters: a table of them by name"},
    {"joints", "", "by joint set: the joint whose law it has, \"\" for none"},
    {"contact_area", "", "by joint, \"*\" for all others: fraction, or absolute, m2"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_lists_topics[] = {
    {.name = "joints",
     .usage = "list = model:joints()",
     .doc = "Lists the joint sets, in the order they were made.",
     .title = "Fields of each joint set",
     .verbs = joints_results,
     .of = TL_LUA_OF_MODEL,
     .call = model_joints},
    {.name = "laws",
     .usage = "list = model:laws()",
     .doc = "Lists the laws that were set by model:joint, with their parameters.",
     .title = "Fields of each law",
     .verbs = laws_results,
     .of = TL_LUA_OF_MODEL,
     .call = model_laws},
    {.name = "groups",
     .usage = "list = model:groups()",
     .doc = "Lists the groups that blocks have.",
     .title = "Fields of each group",
     .verbs = groups_results,
     .of = TL_LUA_OF_MODEL,
     .call = model_groups},
    {.name = "kinds",
     .usage = "list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or "
              " list = talus.screens()",
     .doc = "Lists the laws, dampings, generators or screens that are loaded.",
     .title = "Fields of each kind",
     .verbs = kinds_results},
    {.name = "parameters",
     .usage = "table = model:parameters()",
     .doc = "Tells all parameters the model has now, with defaults and units, as a table, and "
            "prints them (not with --quiet).",
     .title = "Fields of the table",
     .verbs = parameters_fields,
     .of = TL_LUA_OF_MODEL,
     .call = model_parameters},
    {.name = NULL},
};
