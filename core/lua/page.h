/* page.h - files of a model for those who look at it. */
#ifndef TL_LUA_PAGE_H
#define TL_LUA_PAGE_H

#include "lua/front.h"

/* Reads TL_LUA_PAGE_KEYS of the table at `given`, if there is one, for a page of the model at index 1. Pushes values
 * that must stay on the stack as long as they are used. */
void tl_lua_page_read(lua_State *L, int given, const char *context, tl_html *html);

extern const tl_lua_topic tl_lua_page_topics[];

#endif
