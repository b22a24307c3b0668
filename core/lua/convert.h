/* convert.h - from Lua values to the kernel's named values and back. */
#ifndef TL_LUA_CONVERT_H
#define TL_LUA_CONVERT_H

#include "lua/front.h"

/* The spec of a kernel function. */
tl_lua_spec tl_lua_spec_of(const char *function, const tl_lua_key *keys);
/* Converts the table at `index` (nil or none: empty) for the kernel, and pushes one value that
 * must stay on the stack as long as `args` is used. Keys listed in `skip` are left out. */
void tl_lua_args(lua_State *L, int index, const char *context, const tl_lua_key *skip,
                 tl_args *args);
/* Checks the table at `index` against `spec` and fills `out`; see tl_args_read. Pushes one value
 * that must stay on the stack as long as strings in `out` are used. */
void tl_lua_read(lua_State *L, int index, const tl_lua_spec *spec, bool keep, void *out);
/* The same for one value at `index`, given the name `key`. */
void tl_lua_read_one(lua_State *L, int index, const tl_lua_spec *spec, const char *key, void *out);
/* Raises unless the argument is a string without a zero byte. */
const char *tl_lua_text(lua_State *L, int index, const char *function, const char *what);
/* Raises when more than `most` arguments were given (the object itself counted). */
void tl_lua_arity(lua_State *L, int most, const char *function);
/* Pushes the text of the number at `index`, as Lua writes it where there is a decimal point. */
void tl_lua_push_number_text(lua_State *L, int index);
/* "a number", "nil", "a selection of blocks": what the value at `index` is; may push a string. */
const char *tl_lua_describe(lua_State *L, int index);
void tl_lua_push_numbers(lua_State *L, const double *numbers, size_t count);
void tl_lua_push_vec3(lua_State *L, tl_vec3 v);
/* Set a field of the table at the top of the stack. */
void tl_lua_set_number(lua_State *L, const char *name, double number);
void tl_lua_set_count(lua_State *L, const char *name, size_t count);
void tl_lua_set_text(lua_State *L, const char *name, const char *text);
void tl_lua_set_vec3(lua_State *L, const char *name, tl_vec3 v);
/* Adds the shortest text, of so many digits or more, that reads back as the same number. */
void tl_lua_add_number(luaL_Buffer *to, double number, int digits);
/* Pushes a field's value as Lua sees it. */
void tl_lua_push_field(lua_State *L, tl_field_kind kind, const tl_field_value *value);

#endif
