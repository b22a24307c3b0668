/* modes.h - model:modes{...}. */
#ifndef TL_LUA_MODES_H
#define TL_LUA_MODES_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_modes_topics[];

#endif
