/* incoming.h - waves through quiet faces of deformable blocks: nodes of elements of the kind "incoming". */
#ifndef TL_LUA_INCOMING_H
#define TL_LUA_INCOMING_H

#include "lua/front.h"

#include <talus/boundary.h>

/* Puts the gridpoints on faces of deformable blocks into the table at the top, as its field `nodes`. Raises where a
 * face is covered in part. */
void tl_lua_incoming_put(lua_State *L, tl_model *model, const tl_boundary_face *faces, size_t count);

#endif
