/* action.h - what acts on blocks from outside. */
#ifndef TL_LUA_ACTION_H
#define TL_LUA_ACTION_H

#include "lua/front.h"

extern const tl_lua_key tl_lua_drive_keys[];
/* What verbs of blocks do: load{...}, drive{...} and, which pushes a vector, reaction(). */
tl_status tl_lua_blocks_load(lua_State *L, const tl_lua_selection *blocks);
tl_status tl_lua_blocks_drive(lua_State *L, const tl_lua_selection *blocks);
int tl_lua_blocks_reaction(lua_State *L, const tl_lua_selection *blocks);
/* Pushes a new anchor and hangs it on the model at `model_index`; it counts as ended until the kernel has taken it. */
tl_lua_anchor *tl_lua_anchor_push(lua_State *L, int model_index);
/* The functions of a drive for the anchor `a`, which is at the top of the stack: those that it has. */
void tl_lua_anchor_drive(lua_State *L, tl_lua_anchor *a, tl_drive *drive);

extern const tl_lua_topic tl_lua_action_topics[];

#endif
