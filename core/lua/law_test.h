/* law_test.h - talus.law_test. */
#ifndef TL_LUA_LAW_TEST_H
#define TL_LUA_LAW_TEST_H

#include "lua/front.h"

extern const tl_lua_topic tl_lua_law_test_topics[];

#endif
