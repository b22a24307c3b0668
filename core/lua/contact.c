/* contact.c - selections of contacts and what a contact has beyond the kernel's fields. */
#include "lua/contact.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elements.h>
#include <talus/fields.h>

/* ---------------------------------------------------------------- points and states -------
 *
 * contact.points and contact.states: the points of a contact and the states of its law, as tables.
 *
 * They are copies of what is when they are asked for. Points come and go with the polygon, so no handle could stand
 * for one. Reading a name that is not there raises, as it does of a contact. */

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* A name that the table at index 1 does not have. Upvalue 1 is how the sentence begins. */
static int record_index(lua_State *L)
{
    const char *what = lua_tostring(L, lua_upvalueindex(1));
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "%s %s", what, tl_lua_describe(L, 2));
    tl_lua_names names = {0};
    for (lua_pushnil(L); lua_next(L, 1); lua_pop(L, 1))
        if (lua_type(L, -2) == LUA_TSTRING)
            tl_lua_names_add(&names, lua_tostring(L, -2));
    qsort(names.at, names.count, sizeof names.at[0], compare_names);
    if (names.count == 0)
        return tl_lua_fail(L, "%s '%s': it has none", what, lua_tostring(L, 2));
    return tl_lua_unknown(L, what, lua_tostring(L, 2), &names);
}

static int record_assign(lua_State *L)
{
    return tl_lua_fail(L, "the values of a contact can only be read");
}

/* Gives the table at the top of the stack the metatable `type`, whose sentences begin with `what`. */
static void set_record(lua_State *L, const char *type, const char *what)
{
    if (luaL_newmetatable(L, type)) {
        const luaL_Reg meta[] = {{"__index", record_index}, {"__newindex", record_assign}, {NULL, NULL}};
        lua_pushstring(L, what);
        luaL_setfuncs(L, meta, 1);
    }
    lua_setmetatable(L, -2);
}

/* ---------------------------------------------------------------- states of a contact ---- */

/* A list from malloc that is freed with the Lua object it belongs to. */
typedef struct holder {
    tl_law_state *list;
    size_t count;
} holder;

static int free_states(lua_State *L)
{
    free(((holder *)lua_touserdata(L, 1))->list);
    return 0;
}

/* Pushes the list of the states of a contact's law. */
static const holder *push_states(lua_State *L, tl_model *model, const tl_contact_name *contact)
{
    holder *h = tl_lua_hold(L, sizeof *h, "talus.holder", free_states);
    tl_lua_ok(L, model, tl_states_list(model, contact, &h->list, &h->count));
    return h;
}

/* Pushes a number, or a vector as a list. */
static void push_value(lua_State *L, const double *value, size_t width)
{
    if (width == 1)
        lua_pushnumber(L, value[0]);
    else
        tl_lua_push_numbers(L, value, width);
}

static void push_contact_states(lua_State *L, tl_model *model, const tl_contact_name *contact)
{
    const holder *states = push_states(L, model, contact);
    lua_createtable(L, 0, (int)states->count);
    for (size_t i = 0; i < states->count; i++) {
        double value[3];
        size_t width;
        tl_lua_ok(L, model, tl_contacts_values(model, contact, 1, states->list[i].name, value, &width));
        push_value(L, value, width);
        lua_setfield(L, -2, states->list[i].name);
    }
    set_record(L, "talus.contact_states", "the law of this contact has no state");
}

/* ---------------------------------------------------------------- points ----------------- */

/* Sets one value in each of the `count` tables of the list at the top of the stack. */
static void set_value(lua_State *L, tl_model *model, const tl_contact_name *contact, size_t count, const char *name,
                      double *values)
{
    size_t width;
    tl_lua_ok(L, model, tl_points_values(model, contact, 1, name, values, &width));
    for (size_t k = 0; k < count; k++) {
        lua_rawgeti(L, -1, (lua_Integer)k + 1);
        lua_pushstring(L, name);
        if (strcmp(name, "state") == 0)
            lua_pushstring(L, tl_state_name((size_t)values[k]));
        else
            push_value(L, values + k * width, width);
        lua_rawset(L, -3);
        lua_pop(L, 1);
    }
}

