/* state.h - copies of a model, its files, and runs that are saved as they go. */
#ifndef TL_LUA_STATE_H
#define TL_LUA_STATE_H

#include "lua/front.h"

/* The file of a script's saves, SCRIPT.autosave.talus, from malloc; NULL when out of memory. */
char *tl_lua_autosave_path(const char *script);
/* Between two steps of a run: saves the model when it is time to. */
void tl_lua_autosave(tl_lua_options *options, tl_model *model);

extern const tl_lua_topic tl_lua_state_topics[];

#endif
