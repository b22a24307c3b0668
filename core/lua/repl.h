/* repl.h - the program's way of running Lua: chunks with a handler for errors and for Ctrl-C, and
 * the read-eval-print loop. Part of the program, not of the module. */
#ifndef TL_LUA_REPL_H
#define TL_LUA_REPL_H

#include <lua.h>
#include <stdbool.h>

/* Exit status of a program that Ctrl-C has ended: 128 and the number of the signal, as shells have it. */
#define TL_EXIT_INTERRUPTED 130

/* Calls the function below its `arguments` arguments; gives the exit status that follows from it. On an error prints
 * "talus: " and the message on standard error, with `verbose` also the calls that led there. */
int tl_repl_call(lua_State *L, int arguments, int results, bool verbose);
/* Reads lines from the terminal, runs them and prints what they give, until the end of input. */
void tl_repl_run(lua_State *L, bool verbose);

#endif
