/* item.h - one block or one contact as a Lua object. */
#ifndef TL_LUA_ITEM_H
#define TL_LUA_ITEM_H

#include "lua/front.h"

/* Makes the metatables of a kind's items and selections. */
void tl_lua_item_open(lua_State *L, const tl_lua_kind *kind);
/* The field of a kind that has that name, and its index; NULL: there is none. */
const tl_field *tl_lua_field_named(const tl_lua_kind *kind, const char *name, size_t *index);
/* Pushes an item; `model_index` is where the model's userdata is. */
void tl_lua_item_push(lua_State *L, const tl_lua_kind *kind, int model_index, tl_id id);
/* Makes the block in the field `name` of the table at the top of the stack the one of that id, without needing memory.
 * TL_NO_ID: takes it out. */
void tl_lua_item_rename(lua_State *L, const char *name, tl_id id);

#endif