/* Push the points of a contact, a list of tables, and the states of its law, a table. */
static void push_contact_points(lua_State *L, tl_model *model, const tl_contact_name *contact)
{
    const holder *states = push_states(L, model, contact);
    size_t start[2], fields;
    const tl_field *field = tl_point_fields(&fields);
    tl_lua_ok(L, model, tl_points_start(model, contact, 1, start));
    double *values = lua_newuserdatauv(L, 3 * (start[1] + 1) * sizeof *values, 0);
    lua_createtable(L, (int)start[1], 0);
    for (size_t k = 0; k < start[1]; k++) {
        lua_createtable(L, 0, (int)(fields + states->count));
        set_record(L, "talus.contact_point", "a contact point has no field");
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    for (size_t i = 0; i < fields; i++)
        set_value(L, model, contact, start[1], field[i].name, values);
    for (size_t i = 0; i < states->count; i++)
        set_value(L, model, contact, start[1], states->list[i].name, values);
}

/* ---------------------------------------------------------------- contacts ---------------- */

static const tl_param contact_params[] = {
    TL_PARAM(TL_PARAM_STRING, tl_contact_filter, joint, "", "contacts on this joint or plane",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_lua_key contact_keys[] = {
    {"between", "{selection, selection}",
     "contacts of a block of the first with one of the second; a single block serves too"},
    {"where", "function(contact)", "contacts for which the function answers true"},
    {NULL, NULL, NULL},
};

static const tl_lua_spec contacts_spec = {"contacts", contact_params, TL_LUA_COUNT(contact_params), contact_keys};

/* The ids meant by the selection of blocks or the block at the top of the stack. */
static const tl_id *read_side(lua_State *L, const tl_lua_model *owner, int side, size_t *count)
{
    const tl_lua_selection *blocks = luaL_testudata(L, -1, TL_LUA_BLOCKS);
    const tl_lua_item *block = luaL_testudata(L, -1, TL_LUA_BLOCK);
    if (!blocks && !block)
        tl_lua_fail(L, "contacts, between: item %d must be a selection of blocks or a block, not %s", side,
                    tl_lua_describe(L, -1));
    if ((blocks ? blocks->owner : block->owner) != owner)
        tl_lua_fail(L, "contacts, between: item %d belongs to another model", side);
    /* An empty selection has no list, but NULL would mean "any block". */
    static const tl_id none = TL_NO_ID;
    *count = blocks ? blocks->count : 1;
    if (*count == 0)
        return &none;
    return blocks ? blocks->names : &block->name.block;
}

static void read_between(lua_State *L, tl_contact_filter *filter)
{
    if (tl_lua_option(L, 2, "between") == LUA_TNIL)
        return;
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) != 2)
        tl_lua_fail(L, "contacts: between must be a list of two selections of blocks, not %s",
                    lua_istable(L, -1) ? lua_pushfstring(L, "a list of %I", (lua_Integer)lua_rawlen(L, -1))
                                       : tl_lua_describe(L, -1));
    const tl_lua_model *owner = lua_touserdata(L, 1);
    int pair = lua_gettop(L);
    tl_lua_check_list(L, pair, "contacts, between: the list of two selections", 2);
    lua_rawgeti(L, pair, 1);
    filter->between_a = read_side(L, owner, 1, &filter->count_a);
    lua_rawgeti(L, pair, 2);
    filter->between_b = read_side(L, owner, 2, &filter->count_b);
}

void tl_lua_contacts_select(lua_State *L, tl_model *model, const tl_contact_filter *filter, tl_lua_selection *found)
{
    tl_contact_name *names = NULL;
    const tl_status status = tl_contacts_select(model, filter, &names, &found->count);
    found->names = names;
    tl_lua_ok(L, model, status);
}

static int model_contacts(lua_State *L, tl_model *model)
{
    tl_contact_filter filter = tl_contact_filter_default();
    tl_lua_read(L, 2, &contacts_spec, false, &filter);
    read_between(L, &filter);
    int where = tl_lua_read_where(L, &tl_lua_contact_kind);
    tl_lua_selection *found = tl_lua_selection_push(L, &tl_lua_contact_kind, 1);
    tl_lua_contacts_select(L, model, &filter, found);
    if (where)
        tl_lua_selection_filter(L, lua_gettop(L), where);
    return 1;
}

static tl_status contact_field(tl_model *model, const tl_lua_item *item, size_t index, tl_field_value *value)
{
    return tl_contact_field(model, item->name.contact, index, value);
}

/* ---------------------------------------------------------------- water ------------------ */

/* Whether a name is that of a state of wet joints that contacts tell, too. */
static bool is_of_water(const char *name)
{
    return strcmp(name, "pressure") == 0 || strcmp(name, "aperture") == 0 || strcmp(name, "flow") == 0;
}

/* NaN where a contact has no wet joint, or a dry one. */
static tl_status water_values(tl_model *model, const tl_contact_name *contacts, size_t count, const char *name,
                              double *out)
{
    return tl_contacts_element_values(model, contacts, count, name, "dry", out);
}

static tl_status contact_values(tl_model *model, const tl_lua_selection *of, const char *name, double *out,
                                size_t *width)
{
    if (is_of_water(name)) {
        *width = 1;
        return out ? water_values(model, of->names, of->count, name, out) : TL_OK;
    }
    return tl_contacts_values(model, of ? of->names : NULL, of ? of->count : 0, name, out, width);
}

/* `id`, exact; `blocks`: the pair of blocks, as blocks and not as numbers; `points` and `states`; what wet joints
 * tell. */
static bool contact_extra(lua_State *L, tl_model *model, const tl_lua_item *item, const char *name)
{
    const tl_contact_name contact = item->name.contact;
    if (strcmp(name, "points") == 0) {
        push_contact_points(L, model, &contact);
        return true;
    }
    if (strcmp(name, "states") == 0) {
        push_contact_states(L, model, &contact);
        return true;
    }
    if (is_of_water(name)) {
        double value;
        tl_lua_ok(L, model, water_values(model, &contact, 1, name, &value));
        if (isnan(value))
            lua_pushnil(L);
        else
            lua_pushnumber(L, value);
        return true;
    }
    const bool blocks = strcmp(name, "blocks") == 0;
    if (!blocks && strcmp(name, "id") != 0)
        return false;
    size_t index;
    tl_field_value value;
    tl_lua_field_named(&tl_lua_contact_kind, name, &index);
    tl_lua_ok(L, model, tl_contact_field(model, contact, index, &value));
    if (!blocks) {
        lua_pushinteger(L, item->kind->number(&item->name));
        return true;
    }
    lua_createtable(L, 2, 0);
    tl_lua_item_push_name(L, &tl_lua_block_kind, 3, &contact.a);
    lua_rawseti(L, -2, 1);
    tl_lua_item_push_name(L, &tl_lua_block_kind, 3, &contact.b);
    lua_rawseti(L, -2, 2);
    return true;
}

static const tl_lua_key contact_extra_keys[] = {
    {"points", "list of {position =, area =, normal_force =, ...}",
     "its points as they are now, each a table of the fields of a contact point and of the states of the law by name. "
     "The forces of the points add up to those of the contact; edges, vertices and tilted faces have one point"},
    {"states", "{NAME = value}",
     "the states of its law: the mean of the points, weighted by their areas; the sum of a state "
     "that goes with the area"},
    {"pressure", "number", "Pa, mean pressure of the water between its faces; nil, and NaN in lists, where it is dry"},
    {"aperture", "number", "m, hydraulic aperture of the joint between its faces; nil without water that flows there"},
    {"flow", "number", "m3/s, through the joint between its faces; likewise"},
    {NULL, NULL, NULL},
};
static const tl_lua_verb contact_verbs[] = {{.name = NULL}};

static lua_Integer contact_number(const tl_lua_name *name)
{
    return tl_contact_number(name->contact);
}

const tl_lua_kind tl_lua_contact_kind = {
    .item = "contact",
    .items = "contacts",
    .item_type = TL_LUA_CONTACT,
    .selection_type = TL_LUA_CONTACTS,
    .name_size = sizeof(tl_contact_name),
    .number = contact_number,
    .bearer = "law",
    .fields = tl_contact_fields,
    .field = contact_field,
    .values = contact_values,
    .extra = contact_extra,
    .extra_keys = contact_extra_keys,
    .verbs = contact_verbs,
};

static const tl_lua_key contact_methods[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of contacts, the i-th one, all in the order of their blocks"},
    {"sel:sum(field)", "", "sum of a field of numbers, or of a state of a law by its name; of a vector a vector"},
    {"sel:max(field), sel:min(field)", "",
     "largest and smallest value of a field of numbers, or of a state, where the law has it"},
    {"sel:values(field)", "",
     "list of the field's values, in the order of the selection; likewise a state of a law, by its name, NaN where the "
     "contact's law has no such state. With \"flat\" after it vectors are not lists of their own"},
    {"sel:where(function(contact) ... end)", "", "those for which the function answers true"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_contact_topics[] = {
    {.name = "contacts",
     .usage = "selection = model:contacts{...}",
     .doc = "Selects contacts; all conditions must hold.",
     .spec = &contacts_spec,
     .kind = &tl_lua_contact_kind,
     .title = "Methods of the selection",
     .verbs = contact_methods,
     .arguments = 1,
     .method = model_contacts},
    {.name = NULL},
};
