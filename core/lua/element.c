/* element.c - elements in Lua: model:element, model:elements, and what is asked of one. */
#include "lua/element.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- placing ---------------- */

static const tl_lua_key skipped[] = {{"group", NULL, NULL}, {NULL, NULL, NULL}};

/* The group that the table at `index` gives, or "". */
static const char *group_of(lua_State *L, int index)
{
    if (tl_lua_option(L, index, "group") == LUA_TNIL)
        return "";
    if (lua_type(L, -1) != LUA_TSTRING)
        tl_lua_fail(L, "element: group must be a name, not %s", tl_lua_describe(L, -1));
    return lua_tostring(L, -1);
}

/* Places what the table at `index` says, a list or one, as elements of one group. */
static tl_status place(lua_State *L, tl_model *model, const char *kind, tl_lua_selection *made)
{
    const size_t listed = lua_istable(L, 3) ? lua_rawlen(L, 3) : 0, count = listed ? listed : 1;
    const char *context = lua_pushfstring(L, "element '%s'", kind), *group = "";
    tl_args *args = lua_newuserdatauv(L, count * sizeof *args, 0);
    if (listed)
        tl_lua_check_list(L, 3, context, listed);
    luaL_checkstack(L, (int)(3 * count + 10), "too many elements in one list");
    for (size_t i = 0; i < count; i++) {
        int at = 3;
        if (listed) {
            if (lua_rawgeti(L, 3, (lua_Integer)i + 1) != LUA_TTABLE)
                tl_lua_fail(L, "%s: entry %d of the list must be a table of parameters, not %s", context, (int)i + 1,
                            tl_lua_describe(L, -1));
            at = lua_gettop(L);
        }
        const char *own = group_of(L, at);
        if (i > 0 && strcmp(own, group) != 0)
            tl_lua_fail(L,
                        "%s: entry %d of the list has group '%s', and the first one has '%s': give one group in a call",
                        context, (int)i + 1, own, group);
        group = i == 0 ? own : group;
        tl_lua_args(L, at, context, skipped, &args[i]);
    }
    tl_id *ids;
    const tl_status status = tl_model_element(model, kind, args, count, group, &ids, &made->count);
    made->names = ids;
    return status;
}

static int model_element(lua_State *L, tl_model *model)
{
    const char *kind = tl_lua_text(L, 2, "element", "the name of a kind");
    tl_lua_selection *made = tl_lua_selection_push(L, &tl_lua_element_kind, 1);
    const int top = lua_gettop(L);
    tl_lua_ok(L, model, place(L, model, kind, made));
    lua_settop(L, top);
    return 1;
}

tl_lua_selection *tl_lua_elements_make(lua_State *L, tl_model *model, const char *kind, const tl_args *args)
{
    tl_lua_selection *made = tl_lua_selection_push(L, &tl_lua_element_kind, TL_LUA_AT_MODEL);
    tl_id *ids = NULL;
    const tl_status status = tl_model_element(model, kind, args, 1, kind, &ids, &made->count);
    made->names = ids;
    tl_lua_ok(L, model, status);
    return made;
}

const double *tl_lua_ask_places(lua_State *L, int function, tl_vec3 *places, size_t first, size_t count,
                                const tl_lua_asked *asked)
{
    double *held = lua_newuserdatauv(L, (4 * count + 1) * sizeof *held, 0), *number = held + 3 * count;
    memcpy(held, places, 3 * count * sizeof *held);
    free(places);
    memset(number, 0, first * sizeof *number);
    for (size_t i = first; i < count; i++) {
        lua_pushvalue(L, function);
        for (int k = 0; k < 3; k++)
            lua_pushnumber(L, held[3 * i + (size_t)k]);
        if (tl_lua_call_reading(L, lua_touserdata(L, TL_LUA_AT_MODEL), 3, 1) != LUA_OK)
            lua_error(L);
        number[i] = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : NAN;
        const bool enough = asked->or_equal ? number[i] >= asked->least : number[i] > asked->least;
        if (!(enough && number[i] <= asked->most))
            tl_lua_fail_in(L, function, "%s: it gave %s", asked->must, tl_lua_describe(L, -1));
        lua_pop(L, 1);
    }
    return number;
}

/* ---------------------------------------------------------------- which ------------------ */

