/* history_file.c - what histories have sampled: model:histories(), model:write_histories(path). */
#include "history.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- model:histories -------- */

static const char *const axes[] = {"x", "y", "z"};

/* Pushes the list of values of a history: of numbers, or of lists. */
static void push_values(lua_State *L, const tl_history *h)
{
    lua_createtable(L, (int)h->count, 0);
    for (size_t i = 0; i < h->count; i++) {
        if (h->list)
            tl_lua_push_numbers(L, h->values + i * h->width, h->width);
        else
            lua_pushnumber(L, h->values[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static void push_samples(lua_State *L, const tl_history *h)
{
    lua_createtable(L, 0, 6);
    lua_createtable(L, (int)h->count, 0);
    for (size_t i = 0; i < h->count; i++) {
        lua_pushinteger(L, (lua_Integer)h->cycles[i]);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "cycle");
    tl_lua_push_numbers(L, h->times, h->count);
    lua_setfield(L, -2, "time");
    push_values(L, h);
    lua_setfield(L, -2, "value");
    for (size_t k = 0; h->list && h->width == 3 && k < 3; k++) {
        lua_createtable(L, (int)h->count, 0);
        for (size_t i = 0; i < h->count; i++) {
            lua_pushnumber(L, h->values[3 * i + k]);
            lua_rawseti(L, -2, (lua_Integer)i + 1);
        }
        lua_setfield(L, -2, axes[k]);
    }
}

int tl_lua_histories(lua_State *L)
{
    const tl_model *model = tl_lua_model_of(L, "histories");
    tl_lua_arity(L, 1, "histories");
    const tl_history *h;
    lua_newtable(L);
    for (size_t i = 0; (h = tl_history_at(model, i)) != NULL; i++) {
        push_samples(L, h);
        lua_setfield(L, 2, h->name);
    }
    return 1;
}

const tl_lua_key tl_lua_histories_fields[] = {
    {"cycle", "", "list of the steps at which it was sampled"},
    {"time", "", "list of the times, s"},
    {"value", "", "list of the values, each a number or a list of numbers"},
    {"x, y, z", "", "lists of the components, where each value is a list of three"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- the file --------------- */

/* Numbers, nan and inf as programs read them. */
static void add_number(luaL_Buffer *b, double value)
{
    if (isnan(value))
        luaL_addstring(b, "nan");
    else
        tl_lua_add_number(b, value, DBL_DIG);
}

/* Names with a comma or a quotation mark are quoted. */
static void add_name(luaL_Buffer *b, const char *name, const char *component)
{
    bool quoted = strpbrk(name, ",\"") != NULL;
    luaL_addstring(b, quoted ? ",\"" : ",");
    for (const char *c = name; *c; c++) {
        if (*c == '"')
            luaL_addchar(b, '"');
        luaL_addchar(b, *c);
    }
    luaL_addstring(b, component);
    if (quoted)
        luaL_addchar(b, '"');
}

static void add_head(luaL_Buffer *b, const tl_history *h)
{
    char component[16] = "";
    for (size_t k = 0; k < h->width; k++) {
        if (h->list && h->width == 3)
            snprintf(component, sizeof component, ".%s", axes[k]);
        else if (h->list)
            snprintf(component, sizeof component, ".%d", (int)k + 1);
        add_name(b, h->name, component);
    }
}

/* One line: every history that has a sample of the lowest cycle that is left. false when none is left. */
static bool add_line(luaL_Buffer *b, const tl_history *const *all, size_t *at, size_t count)
{
    int64_t cycle = INT64_MAX;
    double time = 0;
    for (size_t i = 0; i < count; i++)
        if (at[i] < all[i]->count && all[i]->cycles[at[i]] < cycle) {
            cycle = all[i]->cycles[at[i]];
            time = all[i]->times[at[i]];
        }
    if (cycle == INT64_MAX)
        return false;
    char text[40];
    snprintf(text, sizeof text, "%lld,", (long long)cycle);
    luaL_addstring(b, text);
    add_number(b, time);
    for (size_t i = 0; i < count; i++) {
        bool here = at[i] < all[i]->count && all[i]->cycles[at[i]] == cycle;
        for (size_t k = 0; k < all[i]->width; k++) {
            luaL_addchar(b, ',');
            if (here)
                add_number(b, all[i]->values[at[i] * all[i]->width + k]);
        }
        at[i] += here;
    }
    luaL_addchar(b, '\n');
    return true;
}

int tl_lua_write_histories(lua_State *L)
{
    const tl_model *model = tl_lua_model_of(L, "write_histories");
    tl_lua_arity(L, 2, "write_histories");
    const char *path = tl_lua_text(L, 2, "write_histories", "the file's name");
    lua_settop(L, 2);
    size_t count = 0;
    while (tl_history_at(model, count))
        count++;
    if (count == 0)
        return tl_lua_fail(
            L, "write_histories: the model has no history; make one with model:history{...}");
    const tl_history **all = lua_newuserdatauv(L, count * sizeof *all, 0);
    size_t *at = lua_newuserdatauv(L, count * sizeof *at, 0);
    luaL_Buffer b;
    luaL_buffinit(L, &b);
    luaL_addstring(&b, "cycle,time");
    for (size_t i = 0; i < count; i++) {
        all[i] = tl_history_at(model, i);
        at[i] = 0;
        add_head(&b, all[i]);
    }
    luaL_addchar(&b, '\n');
    while (add_line(&b, all, at, count)) {
    }
    luaL_pushresult(&b);
    size_t length;
    const char *text = lua_tolstring(L, -1, &length);
    tl_error error;
    if (tl_write_file(path, text, length, &error) != TL_OK)
        return tl_lua_fail(L, "write_histories: %s", error.text);
    return 0;
}
