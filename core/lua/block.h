/* block.h - what selections of blocks and blocks can do beyond what contacts can. */
#ifndef TL_LUA_BLOCK_H
#define TL_LUA_BLOCK_H

#include "lua/front.h"

/* The tl_side of a name; raises, beginning with `context`, when there is none. In block.c. */
int32_t tl_lua_side(lua_State *L, const char *context, const char *name);
extern const tl_lua_kind tl_lua_block_kind;

extern const tl_lua_topic tl_lua_block_topics[];

#endif
