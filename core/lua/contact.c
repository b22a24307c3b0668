/* contact.c - selections of contacts and what a contact has beyond the kernel's fields. */
#include "front.h"

#include <string.h>
#include <talus/fields.h>

typedef struct contact_args {
    const char *joint;
} contact_args;

static const tl_param contact_params[] = {
    TL_PARAM(TL_PARAM_STRING, contact_args, joint, "", "contacts on this joint or plane",
             .flags = TL_PARAM_OPTIONAL),
};

static const tl_lua_key contact_keys[] = {
    {"between", "{selection, selection}",
     "contacts of a block of the first with one of the second; a single block serves too"},
    {"where", "function(contact)", "contacts for which the function answers true"},
    {NULL, NULL, NULL},
};

const tl_lua_spec tl_lua_contacts_spec = {
    "contacts", contact_params, sizeof contact_params / sizeof contact_params[0], contact_keys};

/* The ids meant by the selection of blocks or the block at the top of the stack. */
static const tl_id *read_side(lua_State *L, const tl_lua_model *owner, int side, size_t *count)
{
    const tl_lua_selection *blocks = luaL_testudata(L, -1, TL_LUA_BLOCKS);
    const tl_lua_item *block = luaL_testudata(L, -1, TL_LUA_BLOCK);
    if (!blocks && !block)
        tl_lua_fail(L,
                    "contacts, between: item %d must be a selection of blocks or a block, not %s",
                    side, tl_lua_describe(L, -1));
    if ((blocks ? blocks->owner : block->owner) != owner)
        tl_lua_fail(L, "contacts, between: item %d belongs to another model", side);
    /* An empty selection has no list, but NULL would mean "any block". */
    static const tl_id none = TL_NO_ID;
    *count = blocks ? blocks->count : 1;
    if (*count == 0)
        return &none;
    return blocks ? blocks->ids : &block->id;
}

static void read_between(lua_State *L, tl_contact_filter *filter)
{
    if (lua_getfield(L, 2, "between") == LUA_TNIL)
        return;
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) != 2)
        tl_lua_fail(L, "contacts: between must be a list of two selections of blocks, not %s",
                    lua_istable(L, -1)
                        ? lua_pushfstring(L, "a list of %I", (lua_Integer)lua_rawlen(L, -1))
                        : tl_lua_describe(L, -1));
    const tl_lua_model *owner = lua_touserdata(L, 1);
    int pair = lua_gettop(L);
    lua_rawgeti(L, pair, 1);
    filter->between_a = read_side(L, owner, 1, &filter->count_a);
    lua_rawgeti(L, pair, 2);
    filter->between_b = read_side(L, owner, 2, &filter->count_b);
}

int tl_lua_contacts(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "contacts");
    tl_lua_arity(L, 2, "contacts");
    lua_settop(L, 2);
    luaL_checkstack(L, 32, "too many values");
    contact_args args;
    tl_lua_read(L, 2, &tl_lua_contacts_spec, false, &args);
    tl_contact_filter filter = tl_contact_filter_default();
    filter.joint = args.joint;
    int where = 0;
    if (lua_istable(L, 2)) {
        read_between(L, &filter);
        if (lua_getfield(L, 2, "where") != LUA_TNIL)
            where = lua_gettop(L);
    }
    if (where && lua_type(L, where) != LUA_TFUNCTION)
        return tl_lua_fail(L, "contacts: where must be a function(contact), not %s",
                           tl_lua_describe(L, where));
    tl_lua_selection *found = tl_lua_selection_push(L, &tl_lua_contact_kind, 1);
    tl_lua_ok(L, model, tl_contacts_select(model, &filter, &found->ids, &found->count));
    if (where)
        tl_lua_selection_filter(L, lua_gettop(L), where);
    return 1;
}

/* `blocks`: the pair of blocks, as blocks and not as numbers; `points` and `states`. */
static bool contact_extra(lua_State *L, tl_model *model, tl_id id, const char *name)
{
    if (strcmp(name, "points") == 0) {
        tl_lua_push_contact_points(L, model, id);
        return true;
    }
    if (strcmp(name, "states") == 0) {
        tl_lua_push_contact_states(L, model, id);
        return true;
    }
    if (strcmp(name, "blocks") != 0)
        return false;
    size_t count;
    const tl_field *fields = tl_contact_fields(&count);
    for (size_t i = 0; i < count; i++) {
        if (strcmp(fields[i].name, name) != 0)
            continue;
        tl_field_value value;
        tl_lua_ok(L, model, tl_contact_field(model, id, i, &value));
        lua_createtable(L, 2, 0);
        for (int side = 0; side < 2; side++) {
            tl_lua_item_push(L, TL_LUA_BLOCK, 3, (tl_id)value.number[side]);
            lua_rawseti(L, -2, side + 1);
        }
        return true;
    }
    return false;
}

static const tl_lua_key contact_extra_keys[] = {
    {"points", "list of {position =, area =, normal_force =, ...}",
     "its points as they are now, each a table of the fields of a contact point and of the states "
     "of the law by name. The forces of the points add up to those of the contact; edges, vertices "
     "and tilted faces have one point"},
    {"states", "{NAME = value}",
     "the states of its law: the mean of the points, weighted by their areas; the sum of a state "
     "that goes with the area"},
    {NULL, NULL, NULL},
};
static const luaL_Reg contact_verbs[] = {{NULL, NULL}};

const tl_lua_kind tl_lua_contact_kind = {
    .item = "contact",
    .items = "contacts",
    .item_type = TL_LUA_CONTACT,
    .selection_type = TL_LUA_CONTACTS,
    .fields = tl_contact_fields,
    .field = tl_contact_field,
    .values = tl_contacts_values,
    .extra = contact_extra,
    .extra_keys = contact_extra_keys,
    .verbs = contact_verbs,
};
