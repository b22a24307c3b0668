/* library.h - the modules of Talus that are written in Lua (scripts/lib/talus), and files for them. */
#ifndef TL_LUA_LIBRARY_H
#define TL_LUA_LIBRARY_H

#include "lua/front.h"

/* Lets `require` find them; once a state. */
void tl_lua_library_open(lua_State *L);

extern const tl_lua_topic tl_lua_library_topics[];

#endif
