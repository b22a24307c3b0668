/* params.c - checks a script's values against a table of parameters and fills a plain struct.
 *
 * Every refusal is one sentence of the form "<context>: <what is wrong, value, unit> <allowed>". So a user can mend
 * the script without looking anything up. Nothing here allocates. */
#include "base/params.h"

#include "base/error.h"
#include "base/names.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Most names and aliases of one table that are offered as hints. */
#define MOST_NAMES 128
/* Whole numbers a tl_value carries exactly are below this; beyond it int64_t would overflow too. */
#define INT_LIMIT 0x1p63

/* One argument being read: the parameter it fills, and where to say so when it does not fit. */
typedef struct reader {
    tl_param param;
    const tl_value *value;
    const char *prefix; /* of sentences: "context: ", or nothing */
    tl_error *error;
} reader;

tl_param tl_param_row(const tl_param *params, size_t index, size_t stride)
{
    tl_param row;
    const char *at = (const char *)params + index * (stride ? stride : sizeof row);
    uint32_t size;
    memcpy(&size, at, sizeof size);
    memset(&row, 0, sizeof row);
    memcpy(&row, at, size < sizeof row ? size : sizeof row);
    return row;
}

size_t tl_param_bytes(uint32_t type)
{
    switch (type) {
    case TL_PARAM_REAL: return sizeof(double);
    case TL_PARAM_INT: return sizeof(int64_t);
    case TL_PARAM_BOOL:
    case TL_PARAM_ENUM: return sizeof(int32_t);
    case TL_PARAM_VEC3: return sizeof(tl_vec3);
    case TL_PARAM_STRING: return sizeof(const char *);
    case TL_PARAM_POINTS: return sizeof(tl_points);
    default: return 0;
    }
}

bool tl_param_ranged(const tl_param *param)
{
    return param->min < 0 || param->min > 0 || param->max < 0 || param->max > 0;
}

bool tl_param_in_range(const tl_param *param, double value)
{
    if (!isfinite(value))
        return false;
    if (!tl_param_ranged(param))
        return true;
    bool above = param->flags & TL_PARAM_MIN_OPEN ? value > param->min : value >= param->min;
    bool below = param->flags & TL_PARAM_MAX_OPEN ? value < param->max : value <= param->max;
    return above && below;
}

void tl_param_range(const tl_param *param, char *text, size_t size)
{
    char low[TL_NUMBER_TEXT], high[TL_NUMBER_TEXT];
    bool open_min = param->flags & TL_PARAM_MIN_OPEN, open_max = param->flags & TL_PARAM_MAX_OPEN;
    tl_number_text(param->min, low);
    tl_number_text(param->max, high);
    if (!tl_param_ranged(param) || (isinf(param->min) && isinf(param->max)))
        snprintf(text, size, "%s", "");
    else if (isinf(param->max))
        snprintf(text, size, "%s %s", open_min ? ">" : ">=", low);
    else if (isinf(param->min))
        snprintf(text, size, "%s %s", open_max ? "<" : "<=", high);
    else
        snprintf(text, size, "%c%s, %s%c", open_min ? '(' : '[', low, high, open_max ? ')' : ']');
}

/* What the caller gave, in words a script's author knows. */
static void describe_value(const tl_value *value, char *text, size_t size)
{
    char number[TL_NUMBER_TEXT];
    switch (value->type) {
    case TL_VALUE_NUMBER:
        tl_number_text(value->number, number);
        snprintf(text, size, "the number %s", number);
        break;
    case TL_VALUE_BOOL: snprintf(text, size, "%s", value->number > 0 ? "true" : "false"); break;
    case TL_VALUE_STRING: snprintf(text, size, "the string '%.60s'", value->text); break;
    case TL_VALUE_NUMBERS:
        snprintf(text, size, "a list of %zu number%s", value->count, value->count == 1 ? "" : "s");
        break;
    case TL_VALUE_POINTS:
        snprintf(text, size, "a list of %zu point%s", value->count, value->count == 1 ? "" : "s");
        break;
    case TL_VALUE_FLAT: snprintf(text, size, "a list of rows of 2 numbers"); break;
    case TL_VALUE_OTHER:
    default: snprintf(text, size, "a %.100s", value->text ? value->text : "value of another type"); break;
    }
}

