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

/* The selection of blocks at index 1, of a verb that takes `most` arguments with it. */
tl_lua_selection *tl_lua_blocks_self(lua_State *L, int most, const char *method);
/* Raises on failure; otherwise answers with the selection itself. */
int tl_lua_blocks_done(lua_State *L, const tl_lua_selection *blocks, tl_status status);
/* The same of a verb that is of no use to an empty selection: a remark says so, "VERB: ...: no block was DONE". */
int tl_lua_blocks_acted(lua_State *L, const tl_lua_selection *blocks, const char *verb,
                        const char *done, tl_status status);

#endif