static const tl_param element_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_element_filter, kind, "", "elements of this kind", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, tl_element_filter, group, "", "elements of this group", .flags = TL_PARAM_OPTIONAL),
};

static const tl_lua_key element_keys[] = {
    {"block", "block or its id", "elements with a node on this block"},
    {"where", "function(element)", "elements for which the function answers true"},
    {NULL, NULL, NULL},
};

static const tl_lua_spec elements_spec = {"elements", element_params, TL_LUA_COUNT(element_params), element_keys};

static tl_id read_block(lua_State *L)
{
    if (tl_lua_option(L, 2, "block") == LUA_TNIL)
        return TL_NO_ID;
    const tl_lua_item *block = luaL_testudata(L, -1, TL_LUA_BLOCK);
    if (block && block->owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "elements: block belongs to another model");
    const lua_Integer id = block ? (lua_Integer)block->name.block : lua_isinteger(L, -1) ? lua_tointeger(L, -1) : 0;
    if (id < 1 || id > (lua_Integer)UINT32_MAX)
        tl_lua_fail(L, "elements: block must be a block or its id, a whole number from 1, not %s",
                    tl_lua_describe(L, -1));
    return (tl_id)id;
}

tl_lua_selection *tl_lua_elements_push(lua_State *L, tl_model *model, const tl_element_filter *filter)
{
    tl_lua_selection *found = tl_lua_selection_push(L, &tl_lua_element_kind, TL_LUA_AT_MODEL);
    tl_id *ids = NULL;
    const tl_status status = tl_elements_select(model, filter, &ids, &found->count);
    found->names = ids;
    tl_lua_ok(L, model, status);
    return found;
}

static int model_elements(lua_State *L, tl_model *model)
{
    tl_element_filter filter = {.size = sizeof filter};
    tl_lua_read(L, 2, &elements_spec, true, &filter);
    filter.block = read_block(L);
    const int where = tl_lua_read_where(L, &tl_lua_element_kind);
    tl_lua_elements_push(L, model, &filter);
    if (where)
        tl_lua_selection_filter(L, lua_gettop(L), where);
    return 1;
}

/* ---------------------------------------------------------------- one element ------------ */

static lua_Integer number(const tl_lua_name *name)
{
    return name->block;
}

static tl_status field(tl_model *model, const tl_lua_item *item, size_t index, tl_field_value *value)
{
    return tl_element_field(model, item->name.block, index, value);
}

static tl_status values(tl_model *model, const tl_lua_selection *of, const char *name, double *out, size_t *width)
{
    return tl_elements_values(model, of ? of->names : NULL, of ? of->count : 0, name, out, width);
}

/* Pushes a table of what is known of a node: place, force, states. */
static void push_node(lua_State *L, tl_model *model, tl_id element, const tl_kind *kind, size_t i)
{
    tl_element_node_info node;
    tl_lua_ok(L, model, tl_element_node_get(model, element, i, &node));
    lua_createtable(L, 0, 5 + (int)kind->state_count);
    tl_lua_set_vec3(L, "rest", node.rest);
    tl_lua_set_vec3(L, "position", node.position);
    tl_lua_set_vec3(L, "force", node.force);
    tl_lua_set_number(L, "weight", node.weight);
    if (node.block) {
        tl_lua_item_push_name(L, &tl_lua_block_kind, 3, &node.block);
        lua_setfield(L, -2, "block");
    }
    for (uint32_t k = 0; k < kind->state_count; k++) {
        double value;
        if (kind->states[k].kind == TL_STATE_WHOLE)
            continue;
        tl_lua_ok(L, model, tl_element_value(model, element, i, kind->states[k].name, &value));
        tl_lua_set_number(L, kind->states[k].name, value);
    }
}

