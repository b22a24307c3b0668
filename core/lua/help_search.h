/* help_search.h - whether pages of the help speak of a word (help_search.c). */
#ifndef TL_LUA_HELP_SEARCH_H
#define TL_LUA_HELP_SEARCH_H

#include "front.h"

bool tl_lua_topic_says(const tl_lua_topic *topic, const char *word);
/* Whether the word is a verb of what the page is of. */
bool tl_lua_topic_names(const tl_lua_topic *topic, const char *word);
bool tl_lua_kind_says(const tl_kind *kind, const char *word);

#endif
