/* item.h - blocks, contacts, zones and gridpoints as Lua objects: one of them, and a list. */
#ifndef TL_LUA_ITEM_H
#define TL_LUA_ITEM_H

#include "lua/front.h"

/* Makes the metatables of a kind's items and selections. */
void tl_lua_kind_open(lua_State *L, const tl_lua_kind *kind);
/* The field of a kind that has that name, and its index; NULL: there is none. */
const tl_field *tl_lua_field_named(const tl_lua_kind *kind, const char *name, size_t *index);
/* Pushes the item of a name; `model_index` is where the model's userdata is. */
void tl_lua_item_push_name(lua_State *L, const tl_lua_kind *kind, int model_index, const void *name);
/* Pushes item i of a selection, from 0. */
tl_lua_item tl_lua_item_push(lua_State *L, int model_index, const tl_lua_selection *selection, size_t i);
/* Makes the block in the field `name` of the table at the top of the stack the one of that id, without needing memory.
 * TL_NO_ID: takes it out. */
void tl_lua_item_rename(lua_State *L, const char *name, tl_id id);

/* Pushes an empty selection, to be filled with a list that then belongs to it. */
tl_lua_selection *tl_lua_selection_push(lua_State *L, const tl_lua_kind *kind, int model_index);
/* Keeps those of the selection at `selection_index` for which the function at `function_index` answers true. */
void tl_lua_selection_filter(lua_State *L, int selection_index, int function_index);

/* The function that the table at index 2, if there is one, has under `where`: its place on the stack, or 0. */
int tl_lua_read_where(lua_State *L, const tl_lua_kind *kind);

#endif
