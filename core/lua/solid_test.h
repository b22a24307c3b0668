/* solid_test.h - talus.solid_test: a solid on one zone, and its curve as lists. */
#ifndef TL_LUA_SOLID_TEST_H
#define TL_LUA_SOLID_TEST_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_solid_test_topics[];

#endif
