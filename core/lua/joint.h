/* joint.h - model:joint: the law of a joint, or of contacts between groups or selections. */
#ifndef TL_LUA_JOINT_H
#define TL_LUA_JOINT_H

#include "lua/front.h"

/* Method of models: model:joint(WHICH, LAW, {...}). */
int tl_lua_model_joint(lua_State *L, tl_model *model);
/* What the table WHICH has. */
extern const tl_lua_key tl_lua_joint_keys[];
/* Sets what law `index` of the model names of blocks in the table at the top of the stack. */
void tl_lua_set_scope(lua_State *L, tl_model *model, size_t index);

#endif
