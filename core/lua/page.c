/* page.c - files of a model for those who look at it: pages for a browser, VTK files, sections, and the blocks. */
#include "lua/page.h"

#include "lua/block.h"
#include "lua/contact.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/interrupt.h"
#include "lua/item.h"
#include "lua/living.h"
#include "lua/quality.h"
#include "lua/zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/zones.h>

static const tl_lua_key page_keys[] = {
    TL_LUA_PAGE_KEYS,
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- extra fields ------------
 *
 * Numbers that a script adds to the blocks, contacts or zones of a file or page: fields by name, numbers by ids, and
 * functions.
 *
 *     block_fields = {"kinetic_energy", safety = map.factor, above = function(block) return block.centroid[3] end}
 *
 * All are found before anything is written, in an order that does not depend on the table's: those of the list first,
 * then the others by their names. While a function runs the model may only be read. */

static const tl_lua_key field_keys[] = {
    TL_LUA_FIELD_KEYS,
    {"zone_fields", "{\"FIELD\", NAME = \"FIELD\" or function(zone)}",
     "numbers of each zone, likewise: fields of zones, states of their solids, functions"},
    {NULL, NULL, NULL},
};

/* Longest name of a field. */
#define LONGEST 63

/* What is asked for, while it is read. */
typedef struct request {
    const char *key, *context;
    const tl_lua_kind *kind;
    const tl_lua_selection *items; /* all of them */
    tl_extra_field *fields;
    size_t count;
    int given, anchor; /* stack indices: of the table, of what keeps texts and values */
} request;

/* Letters, digits and underscores, beginning with a letter: names of arrays in files. */
static bool is_name(const char *name)
{
    size_t length = strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_");
    return length > 0 && length <= LONGEST && name[length] == '\0' && !strchr("0123456789_", name[0]);
}

static int compare(const void *a, const void *b)
{
    return strcmp(((const tl_extra_field *)a)->name, ((const tl_extra_field *)b)->name);
}

/* The name at the top of the stack, which it pops and keeps; it is not one of those before. */
static void take_name(lua_State *L, request *r)
{
    const char *name = lua_tostring(L, -1);
    if (lua_rawlen(L, -1) != strlen(name) || !is_name(name))
        tl_lua_fail(L,
                    "%s: %s: '%s' is no name for a field: it may have up to %d letters, digits and "
                    "underscores, and begins with a letter",
                    r->context, r->key, name, LONGEST);
    for (size_t i = 0; i < r->count; i++)
        if (strcmp(r->fields[i].name, name) == 0)
            tl_lua_fail(L, "%s: %s: '%s' is there twice", r->context, r->key, name);
    r->fields[r->count++] = (tl_extra_field){.name = name};
    lua_rawseti(L, r->anchor, (lua_Integer)r->count);
}

/* Reads the names: of the list, then the others in their order. */
static void take_names(lua_State *L, request *r)
{
    lua_Integer listed = (lua_Integer)lua_rawlen(L, r->given);
    for (lua_Integer i = 1; i <= listed; i++) {
        if (lua_rawgeti(L, r->given, i) != LUA_TSTRING)
            tl_lua_fail(L, "%s: %s: item %d must be the name of a field, not %s", r->context, r->key, (int)i,
                        tl_lua_describe(L, -1));
        take_name(L, r);
    }
    for (lua_pushnil(L); lua_next(L, r->given); lua_pop(L, 1)) {
        if (lua_isinteger(L, -2) && lua_tointeger(L, -2) >= 1 && lua_tointeger(L, -2) <= listed)
            continue;
        if (lua_type(L, -2) != LUA_TSTRING)
            tl_lua_fail(L, "%s: %s: a field is named by a text, not by %s", r->context, r->key, tl_lua_describe(L, -2));
        lua_pushvalue(L, -2);
        take_name(L, r);
    }
    qsort(r->fields + listed, r->count - (size_t)listed, sizeof *r->fields, compare);
}

/* ---------------------------------------------------------------- values ----------------- */

/* The values of the field of the model that has the name `source`. */
static void ask_field(lua_State *L, const request *r, tl_extra_field *field, const char *source, double *values)
{
    tl_model *model = tl_lua_living(L, r->items->owner);
    size_t width;
    tl_lua_ok(L, model, r->kind->values(model, NULL, source, NULL, &width));
    if (width != 1)
        tl_lua_fail(L, "%s: %s: the field '%s' of a %s has %d numbers; give a function(%s) that returns one",
                    r->context, r->key, source, r->kind->item, (int)width, r->kind->item);
    tl_lua_ok(L, model, r->kind->values(model, r->items, source, values, &width));
    size_t index;
    const tl_field *known = tl_lua_field_named(r->kind, source, &index);
    field->unit = known ? known->unit : "";
}

/* Places on the stack of `ask`. */
enum { AT_FUNCTION = 1, AT_REQUEST, AT_FIELD, AT_OWNER, AT_ITEM };

/* Runs protected: calls the function for every item. */
static int ask(lua_State *L)
{
    const request *r = lua_touserdata(L, AT_REQUEST);
    tl_extra_field *field = lua_touserdata(L, AT_FIELD);
    double *values = (double *)(uintptr_t)field->values;
    for (size_t i = 0; i < r->items->count; i++) {
        const tl_lua_item item = tl_lua_item_push(L, AT_OWNER, r->items, i);
        lua_pushvalue(L, AT_FUNCTION);
        lua_pushvalue(L, AT_ITEM);
        lua_call(L, 1, 1);
        if (lua_type(L, -1) != LUA_TNUMBER && !lua_isnil(L, -1))
            return luaL_error(L, "it must give a number or nil, not %s for %s %I", tl_lua_describe(L, -1),
                              r->kind->item, r->kind->number(&item.name));
        values[i] = lua_isnil(L, -1) ? NAN : lua_tonumber(L, -1);
        lua_settop(L, AT_OWNER);
    }
    return 0;
}

/* The values that the function at the top of the stack gives, which it pops. */
static void ask_function(lua_State *L, request *r, tl_extra_field *field)
{
    lua_pushcfunction(L, ask);
    lua_insert(L, -2);
    lua_pushlightuserdata(L, r);
    lua_pushlightuserdata(L, field);
    lua_pushvalue(L, 1);
    if (tl_lua_call_reading(L, r->items->owner, 4, 0) != LUA_OK)
        tl_lua_fail(L, "%s: %s: '%s': %s", r->context, r->key, field->name, luaL_tolstring(L, -1, NULL));
}

/* The length of the vector {x, y, z} at the top of the stack; NaN: there is none. */
static double length_at(lua_State *L)
{
    double sum = 0;
    for (lua_Integer i = 1; i <= 3; i++) {
        lua_rawgeti(L, -1, i);
        sum += lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) * lua_tonumber(L, -1) : (double)NAN;
        lua_pop(L, 1);
    }
    return sqrt(sum);
}

