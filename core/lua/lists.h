/* lists.h - joints, laws, groups and kinds that there are, and the parameters in force. */
#ifndef TL_LUA_LISTS_H
#define TL_LUA_LISTS_H

#include "lua/front.h"

/* Puts talus.laws, talus.dampings and talus.generators into the module at the top of the stack. */
void tl_lua_lists_open(lua_State *L);

extern const tl_lua_topic tl_lua_lists_topics[];

#endif
