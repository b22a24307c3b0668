/* seat.h - blocks as drawn are taken as fitting: model:seat{...}. */
#ifndef TL_LUA_SEAT_H
#define TL_LUA_SEAT_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_seat_topics[];

#endif
