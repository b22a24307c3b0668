/* item.h - one block or one contact as a Lua object. */
#ifndef TL_LUA_ITEM_H
#define TL_LUA_ITEM_H

#include "lua/front.h"

/* Makes the metatables of a kind's items and selections. */
void tl_lua_item_open(lua_State *L, const tl_lua_kind *kind);
/* The kind of the items of an open type. */
const tl_lua_kind *tl_lua_item_kind(lua_State *L, const char *type);
/* Pushes an item of an open type; `model_index` is where the model's userdata is. */
void tl_lua_item_push(lua_State *L, const char *type, int model_index, tl_id id);
/* Sets a field of the table at the top of the stack to a block of the model at index 1; of TL_NO_ID there is none. */
void tl_lua_set_block(lua_State *L, const char *name, tl_id id);
/* The table at the top of the stack has a block in the field `name`, pushed before a call: makes it the one of that id,
 * without needing memory; TL_NO_ID: takes it out. */
void tl_lua_item_rename(lua_State *L, const char *name, tl_id id);

#endif
