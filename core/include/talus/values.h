/* talus/values.h - named values, as a script or a program gives them, and checking them against a table of parameters.
 *
 *     tl_generate(model, "box", TL_ARGS(TL_ARG_VECTOR("min", 0, 0, 0), TL_ARG_VECTOR("max", 4, 4, 1),
 *                                       tl_arg_number("density", 2500)), NULL);
 */
#ifndef TALUS_VALUES_H
#define TALUS_VALUES_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A value as a script gives it, before it is checked against a tl_param table. */
typedef enum tl_value_type {
    TL_VALUE_NUMBER,  /* number */
    TL_VALUE_BOOL,    /* number is 0 or 1 */
    TL_VALUE_STRING,  /* text */
    TL_VALUE_NUMBERS, /* data: count numbers (a vector when count is 3) */
    TL_VALUE_POINTS,  /* data: count rows of 3 numbers */
    TL_VALUE_FLAT,    /* the same, given as rows of 2 numbers: the third is 0 */
    TL_VALUE_OTHER    /* text says what it is ("function", "list whose row 4 has 2 numbers") */
} tl_value_type;

typedef struct tl_value {
    const char *key;
    tl_value_type type;
    double number;
    const char *text;
    const double *data;
    size_t count;
} tl_value;

typedef struct tl_args {
    const tl_value *values;
    size_t count;
} tl_args;

/* Values of each type. Texts and numbers they point to stay the caller's. */
static inline tl_value tl_arg_number(const char *key, double number)
{
    tl_value value = {key, TL_VALUE_NUMBER, number, NULL, NULL, 0};
    return value;
}

static inline tl_value tl_arg_bool(const char *key, bool on)
{
    tl_value value = tl_arg_number(key, on ? 1 : 0);
    value.type = TL_VALUE_BOOL;
    return value;
}

static inline tl_value tl_arg_text(const char *key, const char *text)
{
    tl_value value = tl_arg_number(key, 0);
    value.type = TL_VALUE_STRING;
    value.text = text;
    return value;
}

static inline tl_value tl_arg_numbers(const char *key, const double *data, size_t count)
{
    tl_value value = tl_arg_number(key, 0);
    value.type = TL_VALUE_NUMBERS;
    value.data = data;
    value.count = count;
    return value;
}

/* A vector, and a list of values for a call: TL_ARGS(tl_arg_number("kn", 1e9), tl_arg_text("group", "rock")). In C they
 * last to the end of the block that they are in, in C++ to the end of the call. */
#ifdef __cplusplus
} /* extern "C" */
#include <initializer_list>
struct tl_numbers3 {
    double at[3];
};
struct tl_args_list : tl_args {
    tl_args_list(std::initializer_list<tl_value> list)
    {
        values = list.begin();
        count = list.size();
    }
    const tl_args *get() const
    {
        return this;
    }
};
#define TL_ARG_VECTOR(key, x, y, z) tl_arg_numbers((key), tl_numbers3{{(x), (y), (z)}}.at, 3)
#define TL_ARGS(...) (tl_args_list{__VA_ARGS__}.get())
extern "C" {
#else
#define TL_ARG_VECTOR(key, x, y, z) tl_arg_numbers((key), (const double[]){(x), (y), (z)}, 3)
#define TL_ARGS(...)                                                                                                   \
    (&(const tl_args){(const tl_value[]){__VA_ARGS__}, sizeof((const tl_value[]){__VA_ARGS__}) / sizeof(tl_value)})
#endif

/* Checks `args` against a table of parameters and fills the struct `out`. Refused are unknown keys (with the nearest
 * known name), wrong types, values out of range, NaN and infinity, and missing required parameters. The sentence starts
 * with `context` ("joint 'J1', law 'coulomb'"). With `keep` true only the given parameters are written (a change
 * of one property) and nothing is required. On failure `out` is unspecified. Strings and points stay the caller's. */
TL_API tl_status tl_args_read(const tl_param *params, size_t count, size_t stride, const tl_args *args, bool keep,
                              void *out, const char *context, tl_error *error);

/* The range of a parameter as text: "[0, 90)", "> 0", ">= 0"; "" when it has none. */
TL_API void tl_param_range(const tl_param *param, char *text, size_t size);
/* The name nearest to `word` (a typing error or the beginning of a name), or NULL when none is near. */
TL_API const char *tl_nearest_name(const char *word, const char *const *names, size_t count);

/* The parameter tables of the kernel's own functions ("model", "solve", "insitu", ...), for
 * checking and for help. NULL when there is none of that name. */
TL_API const tl_param *tl_function_params(const char *function, size_t *count, const char **doc);

#ifdef __cplusplus
}
#endif
#endif
