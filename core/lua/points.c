/* points.c - contact.points and contact.states: the points of a contact and the states of its law, as tables.
 *
 * They are copies of what is when they are asked for: points come and go with the polygon, so there is nothing that a
 * handle could stand for. Reading a name that is not there raises, as it does of a contact. */
#include "front.h"

#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

#define HOLDER_TYPE "talus.holder"

/* ---------------------------------------------------------------- tables of names -------- */

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
        lua_pushstring(L, what);
        lua_pushcclosure(L, record_index, 1);
        lua_setfield(L, -2, "__index");
        lua_pushcfunction(L, record_assign);
        lua_setfield(L, -2, "__newindex");
    }
    lua_setmetatable(L, -2);
}

/* ---------------------------------------------------------------- states of a contact ---- */

/* A list from malloc that is freed with the Lua object it belongs to. */
typedef struct holder {
    tl_law_state *list;
    size_t count;
} holder;

static int holder_collect(lua_State *L)
{
    holder *h = luaL_checkudata(L, 1, HOLDER_TYPE);
    free(h->list);
    h->list = NULL;
    return 0;
}

/* Pushes the list of the states of a contact's law. */
static const holder *push_states(lua_State *L, tl_model *model, tl_id contact)
{
    holder *h = lua_newuserdatauv(L, sizeof *h, 0);
    *h = (holder){0};
    if (luaL_newmetatable(L, HOLDER_TYPE)) {
        lua_pushcfunction(L, holder_collect);
        lua_setfield(L, -2, "__gc");
    }
    lua_setmetatable(L, -2);
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

void tl_lua_push_contact_states(lua_State *L, tl_model *model, tl_id contact)
{
    const holder *states = push_states(L, model, contact);
    lua_createtable(L, 0, (int)states->count);
    for (size_t i = 0; i < states->count; i++) {
        double value[3];
        size_t width;
        tl_lua_ok(L, model,
                  tl_contacts_values(model, &contact, 1, states->list[i].name, value, &width));
        push_value(L, value, width);
        lua_setfield(L, -2, states->list[i].name);
    }
    set_record(L, "talus.contact_states", "the law of this contact has no state");
}

/* ---------------------------------------------------------------- points ----------------- */

/* Sets one value in each of the `count` tables of the list at the top of the stack. */
static void set_value(lua_State *L, tl_model *model, tl_id contact, size_t count, const char *name,
                      double *values)
{
    size_t width;
    tl_lua_ok(L, model, tl_points_values(model, &contact, 1, name, values, &width));
    for (size_t k = 0; k < count; k++) {
        lua_rawgeti(L, -1, (lua_Integer)k + 1);
        if (strcmp(name, "state") == 0)
            lua_pushstring(L, tl_state_name((size_t)values[k]));
        else
            push_value(L, values + k * width, width);
        lua_setfield(L, -2, name);
        lua_pop(L, 1);
    }
}

void tl_lua_push_contact_points(lua_State *L, tl_model *model, tl_id contact)
{
    const holder *states = push_states(L, model, contact);
    size_t start[2], fields;
    const tl_field *field = tl_point_fields(&fields);
    tl_lua_ok(L, model, tl_points_start(model, &contact, 1, start));
    double *values = lua_newuserdatauv(L, 3 * (start[1] + 1) * sizeof *values, 0);
    lua_createtable(L, (int)start[1], 0);
    for (size_t k = 0; k < start[1]; k++) {
        lua_createtable(L, 0, (int)(fields + states->count));
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    for (size_t i = 0; i < fields; i++)
        set_value(L, model, contact, start[1], field[i].name, values);
    for (size_t i = 0; i < states->count; i++)
        set_value(L, model, contact, start[1], states->list[i].name, values);
    for (size_t k = 0; k < start[1]; k++) {
        lua_rawgeti(L, -1, (lua_Integer)k + 1);
        set_record(L, "talus.contact_point", "a contact point has no field");
        lua_pop(L, 1);
    }
}
