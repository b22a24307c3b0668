/* repl_complete.h - completion of names at the prompt. */
#ifndef TL_LUA_REPL_COMPLETE_H
#define TL_LUA_REPL_COMPLETE_H

#include <lua.h>
#include <stdbool.h>
#include <stddef.h>

/* From now on the tabulator completes names of the state. */
void tl_repl_complete_with(lua_State *L);
/* The lines of the chunk that stand above the one that is typed; NULL: none. Must live while that line is read. */
void tl_repl_complete_after(const char *text);

#define TL_SCAN_NAME 64   /* longest name that is heeded, with its zero */
#define TL_SCAN_LEVELS 32 /* of brackets; deeper ones are not told apart */

/* Where the bracket that ends before `end` begins, and a text in quotes likewise; `end` when it does not. */
bool tl_scan_is_name(char c);

#endif
