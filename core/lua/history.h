/* history.h - what the parts of histories share: history.c makes them, history_sample.c samples, history_file.c tells.
 *
 * The kernel keeps histories (talus/history.h); the functions of those that sample one are in a table by name, a user value of
 * the model's userdata. */
#ifndef TL_LUA_HISTORY_H
#define TL_LUA_HISTORY_H

#include "front.h"

/* The place of the history of that name, or the number of histories. */
size_t tl_history_find(const tl_model *model, const char *name);
/* Sets the function of a history of the model at `model_index` to the value at the top of the stack, which it pops. */
void tl_history_set_function(lua_State *L, int model_index, const char *name);
/* Names a quantity that a model can be asked for, from 0; NULL past the last one. */
const char *tl_history_quantity(size_t i);
/* What blocks or contacts are, of a history of them. */
const tl_lua_kind *tl_history_kind(lua_State *L, const tl_history *h);
/* Finds the field that a history of blocks or contacts asks for; NULL: they have none of numbers of that name. */
const tl_field *tl_history_field(lua_State *L, const tl_history *h, size_t *index);
/* Takes a sample, while the model may only be read: as lua_pcall. */
int tl_lua_history_take(lua_State *L, int model_index, tl_history *h);

#endif