static tl_status wrong_type(const reader *r, const char *wanted)
{
    char given[160];
    describe_value(r->value, given, sizeof given);
    return tl_fail(r->error, TL_E_ARGUMENT, "%s%s must be %s, not %s", r->prefix, r->param.name, wanted, given);
}

/* One number of a value: `part` names it ("friction", "origin.y", "vertices, row 4, y"). */
static tl_status check_number(const reader *r, const char *part, double value)
{
    if (tl_param_in_range(&r->param, value))
        return TL_OK;
    char number[TL_NUMBER_TEXT], range[TL_RANGE_TEXT];
    tl_number_text(value, number);
    if (!isfinite(value))
        return tl_fail(r->error, TL_E_ARGUMENT, "%s%s = %s is not a finite number", r->prefix, part, number);
    tl_param_range(&r->param, range, sizeof range);
    const char *unit = r->param.unit ? r->param.unit : "", *space = unit[0] ? " " : "";
    const char *verb = range[0] == '[' || range[0] == '(' ? "is outside" : "must be";
    return tl_fail(r->error, TL_E_ARGUMENT, "%s%s = %s%s%s %s %s", r->prefix, part, number, space, unit, verb, range);
}

static tl_status check_point(const reader *r, const char *part, const char *joiner, const double *at)
{
    static const char component[3] = {'x', 'y', 'z'};
    for (int i = 0; i < 3; i++) {
        char name[120];
        snprintf(name, sizeof name, "%.80s%s%c", part, joiner, component[i]);
        tl_status status = check_number(r, name, at[i]);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

static tl_status read_real(const reader *r, void *to)
{
    if (r->value->type != TL_VALUE_NUMBER)
        return wrong_type(r, "a number");
    tl_status status = check_number(r, r->param.name, r->value->number);
    if (status == TL_OK)
        memcpy(to, &r->value->number, sizeof(double));
    return status;
}

static tl_status read_int(const reader *r, void *to)
{
    double number = r->value->number;
    if (r->value->type != TL_VALUE_NUMBER)
        return wrong_type(r, "a whole number");
    tl_status status = check_number(r, r->param.name, number);
    if (status != TL_OK)
        return status;
    if (floor(number) < number || number < -INT_LIMIT || number >= INT_LIMIT)
        return wrong_type(r, "a whole number");
    int64_t whole = (int64_t)number;
    memcpy(to, &whole, sizeof whole);
    return TL_OK;
}

static tl_status read_bool(const reader *r, void *to)
{
    if (r->value->type != TL_VALUE_BOOL)
        return wrong_type(r, "true or false");
    int32_t truth = r->value->number > 0;
    memcpy(to, &truth, sizeof truth);
    return TL_OK;
}

static tl_status read_enum(const reader *r, void *to)
{
    if (r->value->type != TL_VALUE_STRING)
        return wrong_type(r, "a name in quotes");
    size_t count = 0;
    for (; r->param.choices[count]; count++) {
        if (strcmp(r->param.choices[count], r->value->text) == 0) {
            int32_t index = (int32_t)count;
            memcpy(to, &index, sizeof index);
            return TL_OK;
        }
    }
    return tl_fail_unknown(r->error, TL_E_ARGUMENT, r->prefix, r->param.name, r->value->text, r->param.choices, count);
}

static tl_status read_vec3(const reader *r, void *to)
{
    if (r->value->type != TL_VALUE_NUMBERS || r->value->count != 3)
        return wrong_type(r, "a list of 3 numbers {x, y, z}");
    tl_status status = check_point(r, r->param.name, ".", r->value->data);
    tl_vec3 v = {r->value->data[0], r->value->data[1], r->value->data[2]};
    if (status == TL_OK)
        memcpy(to, &v, sizeof v);
    return status;
}

static tl_status read_string(const reader *r, void *to)
{
    if (r->value->type != TL_VALUE_STRING)
        return wrong_type(r, "a string");
    memcpy(to, &r->value->text, sizeof r->value->text);
    return TL_OK;
}

static tl_status read_points(const reader *r, void *to)
{
    /* An empty list of points cannot be told from an empty list of numbers. */
    bool empty = r->value->type == TL_VALUE_NUMBERS && r->value->count == 0;
    bool flat = r->param.flags & TL_PARAM_FLAT;
    if (r->value->type != (flat ? TL_VALUE_FLAT : TL_VALUE_POINTS) && !empty)
        return wrong_type(r, flat ? "a list of points in a plane, two numbers each, {{1, 2}, ...}"
                                  : "a list of points {{x, y, z}, ...}");
    for (size_t i = 0; i < r->value->count; i++) {
        char part[120];
        snprintf(part, sizeof part, "%.60s, row %zu", r->param.name, i + 1);
        tl_status status = check_point(r, part, ", ", r->value->data + 3 * i);
        if (status != TL_OK)
            return status;
    }
    tl_points points = {(const tl_vec3 *)(const void *)r->value->data, r->value->count};
    memcpy(to, &points, sizeof points);
    return TL_OK;
}

static tl_status read_value(const reader *r, void *to)
{
    switch (r->param.type) {
    case TL_PARAM_REAL: return read_real(r, to);
    case TL_PARAM_INT: return read_int(r, to);
    case TL_PARAM_BOOL: return read_bool(r, to);
    case TL_PARAM_ENUM: return read_enum(r, to);
    case TL_PARAM_VEC3: return read_vec3(r, to);
    case TL_PARAM_STRING: return read_string(r, to);
    case TL_PARAM_POINTS: return read_points(r, to);
    default:
        return tl_fail(r->error, TL_E_PLUGIN, "%sparameter '%s' has the unknown type %u", r->prefix, r->param.name,
                       r->param.type);
    }
}

static void write_default(const tl_param *param, void *to)
{
    bool none = param->flags & (TL_PARAM_OPTIONAL | TL_PARAM_REQUIRED);
    double real = none ? NAN : param->def[0];
    int64_t whole = param->type == TL_PARAM_INT ? (int64_t)param->def[0] : 0;
    int32_t small = param->type == TL_PARAM_BOOL || param->type == TL_PARAM_ENUM ? (int32_t)param->def[0] : 0;
    tl_vec3 v = {none ? NAN : param->def[0], none ? NAN : param->def[1], none ? NAN : param->def[2]};
    const char *text = none ? NULL : param->def_text;
    tl_points points = {NULL, 0};
    switch (param->type) {
    case TL_PARAM_REAL: memcpy(to, &real, sizeof real); break;
    case TL_PARAM_INT: memcpy(to, &whole, sizeof whole); break;
    case TL_PARAM_BOOL:
    case TL_PARAM_ENUM: memcpy(to, &small, sizeof small); break;
    case TL_PARAM_VEC3: memcpy(to, &v, sizeof v); break;
    case TL_PARAM_STRING: memcpy(to, &text, sizeof text); break;
    default: memcpy(to, &points, sizeof points); break;
    }
}

static bool answers_to(const tl_param *param, const char *key)
{
    return strcmp(param->name, key) == 0 || (param->alias && strcmp(param->alias, key) == 0);
}

/* Index of the parameter a key means, or `count`. */
static size_t find_param(const tl_param *params, size_t count, size_t stride, const char *key)
{
    for (size_t i = 0; i < count; i++) {
        tl_param row = tl_param_row(params, i, stride);
        if (answers_to(&row, key))
            return i;
    }
    return count;
}

static tl_status unknown_key(const tl_param *params, size_t count, size_t stride, const char *key, const char *prefix,
                             tl_error *error)
{
    const char *names[MOST_NAMES];
    size_t n = 0;
    for (size_t i = 0; i < count && n + 1 < MOST_NAMES; i++) {
        tl_param row = tl_param_row(params, i, stride);
        names[n++] = row.name;
        if (row.alias)
            names[n++] = row.alias;
    }
    if (n == 0)
        return tl_fail(error, TL_E_ARGUMENT, "%sunknown parameter '%.80s' (it takes none)", prefix, key);
    return tl_fail_unknown(error, TL_E_ARGUMENT, prefix, "parameter", key, names, n);
}

/* Whether two values are the same number. */
static bool same_number(const tl_value *a, const tl_value *b)
{
    return a->type == TL_VALUE_NUMBER && b->type == TL_VALUE_NUMBER && a->number <= b->number && a->number >= b->number;
}

/* The same parameter given twice, by its name and by its alias, and not with the same number. */
static tl_status check_once(const tl_param *param, const tl_args *args, size_t index, const char *prefix,
                            tl_error *error)
{
    for (size_t i = 0; i < index; i++)
        if (answers_to(param, args->values[i].key) && !same_number(&args->values[i], &args->values[index]))
            return tl_fail(error, TL_E_ARGUMENT, "%s%s and %s are the same parameter: give one of them", prefix,
                           args->values[i].key, args->values[index].key);
    return TL_OK;
}

static tl_status check_required(const tl_param *param, const tl_args *args, const char *prefix, tl_error *error)
{
    if (!(param->flags & TL_PARAM_REQUIRED))
        return TL_OK;
    for (size_t i = 0; args && i < args->count; i++)
        if (answers_to(param, args->values[i].key))
            return TL_OK;
    const char *unit = param->unit ? param->unit : "";
    return tl_fail(error, TL_E_ARGUMENT, "%sparameter '%s' is missing%s%s%s%s%.160s", prefix, param->name,
                   unit[0] ? ", in " : "", unit, param->doc ? " (" : "", param->doc ? param->doc : "",
                   param->doc ? ")" : "");
}

tl_status tl_args_read(const tl_param *params, size_t count, size_t stride, const tl_args *args, bool keep, void *out,
                       const char *context, tl_error *error)
{
    char prefix[TL_ERROR_TEXT] = "";
    if (context && context[0])
        snprintf(prefix, sizeof prefix, "%s: ", context);
    for (size_t i = 0; i < count && !keep; i++) {
        tl_param row = tl_param_row(params, i, stride);
        write_default(&row, (char *)out + row.offset);
    }
    for (size_t i = 0; args && i < args->count; i++) {
        const char *key = args->values[i].key;
        size_t at = find_param(params, count, stride, key);
        if (at == count)
            return unknown_key(params, count, stride, key, prefix, error);
        reader r = {tl_param_row(params, at, stride), &args->values[i], prefix, error};
        tl_status status = check_once(&r.param, args, i, prefix, error);
        if (status == TL_OK)
            status = read_value(&r, (char *)out + r.param.offset);
        if (status != TL_OK)
            return status;
    }
    for (size_t i = 0; i < count && !keep; i++) {
        tl_param row = tl_param_row(params, i, stride);
        tl_status status = check_required(&row, args, prefix, error);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

/* Whether the table has a number of the argument that is neither 0 nor of a size that a property may have. */
static bool is_disproportionate(const tl_param *param, const tl_value *value)
{
    const double size = fabs(value->number);
    return param->type == TL_PARAM_REAL && size != 0 && !(size >= TL_LEAST_PROPERTY && size <= TL_MOST_PROPERTY);
}

tl_status tl_args_proportion(const tl_param *params, size_t count, size_t stride, const tl_args *args,
                             const char *context, tl_error *error)
{
    for (size_t i = 0; args && i < args->count; i++) {
        const tl_value *value = &args->values[i];
        const size_t at = find_param(params, count, stride, value->key);
        const tl_param row = at < count ? tl_param_row(params, at, stride) : (tl_param){.type = TL_PARAM_BOOL};
        if (!is_disproportionate(&row, value))
            continue;
        char number[TL_NUMBER_TEXT];
        tl_number_text(value->number, number);
        const char *unit = row.unit ? row.unit : "", *space = unit[0] ? " " : "";
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: %s = %s%s%s is out of all proportion: give %sa size from %g to %g, or check the units",
                       context, row.name, number, space, unit, tl_param_in_range(&row, 0) ? "0 or " : "",
                       TL_LEAST_PROPERTY, TL_MOST_PROPERTY);
    }
    return TL_OK;
}
