/* water.h - water in joints, in Lua: model:water. */
#ifndef TL_LUA_WATER_H
#define TL_LUA_WATER_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_water_topics[];

#endif
