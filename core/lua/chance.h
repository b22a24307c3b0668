/* chance.h - what the modules of realisations and of data of the site ask of the kernel: draws, distributions, poles.
 * */
#ifndef TL_LUA_CHANCE_H
#define TL_LUA_CHANCE_H

#include "lua/front.h"

/* Pushes the module talus.chance. */
int tl_lua_chance_open(lua_State *L);

#endif
