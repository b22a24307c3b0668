/* block.h - what selections of blocks and blocks can do beyond what contacts can. */
#ifndef TL_LUA_BLOCK_H
#define TL_LUA_BLOCK_H

#include "lua/front.h"

/* Sets a field of the table at the top of the stack to a block of the model at index 1. TL_NO_ID: sets none. */
void tl_lua_set_block(lua_State *L, const char *name, tl_id id);
extern const tl_lua_kind tl_lua_block_kind;
/* Fills an empty selection with the blocks that pass. */
void tl_lua_blocks_select(lua_State *L, tl_model *model, const tl_block_filter *filter, tl_lua_selection *found);

extern const tl_lua_key tl_lua_drive_keys[];
/* Pops a velocity and an angular velocity, functions or nil. Pushes a new anchor with them, hung on the model at
 * `model_index`. It counts as ended until the kernel has taken it. Fills the drive that it is for. */
void tl_lua_anchor_push(lua_State *L, int model_index, tl_drive *drive);

extern const tl_lua_topic tl_lua_block_topics[];

#endif
