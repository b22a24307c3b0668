/* deformable.h - solids, and blocks that get zones, in Lua. */
#ifndef TL_LUA_DEFORMABLE_H
#define TL_LUA_DEFORMABLE_H

#include "lua/front.h"

/* selection:deformable{...}: a method of selections of blocks. */
int tl_lua_deformable(lua_State *L, const tl_lua_selection *blocks);

extern const tl_lua_topic tl_lua_deformable_topics[];

#endif
