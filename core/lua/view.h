/* view.h - model:view: a model that is seen while it runs, and takes commands. */
#ifndef TL_LUA_VIEW_H
#define TL_LUA_VIEW_H

#include "lua/front.h"

/* After a step of the model at index 1: shows it when it is time to; `worth` as of tl_view_due. A function of the
 * script that fails is told, and asked no more. False, with the error on the top of the stack, after a Ctrl-C. */
bool tl_lua_view_step(lua_State *L, double worth);
/* Before a step: does what those who look want, and waits while they want it to; false likewise. */
bool tl_lua_view_between(lua_State *L);
/* As the model goes, which is at index 1. */
void tl_lua_view_end(lua_State *L, tl_lua_model *owner);

extern const tl_lua_topic tl_lua_view_topics[];

#endif
