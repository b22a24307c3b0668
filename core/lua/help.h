/* help.h - `talus help` and `talus plugins`. */
#ifndef TL_LUA_HELP_H
#define TL_LUA_HELP_H

#include "lua/front.h"

/* Prints help on a topic, or the overview for NULL; false when there is none of that name, with a
 * sentence in `error`. */
bool tl_lua_help(const char *topic, tl_error *error);
/* Prints what plugins are loaded and what was refused. */
void tl_lua_help_plugins(void);

#endif
