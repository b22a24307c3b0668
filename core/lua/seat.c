/* seat.c - blocks as drawn are taken as fitting: model:seat{...}. */
#include "lua/seat.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <stdlib.h>

static int free_seat_result(lua_State *L)
{
    free(((tl_seat_result *)lua_touserdata(L, 1))->beyond);
    return 0;
}

static void push_seat_result(lua_State *L, const tl_seat_result *r)
{
    lua_createtable(L, 0, 8);
    TL_LUA_SET_COUNTS(L, {"contacts", r->contacts});
    TL_LUA_SET_NUMBERS(L, {"largest_gap", r->largest_gap}, {"mean_gap", r->mean_gap},
                       {"largest_overlap", r->largest_overlap}, {"mean_overlap", r->mean_overlap}, {"gap", r->gap},
                       {"overlap", r->overlap});
    lua_createtable(L, (int)r->beyond_count, 0);
    for (size_t i = 0; i < r->beyond_count; i++) {
        const tl_seat_beyond *one = &r->beyond[i];
        lua_createtable(L, 0, 4);
        tl_lua_set_block(L, "a", one->a);
        tl_lua_set_block(L, "b", one->b);
        TL_LUA_SET_NUMBERS(L, {"gap", one->gap}, {"overlap", one->overlap});
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "beyond");
}

static int model_seat(lua_State *L, tl_model *model)
{
    tl_seat seat = tl_seat_default();
    tl_lua_read_function(L, 2, "seat", NULL, &seat);
    tl_seat_result *result = tl_lua_hold(L, sizeof *result, "talus.seat", free_seat_result);
    tl_lua_ok(L, model, tl_model_seat(model, &seat, result));
    push_seat_result(L, result);
    return 1;
}

static const tl_lua_key seat_results[] = {
    {"contacts", "", "number of pairs that were made to fit; those that fit already are not among them"},
    {"largest_gap, mean_gap", "", "of these, as they were before, m; the mean is by area"},
    {"largest_overlap, mean_overlap", "", "likewise"},
    {"beyond", "", "pairs beyond the limits, which stay as drawn: {a = block, b = block, gap =, overlap =}"},
    {"gap, overlap", "", "the limits, m"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_seat_topics[] = {
    {.name = "seat",
     .usage = "result = model:seat{gap = 0.002, overlap = 0.002}",
     .function = "seat",
     .title = "Fields of the result",
     .verbs = seat_results,
     .arguments = 1,
     .method = model_seat},
    {.name = NULL},
};
