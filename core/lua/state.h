/* state.h - copies of a model, and its files. */
#ifndef TL_LUA_STATE_H
#define TL_LUA_STATE_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_state_topics[];

#endif
