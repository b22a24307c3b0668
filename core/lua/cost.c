/* cost.c - what a model costs: model:profile() in time, model:memory() in bytes. */
#include "front.h"

static void set_count(lua_State *L, const char *name, size_t count)
{
    lua_pushinteger(L, (lua_Integer)count);
    lua_setfield(L, -2, name);
}

/* profile(true) begins, profile(false) ends, profile() gives the result so far. */
int tl_lua_profile(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "profile");
    tl_lua_arity(L, 2, "profile");
    lua_settop(L, 2);
    if (!lua_isnil(L, 2)) {
        int32_t on;
        tl_lua_spec spec = tl_lua_spec_of("profile", NULL);
        tl_lua_read_one(L, 2, &spec, "on", &on);
        tl_model_profiling(model, on != 0);
        return 0;
    }
    tl_profile profile = tl_model_profile(model);
    lua_createtable(L, 0, 6);
    lua_createtable(L, 0, TL_PHASE_COUNT);
#define SET(item, name, doc)                                                                       \
    lua_pushnumber(L, profile.seconds[TL_PHASE_##item]);                                           \
    lua_setfield(L, -2, #name);
    TL_PHASES(SET)
#undef SET
    lua_setfield(L, -2, "seconds");
    set_count(L, "steps", (size_t)profile.steps);
    set_count(L, "pairs", profile.pairs);
    set_count(L, "contacts", profile.contacts);
    set_count(L, "loaded", profile.loaded);
    set_count(L, "points", profile.points);
    return 1;
}

int tl_lua_memory(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "memory");
    tl_lua_arity(L, 1, "memory");
    tl_memory memory = tl_model_memory(model);
    lua_createtable(L, 0, 13);
#define SET(name, doc) set_count(L, #name, memory.name);
    TL_MEMORY(SET)
#undef SET
    set_count(L, "total", memory.total);
    return 1;
}

const tl_lua_key tl_lua_profile_fields[] = {
#define KEY(item, name, doc) {"seconds." #name, "", doc},
    TL_PHASES(KEY)
#undef KEY
        {"steps", "", "steps since profiling began"},
    {"pairs", "", "candidate pairs of the broad phase, now"},
    {"contacts, loaded", "", "contacts there are, and those that carry a force"},
    {"points", "", "contact points"},
    {NULL, NULL, NULL},
};

const tl_lua_key tl_lua_memory_fields[] = {
#define KEY(name, doc) {#name, "", doc},
    TL_MEMORY(KEY)
#undef KEY
        {"total", "", "all of them"},
    {NULL, NULL, NULL},
};
