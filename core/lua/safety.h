/* safety.h - model:factor_of_safety and model:safety_map. */
#ifndef TL_LUA_SAFETY_H
#define TL_LUA_SAFETY_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_safety_topics[];

#endif
