/* living.h - what all of the front end asks of a Lua state. */
#ifndef TL_LUA_LIVING_H
#define TL_LUA_LIVING_H

#include "lua/front.h"

/* The options of a Lua state, made when first asked for; lives as long as the state. */
tl_lua_options *tl_lua_options_of(lua_State *L);
/* Prints a remark of the kernel on standard error, unless the options, its user data, say quiet. */
void tl_lua_log(void *user, const char *text);
/* Pushes memory, all zero, with a metatable of that name, whose __gc is `release`. */
void *tl_lua_hold(lua_State *L, size_t size, const char *type, lua_CFunction release);
/* Pushes an object without a model yet; gives the model that has been put into it its log and its ear for Ctrl-C. */
tl_lua_model *tl_lua_model_push(lua_State *L);
void tl_lua_model_begin(lua_State *L, const tl_lua_model *object);
/* Sets a number of threads by --threads, else by the environment; else it stays. */
void tl_lua_default_threads(lua_State *L, int64_t *threads);
/* The model at index 1; raises, naming the method, when it is something else. */
tl_model *tl_lua_model_of(lua_State *L, const char *method);
/* The model of an item or a selection; raises when it was closed (as the Lua state ends). */
tl_model *tl_lua_living(lua_State *L, const tl_lua_model *owner);
/* Raises the model's error unless `status` is TL_OK. */
void tl_lua_ok(lua_State *L, tl_model *model, tl_status status);

/* lua_pcall of a function of the script, for so many results, while the model may only be read. */
int tl_lua_call_reading(lua_State *L, tl_lua_model *owner, int arguments, int results);

/* Makes a run the one whose step is being made, NULL: none; gives the one that was. */
tl_lua_running *tl_lua_running_set(tl_lua_running *run);
/* The Lua state of the run whose step is being made. */
lua_State *tl_lua_run_state(void);
/* Pops the error on the top of its stack, to be raised again when the run has ended. */
void tl_lua_run_keep_error(void);

#endif
