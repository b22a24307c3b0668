/* page.h - model:write_html, and fields that a script adds to files and pages. */
#ifndef TL_LUA_PAGE_H
#define TL_LUA_PAGE_H

#include "lua/front.h"

/* Reads these of the table at `given`, if there is one, for a page of the model at index 1. Pushes values that must
 * stay on the stack as long as they are used. */
void tl_lua_page_read(lua_State *L, int given, const char *context, tl_html *html);

extern const tl_lua_key tl_lua_field_keys[];
/* The extra fields that the table at `table` asks for under `key`, of all blocks or all contacts of the model at index
 * 1. They are asked for as {"field", name = "field", name = function(item) ... end}. `context` names the method. Pushes
 * one value, which must stay on the stack as long as they are used. */
const tl_extra_field *tl_lua_extra_fields(lua_State *L, int table, const char *key,
                                          const char *context, const tl_lua_kind *kind,
                                          size_t *count);

extern const tl_lua_topic tl_lua_page_topics[];

#endif
