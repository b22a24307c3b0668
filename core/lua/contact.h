/* contact.h - selections of contacts and what a contact has beyond the kernel's fields. */
#ifndef TL_LUA_CONTACT_H
#define TL_LUA_CONTACT_H

#include "lua/front.h"

extern const tl_lua_kind tl_lua_contact_kind;
/* Fills an empty selection with the contacts that pass; `filter` NULL: all. */
void tl_lua_contacts_select(lua_State *L, tl_model *model, const tl_contact_filter *filter, tl_lua_selection *found);

extern const tl_lua_topic tl_lua_contact_topics[];

#endif
