/* modes.c - small vibrations of a model at rest: model:modes{...}. */
#include "lua/modes.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <talus/modes.h>

typedef struct modes_args {
    int64_t count;
} modes_args;

static const tl_lua_key modes_results[] = {
    {"[k]", "", "a vibration, the slowest first:"},
    {"frequency, period", "", "Hz, and s; 0 and infinite where nothing resists"},
    {"mass", "", "{x, y, z}: shares of the free mass that go with a base that moves along x, y, z"},
    {"shift", "", "by the number of each free block, {x, y, z}: motion of its centroid, 1 where it is largest"},
    {"turn", "", "likewise, rad in the place of m"},
    {NULL, NULL, NULL},
};

static int free_modes(lua_State *L)
{
    tl_modes_free(lua_touserdata(L, 1));
    return 0;
}

/* Sets the field of the table on the stack's top: vectors by the numbers of blocks. */
static void set_vectors(lua_State *L, const char *name, const tl_modes *of, const tl_vec3 *vector)
{
    lua_createtable(L, 0, (int)of->block_count);
    for (size_t i = 0; i < of->block_count; i++) {
        tl_lua_push_numbers(L, &vector[i].x, 3);
        lua_rawseti(L, -2, (lua_Integer)of->block[i]);
    }
    lua_setfield(L, -2, name);
}

static int model_modes(lua_State *L, tl_model *model)
{
    modes_args args;
    tl_lua_read_function(L, 2, "modes", NULL, &args);
    tl_modes *found = tl_lua_hold(L, sizeof *found, "talus.modes", free_modes);
    tl_lua_ok(L, model, tl_model_modes(model, (size_t)args.count, found));
    lua_createtable(L, (int)found->count, 0);
    for (size_t k = 0; k < found->count; k++) {
        const tl_mode *mode = &found->mode[k];
        lua_createtable(L, 0, 5);
        TL_LUA_SET_NUMBERS(L, {"frequency", mode->frequency}, {"period", 1 / mode->frequency});
        tl_lua_push_numbers(L, mode->mass, 3);
        lua_setfield(L, -2, "mass");
        set_vectors(L, "shift", found, mode->shift);
        set_vectors(L, "turn", found, mode->turn);
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    return 1;
}

const tl_lua_topic tl_lua_modes_topics[] = {
    {.name = "modes",
     .usage = "modes = model:modes{count = \"COUNT\"}",
     .function = "modes",
     .title = "What it gives: a list",
     .verbs = modes_results,
     .arguments = 1,
     .method = model_modes},
    {.name = NULL},
};
