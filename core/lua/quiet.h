/* quiet.h - quiet faces of rigid blocks and free fields: elements that model:boundary places. */
#ifndef TL_LUA_QUIET_H
#define TL_LUA_QUIET_H

#include "lua/front.h"
#include "lua/item.h"

#include <talus/boundary.h>

/* A call of model:boundary: its actions, and the faces found for each. */
typedef struct tl_lua_sides {
    const tl_boundary_action *actions;
    const tl_boundary_result *found;
    const bool *free_field; /* of each action */
    size_t count;
    bool add;   /* beside what earlier calls have done */
    bool keyed; /* sides are keys of the table of the call; else that is the table of the one action */
} tl_lua_sides;

/* What is to be done at the quiet faces of one side, or at a side that is a free field. */
typedef struct tl_lua_quiet {
    tl_args args;     /* of the elements */
    const char *kind; /* NULL: none come, and those of earlier calls go */
    const tl_boundary_face *faces;
    size_t face_count;
    tl_id *block;  /* [face_count] of the faces */
    uint8_t *what; /* [face_count] components in which these are let go */
    int table;     /* on the stack: its options, 0 where there is none */
} tl_lua_quiet;

/* Plans what the actions do that are quiet faces, waves through them or free fields, at most one plan each; those of
 * free fields come last. Returns how many there are. The model is at index 1, the table of the call at 2. Raises where
 * something is amiss. Pushes values that stay on the stack as long as the plans are used. `planned` becomes true
 * for each action of which the kernel has nothing quiet to do. */
size_t tl_lua_quiet_plan(lua_State *L, tl_model *model, const tl_lua_sides *sides, tl_lua_quiet *plans, bool *planned);
/* Does one, in the place of earlier quiet faces and free fields there. */
void tl_lua_quiet_place(lua_State *L, tl_model *model, const tl_lua_quiet *plan);
/* Whether a damping takes out vibrations of all frequencies. */
bool tl_lua_damps_all(const char *name);
/* Pushes the selection of free fields of the model, which is at index 1. */
const tl_lua_selection *tl_lua_free_fields(lua_State *L, tl_model *model);
/* Lets free fields have the damping that the model has got. */
void tl_lua_free_field_damp(lua_State *L, tl_model *model, const tl_lua_selection *fields);

#endif
