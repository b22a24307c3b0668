/* interrupt.h - Ctrl-C (SIGINT) as a Lua error. */
#ifndef TL_LUA_INTERRUPT_H
#define TL_LUA_INTERRUPT_H

#include "lua/front.h"

tl_lua_watch tl_lua_watch_begin(lua_State *L);
/* Ends a watch of a call of the kernel, whose status it returns. After a Ctrl-C raises "stopped by Ctrl-C", of a call
 * that was cancelled "WHAT: stopped by Ctrl-C; OUTCOME". OUTCOME may be "". */
tl_status tl_lua_watch_end(lua_State *L, const tl_lua_watch *watch, tl_status status, const char *what,
                           const char *outcome);
/* The same of a run. But at the prompt what comes next on the line raises, so that the run's result is not lost. */
void tl_lua_watch_end_run(lua_State *L, const tl_lua_watch *watch, const char *what);
/* True from a Ctrl-C until its error is raised; for tl_model_interrupt_if. */
bool tl_lua_interrupt_asked(void);
/* Raises that error when there has been a Ctrl-C. */
void tl_lua_interrupt_check(lua_State *L);
/* lua_pcall under a watch. A Ctrl-C for which nothing has raised when it ends is forgotten. */
int tl_lua_watch_call(lua_State *L, int arguments, int results, int handler, bool at_prompt);
/* True when the message of an error of the last such call tells of a Ctrl-C. */
bool tl_lua_interrupted(const char *message);

#endif
