/* fail.h - how the front end raises errors. */
#ifndef TL_LUA_FAIL_H
#define TL_LUA_FAIL_H

#include "lua/front.h"

/* Raises "file:line: " (of the nearest Lua code up the stack) and a formatted sentence; formats as
 * of lua_pushfstring. The int is for `return tl_lua_fail(...)`. */
int tl_lua_fail(lua_State *L, const char *format, ...);
/* Pushes "file:line: " of the nearest Lua code up the stack, or "". */
void tl_lua_push_where(lua_State *L);
/* The same, but at the line where the Lua function at `index` is defined. */
int tl_lua_fail_in(lua_State *L, int index, const char *format, ...);
/* Raises the sentence of a failed kernel call. */
int tl_lua_raise(lua_State *L, const tl_error *error);
void tl_lua_names_add(tl_lua_names *names, const char *name);
void tl_lua_names_list(tl_lua_names *names, const char *const *list);
/* Raises "WHAT 'WORD' ...; did you mean 'NEAREST'?" or, when none is near, lists the known names. */
int tl_lua_unknown(lua_State *L, const char *what, const char *word, const tl_lua_names *names);

#endif
