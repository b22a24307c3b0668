/* page.c - model:write_html(prefix, {...}): a frame of a page for a browser. */
#include "front.h"

#include <math.h>
#include <string.h>

const tl_lua_key tl_lua_page_keys[] = {
    TL_LUA_PAGE_KEYS,
    {NULL, NULL, NULL},
};

static int32_t read_contacts(lua_State *L, int table, const char *context)
{
    if (!lua_istable(L, table))
        return TL_HTML_CONTACTS_FEW;
    int type = lua_getfield(L, table, "contacts");
    int32_t choice = TL_HTML_CONTACTS_FEW;
    if (type == LUA_TBOOLEAN)
        choice = lua_toboolean(L, -1) ? TL_HTML_CONTACTS_ALL : TL_HTML_CONTACTS_NONE;
    else if (type == LUA_TSTRING && strcmp(lua_tostring(L, -1), "slipping") == 0)
        choice = TL_HTML_CONTACTS_SLIPPING;
    else if (type != LUA_TNIL)
        tl_lua_fail(L, "%s: contacts must be true, false or \"slipping\", not %s", context,
                    tl_lua_describe(L, -1));
    lua_pop(L, 1);
    return choice;
}

/* Pushes the keyblocks that are asked for, or nil. */
static const tl_keyblocks *push_keyblocks(lua_State *L, int table)
{
    if (!lua_istable(L, table) || lua_getfield(L, table, "keyblocks") == LUA_TNIL) {
        lua_settop(L, table);
        lua_pushnil(L);
        return NULL;
    }
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
    if (lua_istable(L, table) && lua_getfield(L, table, "safety_limit") != LUA_TNIL) {
        limit = lua_type(L, -1) == LUA_TNUMBER ? lua_tonumber(L, -1) : NAN;
        if (!(limit > 0) || !isfinite(limit))
            tl_lua_fail(L, "%s: safety_limit must be a number above 0, not %s", context,
                        tl_lua_describe(L, -1));
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
    html->block_fields = tl_lua_extra_fields(L, table, "block_fields", context, &tl_lua_block_kind,
                                             &html->block_field_count);
    html->contact_fields = tl_lua_extra_fields(L, table, "contact_fields", context,
                                               &tl_lua_contact_kind, &html->contact_field_count);
}

int tl_lua_write_html(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "write_html");
    tl_lua_arity(L, 3, "write_html");
    lua_settop(L, 3);
    const char *prefix = tl_lua_text(L, 2, "write_html", "the prefix");
    tl_html html = tl_html_default();
    tl_lua_spec spec = tl_lua_spec_of("write_html", tl_lua_page_keys);
    tl_lua_read(L, 3, &spec, false, &html);
    tl_lua_page_read(L, 3, "write_html", &html);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_status status = tl_write_html(model, prefix, &html);
    bool cancelled = status == TL_E_CANCELLED;
    tl_lua_watch_end(L, &watch, cancelled ? "write_html" : "",
                     cancelled ? "no frame was written" : "");
    tl_lua_ok(L, model, status);
    return 0;
}
