/* zones.h - selections of zones and gridpoints, in Lua. */
#ifndef TL_LUA_ZONES_H
#define TL_LUA_ZONES_H

#include "lua/front.h"

extern const tl_lua_kind tl_lua_zone_kind, tl_lua_gridpoint_kind;

extern const tl_lua_topic tl_lua_zone_topics[];

#endif
