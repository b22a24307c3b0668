/* try_stiffer.h - a run once more on a copy of the model whose joints are stiffer. */
#ifndef TL_LUA_TRY_STIFFER_H
#define TL_LUA_TRY_STIFFER_H

#include "lua/front.h"

/* When the table of options at `args` asks for it: puts a copy of the model, with stiffer joints, into the field
 * `stiffer` of the table at `result`. Before the run, of which `what` is the name. */
void tl_lua_trial_prepare(lua_State *L, int args, int result, const char *what);
/* After the run: runs that copy, whose result takes its place. `keys`: options that are not handed on. A run that was
 * stopped has no verdict to compare. A trial that fails tells why. */
void tl_lua_trial_run(lua_State *L, int args, int result, const tl_lua_key *keys, const char *what);

#endif
