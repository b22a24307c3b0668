/* selection.h - a list of blocks or contacts as a Lua object. */
#ifndef TL_LUA_SELECTION_H
#define TL_LUA_SELECTION_H

#include "lua/front.h"

void tl_lua_selection_open(lua_State *L, const tl_lua_kind *kind);
/* Pushes an empty selection, to be filled with a list that then belongs to it. */
tl_lua_selection *tl_lua_selection_push(lua_State *L, const tl_lua_kind *kind, int model_index);
/* Keeps those of the selection at `selection_index` for which the function at `function_index`
 * answers true. */
void tl_lua_selection_filter(lua_State *L, int selection_index, int function_index);

/* The function that the table at index 2, if there is one, has under `where`: its place on the stack, or 0. */
int tl_lua_read_where(lua_State *L, const tl_lua_kind *kind);

#endif
