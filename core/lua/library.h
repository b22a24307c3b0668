/* library.h - the modules of Talus that are written in Lua (scripts/lib/talus), and files for them. */
#ifndef TL_LUA_LIBRARY_H
#define TL_LUA_LIBRARY_H

#include "lua/front.h"

/* Lets `require` find them; once a state. */
void tl_lua_library_open(lua_State *L);

/* Finds the script of a command of the program: talus/commands/NAME.lua. */
bool tl_library_command(const char *name, char *path, size_t size);
/* Loads a script as a chunk: by the module talus/readers/ENDING.lua, which gives its text in Lua, or else as Lua. */
int tl_lua_script_load(lua_State *L, const char *script);

extern const tl_lua_topic tl_lua_library_topics[];

#endif
