/* element.h - elements in Lua: model:element, model:elements. */
#ifndef TL_LUA_ELEMENT_H
#define TL_LUA_ELEMENT_H

#include "lua/front.h"

extern const tl_lua_kind tl_lua_element_kind;
extern const tl_lua_topic tl_lua_element_topics[];

#endif
