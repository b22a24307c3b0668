/* boundary.h - model:boundary{...}. */
#ifndef TL_LUA_BOUNDARY_H
#define TL_LUA_BOUNDARY_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_boundary_topics[];

#endif
