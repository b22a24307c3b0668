/* quality.h - what a model is asked as a whole: its blocks, keyblocks, verdict, and what it costs. */
#ifndef TL_LUA_QUALITY_H
#define TL_LUA_QUALITY_H

#include "lua/front.h"

/* Pushes the sentence that says which block controls the time step. */
void tl_lua_push_timestep(lua_State *L, tl_model *model, const tl_timestep_report *report);
/* With the arguments of the method, pushes a userdata that holds a tl_keyblocks as long as it lives; 1. */
int tl_lua_keyblocks_find(lua_State *L);

extern const tl_lua_topic tl_lua_quality_topics[];

#endif
