/* wave_checks.h - what may be amiss with waves that come in: damping, steps, and blocks that are too high. */
#ifndef TL_LUA_WAVE_CHECKS_H
#define TL_LUA_WAVE_CHECKS_H

#include "lua/front.h"

#include <talus/boundary.h>
#include <talus/record.h>

/* Raises where a wave comes in through elements, and a damping is chosen that takes out vibrations. */
void tl_lua_waves_keep(lua_State *L, tl_model *model, const char *name);
/* Remarks on a step that is longer than the time between samples of the records, of x, y and z. */
void tl_lua_waves_step(lua_State *L, tl_model *model, const tl_record *const records[3]);

/* A face of a rigid block through which a wave comes in, and velocities of waves there, m/s. */
typedef struct tl_lua_wave_face {
    tl_id block;
    double height; /* m, of the block across the face */
    double along, across;
    tl_vec3 normal;
} tl_lua_wave_face;
/* Remarks on the face whose block is the highest for the shortest waves, where fewer than ten blocks make one up. */
void tl_lua_waves_blocks(lua_State *L, const tl_record *const records[3], const tl_lua_wave_face *faces, size_t count);

#endif
