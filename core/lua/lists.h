/* lists.h - joints, laws and groups that there are, and the parameters in force. */
#ifndef TL_LUA_LISTS_H
#define TL_LUA_LISTS_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_lists_topics[];

#endif
