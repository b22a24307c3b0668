/* parameters.c - model:parameters(): all parameters that a model has now, with those the script has left out. */
#include "front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
int tl_lua_parameters(lua_State *L)
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

const tl_lua_key tl_lua_parameters_fields[] = {
    {"gravity, seed", "", "and all others that talus.model{...} takes"},
    {"timestep", "",
     "rule and fraction; given: the step that was given, s, or nil; dt: the step the next cycle "
     "will use, s, or message: "
     "why it is not known"},
    {"mass_scaling", "", "on; dt and most, where they were given"},
    {"damping", "", "name, nil where none was chosen; parameters: a table of them by name"},
    {"laws", "",
     "by joint (\"*\", \"J1\", \"J1:3\"): law, its name; parameters: a table of them by name"},
    {"joints", "", "by joint set: the joint whose law it has, \"\" for none"},
    {"contact_area", "", "by joint, \"*\" for all others: fraction, or absolute, m2"},
    {NULL, NULL, NULL},
};
