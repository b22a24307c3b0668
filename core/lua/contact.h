/* contact.h - selections of contacts and what a contact has beyond the kernel's fields. */
#ifndef TL_LUA_CONTACT_H
#define TL_LUA_CONTACT_H

#include "lua/front.h"

extern const tl_lua_kind tl_lua_contact_kind;

extern const tl_lua_topic tl_lua_contact_topics[];

#endif
