/* record.h - talus.record. */
#ifndef TL_LUA_RECORD_H
#define TL_LUA_RECORD_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_record_topics[];

/* Whether the value at the top of the stack is a list {x, y, z} of which some are records. These go to `records`, the
 * numbers to `constant`. Raises where the others are no numbers. */
bool tl_lua_record_velocity(lua_State *L, const tl_record *records[3], tl_vec3 *constant);

#endif
