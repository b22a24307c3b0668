/* block.h - what selections of blocks and blocks can do beyond what contacts can. */
#ifndef TL_LUA_BLOCK_H
#define TL_LUA_BLOCK_H

#include "lua/front.h"

/* The tl_side of a name; raises, beginning with `context`, when there is none. */
int32_t tl_lua_side(lua_State *L, const char *context, const char *name);
/* Reads the box `key` of the table at `table`; true when it is given. */
bool tl_lua_read_box(lua_State *L, int table, const char *function, const char *key,
                     tl_bounds *box);
/* Sets a field of the table at the top of the stack to a block of the model at index 1. TL_NO_ID: sets none. */
void tl_lua_set_block(lua_State *L, const char *name, tl_id id);
extern const tl_lua_kind tl_lua_block_kind;

extern const tl_lua_topic tl_lua_block_topics[];

#endif
