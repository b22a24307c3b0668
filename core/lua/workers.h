/* workers.h - worker processes and files of rows, for modules of Talus that are written in Lua. */
#ifndef TL_LUA_WORKERS_H
#define TL_LUA_WORKERS_H

#include "lua/front.h"

/* Pushes the module talus.workers. */
int tl_lua_workers_open(lua_State *L);

#endif
