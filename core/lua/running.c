/* running.c - the run whose step is being made, for functions of the script that are called in it (run.c, action.c). */
#include "front.h"

static tl_lua_running *current;

void tl_lua_running_begin(tl_lua_running *run, lua_State *L)
{
    *run = (tl_lua_running){.L = L, .outer = current};
    current = run;
}

void tl_lua_running_end(const tl_lua_running *run)
{
    current = run->outer;
}

lua_State *tl_lua_run_state(void)
{
    return current->L;
}

void tl_lua_run_keep_error(void)
{
    lua_replace(current->L, TL_LUA_AT_ERROR);
    current->failed = true;
}
