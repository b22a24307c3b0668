/* repl_complete.h - completion of names at the prompt. */
#ifndef TL_LUA_REPL_COMPLETE_H
#define TL_LUA_REPL_COMPLETE_H

#include <lua.h>
#include <stdbool.h>

/* From now on the tabulator completes names of the state. */
void tl_repl_complete_with(lua_State *L);
/* The lines of the chunk that stand above the one that is typed; NULL: none. Must live while that line is read. */
void tl_repl_complete_after(const char *text);

/* Whether names have that character. */
bool tl_scan_is_name(char c);

#endif