/* A state of the whole, `nodes`, or `params`. */
static bool extra(lua_State *L, tl_model *model, const tl_lua_item *item, const char *name)
{
    tl_element_info info;
    double value;
    tl_lua_ok(L, model, tl_element_get(model, item->name.block, &info));
    if (strcmp(name, "nodes") == 0) {
        lua_createtable(L, (int)info.nodes, 0);
        for (size_t i = 0; i < info.nodes; i++) {
            push_node(L, model, item->name.block, info.kind, i);
            lua_rawseti(L, -2, (lua_Integer)i + 1);
        }
        return true;
    }
    if (strcmp(name, "params") == 0) {
        lua_createtable(L, 0, (int)info.kind->param_count);
        for (uint32_t k = 0; k < info.kind->param_count; k++) {
            const tl_param *param = &info.kind->params[k];
            if (param->type == TL_PARAM_STRING) /* NULL gives nil */
                lua_pushstring(L, *(char *const *)(const void *)((const char *)info.params + param->offset));
            else
                tl_lua_push_param(L, param, info.params);
            lua_setfield(L, -2, info.kind->params[k].name);
        }
        return true;
    }
    for (uint32_t k = 0; k < info.kind->state_count; k++)
        if (info.kind->states[k].kind == TL_STATE_WHOLE && strcmp(info.kind->states[k].name, name) == 0) {
            tl_lua_ok(L, model, tl_element_value(model, item->name.block, SIZE_MAX, name, &value));
            lua_pushnumber(L, value);
            return true;
        }
    return false;
}

static const tl_lua_key extra_keys[] = {
    {"nodes", "list of tables",
     "list of its nodes, each a table: rest, where it was when installed, position now, m; force on its block, N; "
     "weight, "
     "m or m2 that it stands for; block, nil on the ground; and the states of a node by their names"},
    {"params", "{NAME = value}", "its parameters, by their names"},
    {NULL, NULL, NULL},
};

static tl_status set(lua_State *L, const tl_lua_selection *of)
{
    tl_args args;
    if (!lua_istable(L, 2))
        tl_lua_fail(L, "set: give the parameters in a table, not %s", tl_lua_describe(L, 2));
    tl_lua_args(L, 2, "set", NULL, &args);
    return tl_elements_set(of->owner->model, of->names, of->count, &args);
}

static tl_status delete_them(lua_State *L, const tl_lua_selection *of)
{
    (void)L;
    return tl_elements_delete(of->owner->model, of->names, of->count);
}

static const tl_lua_verb verbs[] = {
    {.name = "set", .arguments = 1, .act = set, .done = "changed"},
    {.name = "delete", .act = delete_them, .done = "deleted"},
    {.name = NULL},
};

const tl_lua_kind tl_lua_element_kind = {
    .item = "element",
    .items = "elements",
    .item_type = TL_LUA_ELEMENT,
    .selection_type = TL_LUA_ELEMENTS,
    .name_size = sizeof(tl_id),
    .number = number,
    .bearer = "kind",
    .fields = tl_element_fields,
    .field = field,
    .values = values,
    .extra = extra,
    .extra_keys = extra_keys,
    .verbs = verbs,
};

/* ---------------------------------------------------------------- help ------------------- */

static const tl_lua_key methods[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of elements, the i-th one, all in order of id"},
    {"sel:sum(field), sel:max(field), sel:min(field)", "",
     "sum, largest and smallest value of a field of numbers, or of a state of whole elements"},
    {"sel:values(field)", "",
     "list of the field's values, in the order of the selection; likewise a state of whole elements, NaN where the "
     "element's kind has no such state"},
    {"sel:where(function(element) ... end)", "", "those for which the function answers true"},
    {"sel:set{...}", "", "changes parameters, but for those by which elements are placed; states stay"},
    {"sel:delete()", "", "takes them away; what they hold counts as work by hand"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_element_topics[] = {
    {.name = "element",
     .usage = "selection = model:element(\"KIND\", {...})  or  model:element(\"KIND\", {{...}, {...}})",
     .doc = "Puts elements on the blocks as they are now: one, or what a list of tables says, all or none. An element "
            "acts on points of blocks, its nodes: a spring, a bolt, water between walls. group = \"NAME\" names those "
            "of a call. Nodes follow their blocks when these are cut or joined.",
     .has_type = true,
     .type = TL_KIND_ELEMENT,
     .arguments = 2,
     .method = model_element},
    {.name = "elements",
     .usage = "selection = model:elements{...}",
     .doc = "Selects elements; all conditions must hold. Beside its fields an element has the states of its kind by "
            "their names, as element.axial; those of its nodes are in element.nodes.",
     .spec = &elements_spec,
     .kind = &tl_lua_element_kind,
     .title = "Methods of the selection",
     .verbs = methods,
     .arguments = 1,
     .method = model_elements},
    {.name = NULL},
};
