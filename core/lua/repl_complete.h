/* repl_complete.h - completion of names at the prompt. */
#ifndef TL_LUA_REPL_COMPLETE_H
#define TL_LUA_REPL_COMPLETE_H

#include <lua.h>
#include <stdbool.h>

/* From now on the tabulator completes names of the state. `above`: the lines of the chunk that stand above the one that
 * is typed, NULL: none. They must live while that line is read. */
void tl_repl_complete(lua_State *L, const char *above);

/* Whether names have that character. */
bool tl_scan_is_name(char c);

#endif
