/* repl_history.h - the lines typed at the prompt, kept in a file from one session to the next. */
#ifndef TL_LUA_REPL_HISTORY_H
#define TL_LUA_REPL_HISTORY_H

#include <stdbool.h>

/* Reads what was typed before. When the file cannot be used, a remark says why, unless `quiet`, and nothing is kept. */
void tl_repl_history_open(bool quiet);
/* Adds a line, to the file as well. */
void tl_repl_history_add(const char *line);

#endif
