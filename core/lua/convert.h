/* convert.h - from Lua values to the kernel's named values and back. */
#ifndef TL_LUA_CONVERT_H
#define TL_LUA_CONVERT_H

#include "lua/front.h"

/* A number and a count of a table of results. */
typedef struct tl_lua_number {
    const char *name;
    double number;
} tl_lua_number;

typedef struct tl_lua_count {
    const char *name;
    size_t count;
} tl_lua_count;

/* The parameter of a kernel function that has that name, or NULL. */
const tl_param *tl_lua_param_named(const char *function, const char *name);
/* The spec of a kernel function. */
tl_lua_spec tl_lua_spec_of(const char *function, const tl_lua_key *keys);
/* Converts the table at `index` (nil or none: empty) for the kernel. Pushes one value, which must
 * stay on the stack as long as `args` is used. Keys listed in `skip` are left out. */
void tl_lua_args(lua_State *L, int index, const char *context, const tl_lua_key *skip, tl_args *args);
/* Checks the table at `index` against `spec` and fills `out`; see tl_args_read. Pushes one value
 * that must stay on the stack as long as strings in `out` are used. */
void tl_lua_read(lua_State *L, int index, const tl_lua_spec *spec, bool keep, void *out);
/* The same with the parameters of a kernel function. */
void tl_lua_read_function(lua_State *L, int index, const char *function, const tl_lua_key *keys, void *out);
/* Reads the tensor `key` of the table at `table`; true when it is given. */
bool tl_lua_read_tensor(lua_State *L, int table, const char *function, const char *key, tl_sym3 *out);
/* tl_lua_read for one value at `index`, given the name `key`. */
void tl_lua_read_one(lua_State *L, int index, const tl_lua_spec *spec, const char *key, void *out);
/* Pushes what the table at `table` has under a key, nil when there is no table; gives its type. */
int tl_lua_option(lua_State *L, int table, const char *key);
/* Raises unless the argument is a string without a zero byte. */
const char *tl_lua_text(lua_State *L, int index, const char *function, const char *what);
/* Raises when more than `most` arguments were given (the object itself counted). */
void tl_lua_arity(lua_State *L, int most, const char *function);
/* Pushes the text of the number at `index`, as Lua writes it where there is a decimal point. */
void tl_lua_push_number_text(lua_State *L, int index);
/* The key of the table at `index` that is none of 1 ... count, "0" or "'x'", pushed: of several always the same one.
 * NULL, and nothing is pushed, when there is none. */
const char *tl_lua_stray_key(lua_State *L, int index, size_t count);
/* What a list's keys must be. */
#define TL_LUA_LIST_KEYS "the keys of a list are 1, 2, 3 and so on, without gaps"
/* Raises when a list of so many items at `index`, called `what` in the sentence, has other keys as well. */
void tl_lua_check_list(lua_State *L, int index, const char *what, size_t count);
/* "a number", "nil", "a selection of blocks": what the value at `index` is; may push a string. */
const char *tl_lua_describe(lua_State *L, int index);
/* Pushes a list of numbers. */
void tl_lua_push_numbers(lua_State *L, const double *numbers, size_t count);
/* Pushes a list of every `step`th number; with a width, of lists of so many numbers that begin there. */
void tl_lua_push_rows(lua_State *L, const double *first, size_t count, size_t step, size_t width);
/* Set a field of the table at the top of the stack. */
void tl_lua_set_number(lua_State *L, const char *name, double number);
void tl_lua_set_count(lua_State *L, const char *name, size_t count);
void tl_lua_set_text(lua_State *L, const char *name, const char *text);
/* The same of several, {"volume", volume}, ...; a list ends with name = NULL. */
#define TL_LUA_SET_NUMBERS(L, ...) tl_lua_set_numbers(L, (const tl_lua_number[]){__VA_ARGS__, {NULL, 0}})
#define TL_LUA_SET_COUNTS(L, ...) tl_lua_set_counts(L, (const tl_lua_count[]){__VA_ARGS__, {NULL, 0}})
void tl_lua_set_numbers(lua_State *L, const tl_lua_number *numbers);
void tl_lua_set_counts(lua_State *L, const tl_lua_count *counts);
void tl_lua_set_vec3(lua_State *L, const char *name, tl_vec3 v);
/* The shortest text, of so many digits or more, that reads back as the same number. */
#define TL_LUA_NUMBER 40
const char *tl_lua_number_text(double number, int digits, char text[TL_LUA_NUMBER]);
/* Pushes the value of a parameter; nil for a number that was left out. */
void tl_lua_push_param(lua_State *L, const tl_param *param, const void *params);

/* The tl_side of a name; raises, beginning with `context`, when there is none. */
int32_t tl_lua_side(lua_State *L, const char *context, const char *name);
/* Reads the box `key` of the table at `table`; true when it is given. */
bool tl_lua_read_box(lua_State *L, int table, const char *function, const char *key, tl_bounds *box);

#endif
