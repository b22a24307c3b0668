/* history.h - histories: samples of a model as it runs.
 *
 * The kernel keeps histories (talus/history.h). The functions that they sample are in a table by name, a user value of
 * the model's userdata. */
#ifndef TL_LUA_HISTORY_H
#define TL_LUA_HISTORY_H

#include "lua/front.h"

/* Takes the samples that are due, and finds when the next one is; false, with the error on the top of the stack, when
 * one fails. */
bool tl_lua_histories_sample(lua_State *L, int model_index);

/* The functions that histories of the model at `from` sample are those of its copy at `to` as well. */
void tl_lua_histories_share(lua_State *L, int from, int to);
/* Checks the option `histories` of the table at index 2, if there is one: functions by name. */
void tl_lua_histories_given(lua_State *L);
/* Gives the histories of the restored model at `model_index` their functions, of that option. Raises when what one asks
 * for is not there. */
void tl_lua_histories_again(lua_State *L, const char *path, int model_index);

extern const tl_lua_topic tl_lua_history_topics[];

#endif
