/* view.h - commands of those who look at a model, as lines of Lua (view_line.c). */
#ifndef TL_LUA_VIEW_H
#define TL_LUA_VIEW_H

#include "front.h"

/* Pushes the line that does the command to `model`, or nil for one that only concerns the run (pause, go, step). False, with a
 * sentence on the top of the stack in its place, when a block is not there. */
bool tl_lua_view_line(lua_State *L, tl_model *model, const tl_view_command *command,
                      const char *prefix);

#endif
