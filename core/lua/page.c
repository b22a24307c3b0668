/* page.c - model:write_html(prefix, {...}): a frame of a page for a browser. */
#include "front.h"

#include <string.h>

const tl_lua_key tl_lua_page_keys[] = {
    {"contacts", "true, false or \"slipping\"",
     "which contacts the frame has; when left out all, where there are 20000 at the most, and else "
     "those that slip"},
    TL_LUA_FIELD_KEYS,
    {"keyblocks", "{friction =, cohesion =, gravity =}",
     "parameters of model:keyblocks, whose modes and factors of safety are shown as well"},
    {NULL, NULL, NULL},
};

static int32_t read_contacts(lua_State *L, int table)
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
        tl_lua_fail(L, "write_html: contacts must be true, false or \"slipping\", not %s",
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

int tl_lua_write_html(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "write_html");
    tl_lua_arity(L, 3, "write_html");
    lua_settop(L, 3);
    luaL_checkstack(L, 32, "too many values");
    const char *prefix = tl_lua_text(L, 2, "write_html", "the prefix");
    tl_html html = tl_html_default();
    tl_lua_spec spec = tl_lua_spec_of("write_html", tl_lua_page_keys);
    tl_lua_read(L, 3, &spec, false, &html);
    html.contacts = read_contacts(L, 3);
    lua_pushvalue(L, 3); /* what is pushed from here on stays */
    int table = lua_gettop(L);
    html.keyblocks = push_keyblocks(L, table);
    html.block_fields = tl_lua_extra_fields(L, 3, "block_fields", "write_html", &tl_lua_block_kind,
                                            &html.block_field_count);
    html.contact_fields = tl_lua_extra_fields(L, 3, "contact_fields", "write_html",
                                              &tl_lua_contact_kind, &html.contact_field_count);
    tl_lua_watch watch = tl_lua_watch_begin(L);
    tl_status status = tl_write_html(model, prefix, &html);
    bool cancelled = status == TL_E_CANCELLED;
    tl_lua_watch_end(L, &watch, cancelled ? "write_html" : "",
                     cancelled ? "no frame was written" : "");
    tl_lua_ok(L, model, status);
    return 0;
}
