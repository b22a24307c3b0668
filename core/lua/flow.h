/* flow.h - water that flows in joints, in Lua: model:water("flow") and model:flow. */
#ifndef TL_LUA_FLOW_H
#define TL_LUA_FLOW_H

#include "lua/front.h"

/* The kind of elements, and the source of model:water. */
#define TL_LUA_FLOW "flow"

/* Places wet joints by the table at the top of the stack, and pushes their selection. */
int tl_lua_flow_place(lua_State *L, tl_model *model);
int tl_lua_model_flow(lua_State *L, tl_model *model);

#endif
