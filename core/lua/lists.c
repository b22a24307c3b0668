/* lists.c - what there is: model:joints(), laws(), solids(), groups(), parameters(). */
#include "lua/lists.h"

#include "lua/convert.h"
#include "lua/item.h"
#include "lua/joint.h"
#include "lua/living.h"
#include "lua/zones.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <talus/fields.h>
#include <talus/zones.h>

static const tl_lua_key joints_results[] = {
    {"name, planes", "", "of the joint set; number of its planes so far"},
    {"law", "", "name of the law of the set as a whole; nil while it has none"},
    {"scoped", "",
     "of the list itself: laws as of model:laws(), those that name groups or selections; nil without any"},
    {NULL, NULL, NULL},
};
static const tl_lua_key laws_results[] = {
    {"joint, law", "", "\"*\", \"J1\" or \"J1:3\", and the name of the law that was set for it"},
    {"between", "", "two groups or selections of blocks, of a law for contacts between both"},
    {"group", "", "name of the group, of a law for contacts with at least one block of it"},
    {"blocks", "", "the selection of blocks, of a law for contacts with at least one of them"},
    {"contacts", "", "the number of the pairs of blocks, of a law for contacts between these"},
    {"parameters", "", "{NAME = value}, as they are now; one that may be left out and was is nil"},
    {NULL, NULL, NULL},
};
static const tl_lua_key solids_results[] = {
    {"name, kind", "", "of the solid, and of the kind that it is of"},
    {"parameters", "", "{NAME = value}, as they are now; of a table its rows"},
    {"zones, volume", "", "number of its zones in visible blocks, and their volume, m3"},
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

/* ---------------------------------------------------------------- parameters in force -----
 *
 * model:parameters(): all parameters that a model has now, with those the script has left out. */

#define NAME_COLUMNS 20

/* Room for the text of a parameter's value. */
#define VALUE_TEXT 200

/* Reads the numbers of a value, three of a vector, else one; returns how many. */
static int numbers_of(const tl_param *param, const void *params, double number[3])
{
    const char *at = (const char *)params + param->offset;
    int64_t whole;
    int32_t choice;
    switch (param->type) {
    case TL_PARAM_VEC3: memcpy(number, at, 3 * sizeof *number); return 3;
    case TL_PARAM_REAL: memcpy(number, at, sizeof *number); return 1;
    case TL_PARAM_INT:
        memcpy(&whole, at, sizeof whole);
        number[0] = (double)whole;
        return 1;
    default:
        memcpy(&choice, at, sizeof choice);
        number[0] = choice;
        return 1;
    }
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
    char value[120], x[32], y[32], z[32];
    double number[3];
    int count = numbers_of(param, params, number);
    if (param->type == TL_PARAM_POINTS) {
        tl_points points;
        memcpy(&points, (const char *)params + param->offset, sizeof points);
        snprintf(text, VALUE_TEXT, points.count > 0 ? "%zu rows" : "not given", points.count);
        return;
    }
    bool standard = !(param->flags & (TL_PARAM_REQUIRED | TL_PARAM_OPTIONAL));
    for (int k = 0; k < count; k++)
        standard = standard && number[k] == param->def[k];
    if (isnan(number[0]))
        snprintf(value, sizeof value, "not given");
    else if (count == 3)
        snprintf(value, sizeof value, "{%s, %s, %s}", number_text(number[0], x), number_text(number[1], y),
                 number_text(number[2], z));
    else if (param->type == TL_PARAM_BOOL)
        snprintf(value, sizeof value, "%s", number[0] != 0 ? "true" : "false");
    else
        snprintf(value, sizeof value, "%s",
                 param->type == TL_PARAM_ENUM ? param->choices[(int)number[0]] : number_text(number[0], x));
    bool unit = param->unit && param->unit[0] && !isnan(number[0]);
    snprintf(text, VALUE_TEXT, "%s%s%s%s", value, unit ? " " : "", unit ? param->unit : "",
             standard ? " (default)" : "");
}

/* A line of the page, which is NULL when nothing is to be printed. */
static void print_row(FILE *page, const char *name, const char *text)
{
    if (page)
        fprintf(page, "%-*s%s\n", NAME_COLUMNS, name, text);
}

/* Puts parameters into the table at the top of the stack, by name, and prints them. */
static void add_params(lua_State *L, FILE *page, const char *indent, const tl_param *list, size_t count,
                       const void *params)
{
    for (size_t i = 0; i < count; i++) {
        char name[80], text[VALUE_TEXT];
        tl_lua_push_param(L, &list[i], params);
        lua_setfield(L, -2, list[i].name);
        snprintf(name, sizeof name, "%s%s", indent, list[i].name);
        value_text(&list[i], params, text);
        print_row(page, name, text);
    }
}

/* Sets `parameters` of the table at the top of the stack: those of a plugin in use; NULL: it has none. */
static void set_params(lua_State *L, FILE *page, const tl_kind *kind, const void *params)
{
    lua_newtable(L);
    if (kind)
        add_params(L, page, "  ", kind->params, kind->param_count, params);
    lua_setfield(L, -2, "parameters");
}

/* ---------------------------------------------------------------- of a model ------------- */

/* Pushes law `index` of the model, past the last one nothing. */
static bool push_law(lua_State *L, tl_model *model, size_t index)
{
    const char *joint;
    tl_plugin_setting law;
    if (!tl_model_law_at(model, index, &joint, &law))
        return false;
    lua_createtable(L, 0, 4);
    tl_lua_set_scope(L, model, index);
    tl_lua_set_text(L, "law", law.kind->name);
    set_params(L, NULL, law.kind, law.params);
    return true;
}

/* Sets `scoped` of the table at the top of the stack: the laws that name blocks. Without any it is not set. */
static void set_scoped(lua_State *L, tl_model *model)
{
    lua_Integer count = 0;
    lua_newtable(L);
    for (size_t i = 0; i < tl_law_count(model); i++)
        if (tl_law_names_blocks(model, i) && push_law(L, model, i))
            lua_rawseti(L, -2, ++count);
    if (count > 0)
        lua_setfield(L, -2, "scoped");
    else
        lua_pop(L, 1);
}

static int model_joints(lua_State *L, tl_model *model)
{
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
    set_scoped(L, model);
    return 1;
}

static int model_laws(lua_State *L, tl_model *model)
{
    lua_newtable(L);
    for (size_t i = 0; push_law(L, model, i); i++)
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    return 1;
}

/* The zones of a solid: how many, and their volume. */
static void set_zones_of(lua_State *L, tl_model *model, const char *solid)
{
    tl_zone_filter filter = tl_zone_filter_default();
    filter.solid = solid;
    tl_lua_selection *found = tl_lua_selection_push(L, &tl_lua_zone_kind, 1);
    tl_zone_name *names = NULL;
    size_t width;
    const tl_status status = tl_zones_select(model, &filter, &names, &found->count);
    found->names = names;
    tl_lua_ok(L, model, status);
    double *volume = lua_newuserdatauv(L, (found->count + 1) * sizeof *volume, 0), sum = 0;
    tl_lua_ok(L, model, tl_zones_values(model, names, found->count, "volume", volume, &width));
    for (size_t k = 0; k < found->count; k++)
        sum += volume[k];
    const size_t count = found->count;
    lua_pop(L, 2);
    tl_lua_set_count(L, "zones", count);
    tl_lua_set_number(L, "volume", sum);
}

static int model_solids(lua_State *L, tl_model *model)
{
    const size_t count = tl_solid_count(model);
    lua_createtable(L, (int)count, 0);
    for (size_t i = 0; i < count; i++) {
        const tl_solid_info solid = tl_solid_at(model, i);
        lua_createtable(L, 0, 5);
        tl_lua_set_text(L, "name", solid.name);
        tl_lua_set_text(L, "kind", solid.kind->name);
        set_params(L, NULL, solid.kind, solid.params);
        set_zones_of(L, model, solid.name);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

static int model_groups(lua_State *L, tl_model *model)
{
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

/* ---------------------------------------------------------------- parts ------------------ */

/* Settings of talus.model{...}, from its table of parameters. */
static void add_config(lua_State *L, tl_model *model, FILE *page)
{
    tl_model_config config = tl_model_settings(model);
    size_t count;
    const tl_param *params = tl_function_params("model", &count, NULL);
    add_params(L, page, "", params, count, &config);
}

static void add_timestep(lua_State *L, tl_model *model, FILE *page)
{
    tl_timestep now = tl_model_timestep_now(model);
    const char *rule = tl_lua_param_named("timestep", "rule")->choices[now.rule];
    double dt;
    bool known = tl_model_dt(model, &dt) == TL_OK;
    lua_createtable(L, 0, 5);
    tl_lua_set_text(L, "rule", rule);
    tl_lua_set_number(L, "fraction", now.fraction);
    if (!isnan(now.dt))
        tl_lua_set_number(L, "given", now.dt);
    if (known)
        tl_lua_set_number(L, "dt", dt);
    else
        tl_lua_set_text(L, "message", tl_model_error(model)->text);
    lua_setfield(L, -2, "timestep");
    char text[VALUE_TEXT];
    if (isnan(now.dt))
        tl_text_print(text, sizeof text, "rule %s, fraction %.10g of the critical step", rule, now.fraction);
    else
        tl_text_print(text, sizeof text, "given, %.10g s", now.dt);
    print_row(page, "timestep", text);
    if (known) {
        tl_text_print(text, sizeof text, "%.6g s", dt);
        print_row(page, "  dt", text);
    } else {
        print_row(page, "  dt", tl_model_error(model)->text);
    }
}

static void add_mass_scaling(lua_State *L, const tl_model *model, FILE *page)
{
    const tl_mass_added scaling = tl_model_mass_added(model);
    bool partial = !isnan(scaling.dt);
    char text[VALUE_TEXT];
    lua_createtable(L, 0, 3);
    lua_pushboolean(L, scaling.on);
    lua_setfield(L, -2, "on");
    snprintf(text, sizeof text, "%s", scaling.on ? "of all bodies that can move" : "off");
    if (scaling.on && partial) {
        tl_lua_set_number(L, "dt", scaling.dt);
        tl_lua_set_number(L, "most", scaling.most);
        tl_text_print(text, sizeof text, "for dt = %.10g s, adding at most %.10g of the mass", scaling.dt,
                      scaling.most);
    }
    lua_setfield(L, -2, "mass_scaling");
    print_row(page, "mass_scaling", text);
}

static void add_damping(lua_State *L, const tl_model *model, FILE *page)
{
    tl_plugin_setting damping = tl_model_damping_now(model);
    print_row(page, "damping", damping.kind ? damping.kind->name : "none (default)");
    lua_createtable(L, 0, 2);
    tl_lua_set_text(L, "name", damping.kind ? damping.kind->name : NULL);
    set_params(L, page, damping.kind, damping.params);
    lua_setfield(L, -2, "damping");
}

/* The joint sets, each with the joint whose law it has. */
static void add_joints(lua_State *L, tl_model *model, FILE *page)
{
    const char *joint, *ruled_by;
    lua_newtable(L);
    for (size_t i = 0; tl_model_joint_at(model, i, &joint, &ruled_by); i++) {
        tl_lua_set_text(L, joint, ruled_by ? ruled_by : "");
        char name[100], text[VALUE_TEXT];
        snprintf(name, sizeof name, "joint %s", joint);
        snprintf(text, sizeof text, "as joint %s", ruled_by);
        if ((!ruled_by || strcmp(ruled_by, joint) != 0))
            print_row(page, name, ruled_by ? text : "no law");
    }
    lua_setfield(L, -2, "joints");
}

static void print_joint(FILE *page, const char *joint, const char *text)
{
    char name[100];
    snprintf(name, sizeof name, "joint %s", joint);
    print_row(page, name, text);
}

static void add_laws(lua_State *L, tl_model *model, FILE *page)
{
    const char *joint;
    tl_plugin_setting law;
    lua_newtable(L);
    for (size_t i = 0; tl_model_law_at(model, i, &joint, &law); i++) {
        const bool named = tl_law_names_blocks(model, i);
        const char *key =
            named ? lua_pushfstring(L, "%s (law %I)", joint, (lua_Integer)i + 1) : lua_pushstring(L, joint);
        if (named)
            print_row(page, key, law.kind->name);
        else
            print_joint(page, joint, law.kind->name);
        lua_createtable(L, 0, 2);
        tl_lua_set_text(L, "law", law.kind->name);
        set_params(L, page, law.kind, law.params);
        lua_rawset(L, -3);
    }
    lua_setfield(L, -2, "laws");
    add_joints(L, model, page);
    if (!tl_model_law_at(model, 0, &joint, &law))
        print_row(page, "joint *", "no law");
}

static void add_areas(lua_State *L, tl_model *model, FILE *page)
{
    tl_contact_area rule;
    lua_newtable(L);
    for (size_t i = 0; tl_model_contact_area_at(model, i, &rule); i++) {
        bool absolute = !isnan(rule.absolute);
        char name[100], text[VALUE_TEXT];
        lua_createtable(L, 0, 2);
        tl_lua_set_number(L, absolute ? "absolute" : "fraction", absolute ? rule.absolute : rule.fraction);
        lua_setfield(L, -2, rule.joint ? rule.joint : "*");
        if (absolute)
            tl_text_print(text, sizeof text, "%.10g m2", rule.absolute);
        else if (rule.fraction > 0)
            tl_text_print(text, sizeof text, "%.10g of the smaller block's mean face area", rule.fraction);
        else
            snprintf(text, sizeof text, "none%s", rule.joint ? "" : " (default)");
        snprintf(name, sizeof name, "  joint %s", rule.joint ? rule.joint : "");
        print_row(page, rule.joint ? name : "contact_area", text);
    }
    lua_setfield(L, -2, "contact_area");
}

static void add_solids(lua_State *L, tl_model *model, FILE *page)
{
    lua_newtable(L);
    for (size_t i = 0; i < tl_solid_count(model); i++) {
        const tl_solid_info solid = tl_solid_at(model, i);
        char name[160];
        snprintf(name, sizeof name, "solid %s", solid.name);
        print_row(page, name, solid.kind->name);
        lua_createtable(L, 0, 2);
        tl_lua_set_text(L, "kind", solid.kind->name);
        set_params(L, page, solid.kind, solid.params);
        lua_setfield(L, -2, solid.name);
    }
    lua_setfield(L, -2, "solids");
}

/* model:parameters() */
static int model_parameters(lua_State *L, tl_model *model)
{
    FILE *page = tl_lua_options_of(L)->quiet ? NULL : stdout;
    lua_createtable(L, 0, 12);
    add_config(L, model, page);
    add_timestep(L, model, page);
    add_mass_scaling(L, model, page);
    add_damping(L, model, page);
    add_laws(L, model, page);
    add_areas(L, model, page);
    add_solids(L, model, page);
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
     "by joint (\"*\", \"J1\", \"J1:3\"), or \"contacts of group 'stone' (law 2)\": law, its name; "
     "parameters: a table of them by name"},
    {"joints", "", "by joint set: the joint whose law it has, \"\" for none"},
    {"contact_area", "", "by joint, \"*\" for all others: fraction, or absolute, m2"},
    {"solids", "", "by name: kind, its name; parameters: a table of them by name"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_lists_topics[] = {
    {.name = "joints",
     .usage = "list = model:joints()",
     .doc = "Lists the joint sets, in the order they were made.",
     .title = "Fields of each joint set",
     .verbs = joints_results,
     .method = model_joints},
    {.name = "laws",
     .usage = "list = model:laws()",
     .doc = "Lists the laws that were set by model:joint, with their parameters.",
     .title = "Fields of each law",
     .verbs = laws_results,
     .method = model_laws},
    {.name = "solids",
     .usage = "list = model:solids()",
     .doc = "Lists the solids that were named by model:solid, in their order. talus.solids() lists the kinds that are "
            "loaded.",
     .title = "Fields of each solid",
     .verbs = solids_results,
     .method = model_solids},
    {.name = "groups",
     .usage = "list = model:groups()",
     .doc = "Lists the groups that blocks have.",
     .title = "Fields of each group",
     .verbs = groups_results,
     .method = model_groups},
    {.name = "kinds",
     .usage = "list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or "
              " list = talus.screens()  or  list = talus.solids()  or  list = talus.elements()",
     .doc = "Lists the laws, dampings, generators, screens, solids or elements that are loaded.",
     .title = "Fields of each kind",
     .verbs = kinds_results},
    {.name = "parameters",
     .usage = "table = model:parameters()",
     .doc = "Tells all parameters the model has now, with defaults and units, as a table, and "
            "prints them (not with --quiet).",
     .title = "Fields of the table",
     .verbs = parameters_fields,
     .method = model_parameters},
    {.name = NULL},
};
