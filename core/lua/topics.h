/* topics.h - all that the help tells. */
#ifndef TL_LUA_TOPICS_H
#define TL_LUA_TOPICS_H

#include "lua/front.h"

/* The topic number i, in the order of the help; NULL past the last. */
const tl_lua_topic *tl_lua_topic_at(size_t i);
/* The parameters and further keys of a topic. */
tl_lua_spec tl_lua_topic_spec(const tl_lua_topic *topic);

#endif
