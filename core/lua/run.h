/* run.h - cycle, solve and generate. */
#ifndef TL_LUA_RUN_H
#define TL_LUA_RUN_H

#include "lua/front.h"

/* model:generate("GENERATOR", {...}) */
int tl_lua_model_generate(lua_State *L, tl_model *model);

extern const tl_lua_topic tl_lua_run_topics[];

#endif
