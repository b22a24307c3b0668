/* model.h - the model as a Lua object. */
#ifndef TL_LUA_MODEL_H
#define TL_LUA_MODEL_H

#include "lua/front.h"

/* Takes the table of methods from the top of the stack for the metatable of models. Pushes the function talus.model. */
void tl_lua_model_open(lua_State *L);

extern const tl_lua_topic tl_lua_model_topics[];

#endif
