/* lists.c - what there is: model:joints(), model:laws(), model:groups(); talus.laws(), talus.dampings(), talus.generators(). */
#include "front.h"

#include <math.h>
#include <string.h>
#include <talus/fields.h>

const tl_lua_key tl_lua_joints_results[] = {
    {"name, planes", "", "of the joint set; number of its planes so far"},
    {"law", "", "name of the law of the set as a whole; nil while it has none"},
    {NULL, NULL, NULL},
};
const tl_lua_key tl_lua_laws_results[] = {
    {"joint, law", "", "\"*\", \"J1\" or \"J1:3\", and the name of the law that was set for it"},
    {"parameters", "", "{NAME = value}, as they are now; one that may be left out and was is nil"},
    {NULL, NULL, NULL},
};
const tl_lua_key tl_lua_groups_results[] = {
    {"name", "", "of the group"},
    {"blocks, volume", "", "number of its blocks, hidden ones, too, and their volume, m3"},
    {NULL, NULL, NULL},
};
const tl_lua_key tl_lua_kinds_results[] = {
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

int tl_lua_joints(lua_State *L)
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

int tl_lua_laws(lua_State *L)
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

int tl_lua_groups(lua_State *L)
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