/* The values that the table at the top of the stack has under the numbers of the items: of vectors their lengths. It
 * pops the table. */
static void look_up(lua_State *L, const request *r, tl_extra_field *field, double *values)
{
    for (size_t i = 0; i < r->items->count; i++) {
        const tl_lua_item item = tl_lua_item_push(L, 1, r->items, i);
        const lua_Integer number = r->kind->number(&item.name);
        lua_pop(L, 1);
        const int type = lua_rawgeti(L, -1, number);
        const double length = type == LUA_TTABLE ? length_at(L) : NAN;
        if (type != LUA_TNUMBER && type != LUA_TNIL && isnan(length))
            tl_lua_fail(L, "%s: %s: '%s' has %s for %s %I, and not a number or a vector {x, y, z}", r->context, r->key,
                        field->name, tl_lua_describe(L, -1), r->kind->item, number);
        values[i] = type == LUA_TNUMBER ? lua_tonumber(L, -1) : length;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

/* Finds the values of field `i`. */
static void take_values(lua_State *L, request *r, size_t i, size_t listed)
{
    tl_extra_field *field = &r->fields[i];
    field->count = r->items->count;
    field->unit = "";
    double *values = lua_newuserdatauv(L, (field->count + 1) * sizeof *values, 0);
    field->values = values;
    lua_rawseti(L, r->anchor, (lua_Integer)(r->count + i) + 1);
    if (i < listed) {
        ask_field(L, r, field, field->name, values);
        return;
    }
    int type = lua_getfield(L, r->given, field->name);
    if (type == LUA_TFUNCTION) {
        ask_function(L, r, field);
        return;
    }
    if (type == LUA_TTABLE) {
        look_up(L, r, field, values);
        return;
    }
    if (type != LUA_TSTRING)
        tl_lua_fail(L, "%s: %s: '%s' must be the name of a field, a table by ids or a function(%s), not %s", r->context,
                    r->key, field->name, r->kind->item, tl_lua_describe(L, -1));
    ask_field(L, r, field, lua_tostring(L, -1), values);
    lua_pop(L, 1);
}

/* Pushes the selection of all blocks, contacts or zones, also of hidden blocks. Zones have that of blocks below it. */
static const tl_lua_selection *push_all(lua_State *L, const tl_lua_kind *kind)
{
    tl_model *model = ((const tl_lua_model *)lua_touserdata(L, 1))->model;
    if (kind == &tl_lua_contact_kind) {
        tl_lua_selection *all = tl_lua_selection_push(L, kind, 1);
        tl_lua_contacts_select(L, model, NULL, all);
        return all;
    }
    tl_lua_selection *blocks = tl_lua_selection_push(L, &tl_lua_block_kind, 1);
    tl_block_filter any = tl_block_filter_default();
    any.hidden = -1;
    tl_lua_blocks_select(L, model, &any, blocks);
    if (kind == &tl_lua_block_kind)
        return blocks;
    tl_lua_selection *zones = tl_lua_selection_push(L, kind, 1);
    tl_zone_filter of = tl_zone_filter_default();
    of.blocks = blocks->names;
    of.block_count = blocks->count;
    tl_zone_name *names = NULL;
    const tl_status status = tl_zones_select(model, &of, &names, &zones->count);
    zones->names = names;
    tl_lua_ok(L, model, status);
    return zones;
}

/* The fields that the table at `table` asks for under `key`, of all blocks, contacts or zones of the model at index 1.
 * `context` names the method. Pushes one value, which must stay on the stack as long as they are used. */
static const tl_extra_field *extra_fields(lua_State *L, int table, const char *key, const char *context,
                                          const tl_lua_kind *kind, size_t *count)
{
    table = lua_absindex(L, table);
    *count = 0;
    lua_newtable(L);
    request r = {.key = key, .context = context, .kind = kind, .anchor = lua_gettop(L)};
    if (tl_lua_option(L, table, key) == LUA_TNIL) {
        lua_settop(L, r.anchor);
        return NULL;
    }
    if (!lua_istable(L, -1))
        tl_lua_fail(L, "%s: %s must be a table, as in {\"%s\", name = function(%s) ... end}, not %s", context, key,
                    kind->fields(&r.count)[0].name, kind->item, tl_lua_describe(L, -1));
    luaL_checkstack(L, 16, "too many values");
    r.given = lua_gettop(L);
    size_t entries = 0, listed = lua_rawlen(L, r.given);
    for (lua_pushnil(L); lua_next(L, r.given); lua_pop(L, 1))
        entries++;
    r.fields = lua_newuserdatauv(L, (entries + 1) * sizeof *r.fields, 0);
    lua_rawseti(L, r.anchor, 0);
    r.count = 0;
    take_names(L, &r);
    r.items = push_all(L, kind);
    for (size_t i = 0; i < r.count; i++)
        take_values(L, &r, i, listed);
    lua_settop(L, r.anchor);
    *count = r.count;
    return r.fields;
}

/* ---------------------------------------------------------------- pages ------------------ */

static int32_t read_contacts(lua_State *L, int table, const char *context)
{
    int type = tl_lua_option(L, table, "contacts");
    int32_t choice = TL_HTML_CONTACTS_FEW;
    if (type == LUA_TBOOLEAN)
        choice = lua_toboolean(L, -1) ? TL_HTML_CONTACTS_ALL : TL_HTML_CONTACTS_NONE;
    else if (type == LUA_TSTRING && strcmp(lua_tostring(L, -1), "slipping") == 0)
        choice = TL_HTML_CONTACTS_SLIPPING;
    else if (type != LUA_TNIL)
        tl_lua_fail(L, "%s: contacts must be true, false or \"slipping\", not %s", context, tl_lua_describe(L, -1));
    lua_pop(L, 1);
    return choice;
}

/* Pushes the keyblocks that are asked for, or nil. */
static const tl_keyblocks *push_keyblocks(lua_State *L, int table)
{
    if (tl_lua_option(L, table, "keyblocks") == LUA_TNIL)
        return NULL;
    lua_pushcfunction(L, tl_lua_keyblocks_find);
    lua_pushvalue(L, 1);
    lua_pushvalue(L, -3);
    lua_call(L, 2, 1);
    lua_remove(L, -2);
    return lua_touserdata(L, -1);
}

/* The factor of safety that is asked for; 0: none. */
static double read_limit(lua_State *L, int table, const char *context)
{
    double limit = 0;
    if (tl_lua_option(L, table, "safety_limit") != LUA_TNIL) {
        limit = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : NAN;
        if (!(limit > 0) || !isfinite(limit))
            tl_lua_fail(L, "%s: safety_limit must be a number above 0, not %s", context, tl_lua_describe(L, -1));
    }
    lua_settop(L, table);
    return limit;
}

void tl_lua_page_read(lua_State *L, int given, const char *context, tl_html *html)
{
    luaL_checkstack(L, 32, "too many values");
    html->contacts = read_contacts(L, given, context);
    lua_pushvalue(L, given); /* what is pushed from here on stays */
    int table = lua_gettop(L);
    html->safety_limit = read_limit(L, table, context);
    html->keyblocks = push_keyblocks(L, table);
    html->block_fields = extra_fields(L, table, "block_fields", context, &tl_lua_block_kind, &html->block_field_count);
    html->contact_fields =
        extra_fields(L, table, "contact_fields", context, &tl_lua_contact_kind, &html->contact_field_count);
}

static int model_write_html(lua_State *L, tl_model *model)
{
    const char *prefix = tl_lua_text(L, 2, "write_html", "the prefix");
    tl_html html = tl_html_default();
    tl_lua_read_function(L, 3, "write_html", page_keys, &html);
    tl_lua_page_read(L, 3, "write_html", &html);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_lua_ok(L, model,
              tl_lua_watch_end(L, &watch, tl_write_html(model, prefix, &html), "write_html", "no frame was written"));
    return 0;
}

/* ---------------------------------------------------------------- other files ------------ */

/* What a writer has done that was cancelled. */
#define NO_FILE "no file was written"

static int model_write_vtk(lua_State *L, tl_model *model)
{
    const char *prefix = tl_lua_text(L, 2, "write_vtk", "the prefix");
    tl_vtk_parts parts = tl_vtk_parts_default();
    tl_lua_read_function(L, 3, "write_vtk", field_keys, &parts);
    parts.block_fields = extra_fields(L, 3, "block_fields", "write_vtk", &tl_lua_block_kind, &parts.block_field_count);
    parts.contact_fields =
        extra_fields(L, 3, "contact_fields", "write_vtk", &tl_lua_contact_kind, &parts.contact_field_count);
    parts.zone_fields = extra_fields(L, 3, "zone_fields", "write_vtk", &tl_lua_zone_kind, &parts.zone_field_count);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_lua_ok(L, model, tl_lua_watch_end(L, &watch, tl_write_vtk(model, prefix, &parts), "write_vtk", NO_FILE));
    return 0;
}

static int model_write_blocks(lua_State *L, tl_model *model)
{
    const char *path = tl_lua_text(L, 2, "write_blocks", "the file's name");
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_lua_ok(L, model, tl_lua_watch_end(L, &watch, tl_write_blocks(model, path), "write_blocks", NO_FILE));
    return 0;
}

static int model_write_section(lua_State *L, tl_model *model)
{
    const char *prefix = tl_lua_text(L, 2, "write_section", "the prefix");
    tl_halfspace plane;
    tl_lua_read_function(L, 3, "write_section", NULL, &plane);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_lua_ok(L, model, tl_lua_watch_end(L, &watch, tl_write_section(model, prefix, &plane), "write_section", NO_FILE));
    return 0;
}

const tl_lua_topic tl_lua_page_topics[] = {
    {.name = "write_html",
     .usage = "model:write_html(\"out/run\", {title = \"Slope\", block_fields = {\"kinetic_energy\"}})",
     .function = "write_html",
     .keys = page_keys,
     .arguments = 2,
     .method = model_write_html},
    {.name = "write_vtk",
     .usage = "model:write_vtk(\"out/run\", {contacts = false, block_fields = {height = "
              "function(b) return b.centroid[3] end}})",
     .function = "write_vtk",
     .keys = field_keys,
     .arguments = 2,
     .method = model_write_vtk},
    {.name = "write_section",
     .usage = "model:write_section(\"out/cut\", {dip = 90, dip_direction = 90, origin = {0, 0, 0}})",
     .function = "write_section",
     .arguments = 2,
     .method = model_write_section},
    {.name = "write_blocks",
     .usage = "model:write_blocks(\"out/blocks.json\")",
     .function = "write_blocks",
     .arguments = 1,
     .method = model_write_blocks},
    {.name = NULL},
};
