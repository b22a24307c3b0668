/* quiet.h - quiet faces of rigid blocks, which model:boundary{quiet = true} places as elements of the kind "quiet". */
#ifndef TL_LUA_QUIET_H
#define TL_LUA_QUIET_H

#include "lua/front.h"

#include <talus/boundary.h>

/* What is to be done at the quiet faces of one side. */
typedef struct tl_lua_quiet {
    tl_args args; /* of the elements */
    const tl_boundary_face *faces;
    size_t face_count;
    tl_id *block;  /* [face_count] of the faces */
    uint8_t *what; /* [face_count] components in which these are let go */
} tl_lua_quiet;

/* Plans quiet faces of rigid blocks for one of `count` actions and what was found for it; false: it has none. The model
 * is at index 1, the table of the call at 2; `side` is the key in it, or NULL. Raises where something is amiss. Pushes
 * values that stay on the stack as long as the plan is used. */
bool tl_lua_quiet_plan(lua_State *L, tl_model *model, const char *side, const tl_boundary_action *actions,
                       const tl_boundary_result *found, size_t count, size_t which, tl_lua_quiet *plan);
/* Does it, in the place of earlier quiet faces there. */
void tl_lua_quiet_place(lua_State *L, tl_model *model, const tl_lua_quiet *plan);

#endif
