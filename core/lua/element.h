/* element.h - elements in Lua: model:element, model:elements. */
#ifndef TL_LUA_ELEMENT_H
#define TL_LUA_ELEMENT_H

#include "lua/front.h"
#include "lua/item.h"

#include <talus/elements.h>

extern const tl_lua_kind tl_lua_element_kind;
extern const tl_lua_topic tl_lua_element_topics[];

/* Pushes the selection of the elements that a filter lets through; its names are their ids. The model is at index 1. */
tl_lua_selection *tl_lua_elements_push(lua_State *L, tl_model *model, const tl_element_filter *filter);
/* Places elements of a kind, in the group of that name, and pushes their selection. */
tl_lua_selection *tl_lua_elements_make(lua_State *L, tl_model *model, const char *kind, const tl_args *args);

/* What a function may give for a place: more than `least`, or as much where `or_equal`, and at most `most`, which is
 * finite. `must` says so to the user: "water: pressure must give ...". */
typedef struct tl_lua_asked {
    double least, most;
    bool or_equal;
    const char *must;
} tl_lua_asked;

/* Asks the function at index `function` for a number at each place, as f(x, y, z), from the place `first` on; those
 * before get 0. The function may only read the model. Frees `places`, and pushes what holds the list. Raises at another
 * answer. */
const double *tl_lua_ask_places(lua_State *L, int function, tl_vec3 *places, size_t first, size_t count,
                                const tl_lua_asked *asked);

#endif
