/* checker.c - the parameters a kind is tried with: given, default, plausible by their units, or drawn within their
 * ranges. */
#include "check/checker.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/number.h>

/* Constant: share of the parameters with a default that a drawn set changes. */
#define CHANGED 0.7
/* Tolerance: bounds beyond which a range counts as open. */
#define OPEN 1e12

/* Where the values of a set are, as long as its parameters are used. */
typedef struct param_storage {
    tl_value value;
    tl_vec3 vector;
    tl_vec3 rows[3];
} param_storage;

/* Powers of ten between which a quantity of that unit is drawn. */
static void scale_of(const char *unit, double *low, double *high)
{
    static const struct {
        const char *unit;
        double low, high;
    } known[] = {{"Pa/m", 8, 10}, {"Pa", 4, 6.5},  {"m", -4, -1},  {"N/m", 8, 10}, {"kg/m3", 3, 4},
                 {"1/s", -1, 1},  {"deg", 0, 1.6}, {"m/s", -3, 0}, {"J/m2", 0, 4}, {"s", -4, 0}};
    bool power = strncmp(unit, "Pa^", 3) == 0; /* stiffness at 1 Pa, to a power of the stress */
    *low = power ? 6 : -2;
    *high = power ? 10 : 0.5;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i].unit, unit) == 0) {
            *low = known[i].low;
            *high = known[i].high;
        }
}

/* A number within the parameter's range; the middle of what is drawn when `drawn` is false. */
static double number_of(const tl_param *p, uint64_t key, bool draw)
{
    double low, high;
    bool ranged = p->min != 0 || p->max != 0;
    scale_of(p->unit ? p->unit : "", &low, &high);
    double at = draw ? tl_uniform(key) : 0.5;
    double size = tl_check_scale(0, low + at * (high - low), low + at * (high - low));
    if (!ranged)
        return size;
    if (p->min > -OPEN && p->max < OPEN)
        /* not the ends, which may be open; the lower part of a wide range of numbers of things */
        return p->min + (0.05 + 0.9 * at) * fmin(p->max - p->min, p->type == TL_PARAM_INT ? 20 : OPEN);
    if (p->min > -OPEN)
        return p->min + size;
    return p->max < OPEN ? p->max - size : size;
}

static double choice_of(const tl_param *p, uint64_t key)
{
    int count = 0;
    while (p->choices && p->choices[count])
        count++;
    return floor(tl_uniform(key) * count);
}

/* A table of three rows over strains, from 0 on. */
static void make_table(const tl_param *p, uint64_t key, bool draw, param_storage *d)
{
    double strain = draw ? tl_check_scale(tl_key(key, 20), -4, -1) : 0.01;
    for (int k = 0; k < 3; k++)
        d->rows[k] = tl_v3(k * strain, number_of(p, tl_key(key, 21 + (uint64_t)k), draw), 0);
    d->value = tl_arg_numbers(p->name, &d->rows[0].x, 3);
    d->value.type = TL_VALUE_FLAT;
}

/* A plausible value. `vectors` counts those of a set: the first is the origin, the second the other corner of a
 * cube. */
static void make(const tl_param *p, uint64_t key, bool draw, int *vectors, param_storage *d)
{
    static const double corners[] = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2};
    double number = number_of(p, key, draw);
    switch (p->type) {
    case TL_PARAM_BOOL: d->value = tl_arg_bool(p->name, tl_uniform(key) < 0.5); break;
    case TL_PARAM_INT: d->value = tl_arg_number(p->name, floor(number) + 1); break;
    case TL_PARAM_ENUM: d->value = tl_arg_text(p->name, p->choices[(int)choice_of(p, key)]); break;
    case TL_PARAM_VEC3:
        number = 2.0 * (*vectors)++;
        d->vector = draw ? tl_check_direction(key) : tl_v3(number, number, number);
        d->value = tl_arg_numbers(p->name, &d->vector.x, 3);
        break;
    case TL_PARAM_STRING: d->value = tl_arg_text(p->name, "check"); break;
    case TL_PARAM_POINTS:
        if (p->flags & TL_PARAM_FLAT) {
            make_table(p, key, draw, d);
            break;
        }
        d->value = tl_arg_numbers(p->name, corners, 4);
        d->value.type = TL_VALUE_POINTS;
        break;
    default: d->value = tl_arg_number(p->name, number); break;
    }
}

static const tl_value *given_value(const tl_args *args, const tl_param *p)
{
    for (size_t i = 0; args && i < args->count; i++)
        if (strcmp(args->values[i].key, p->name) == 0 || (p->alias && strcmp(args->values[i].key, p->alias) == 0))
            return &args->values[i];
    return NULL;
}

bool tl_check_asked(const tl_checker *c, uint32_t param)
{
    return !c->args || c->args->count == 0 || given_value(c->args, &c->kind->params[param]);
}

static void add_text(tl_checker *c, const tl_value *v)
{
    size_t used = strlen(c->params_text), free_bytes = sizeof c->params_text - used;
    char *to = c->params_text + used;
    const char *comma = used ? ", " : "";
    if (v->type == TL_VALUE_NUMBER)
        tl_text_print(to, free_bytes, "%s%s = %.6g", comma, v->key, v->number);
    else if (v->type == TL_VALUE_BOOL)
        snprintf(to, free_bytes, "%s%s = %s", comma, v->key, v->number != 0 ? "true" : "false");
    else if (v->type == TL_VALUE_STRING)
        snprintf(to, free_bytes, "%s%s = %s", comma, v->key, v->text);
}

/* The other choice of one that has a few, or another value of the range. */
static void make_other(const tl_param *p, uint64_t key, int *vectors, const tl_value *was, param_storage *d)
{
    make(p, tl_key(key, 3), true, vectors, d);
    if (p->type == TL_PARAM_BOOL)
        d->value = tl_arg_bool(p->name, was ? was->number == 0 : p->def[0] == 0);
    for (int k = 0; p->type == TL_PARAM_ENUM && k < 20; k++) {
        const char *had = was ? was->text : p->choices[(int)p->def[0]];
        if (strcmp(d->value.text, had) != 0)
            break;
        make(p, tl_key(key, 4 + (uint64_t)k), true, vectors, d);
    }
}

tl_status tl_check_values(tl_checker *c, int set, int varied, tl_value **values, size_t *count, void **held)
{
    const tl_kind *kind = c->kind;
    param_storage *all = calloc(kind->param_count + 1, sizeof *all);
    int vectors = 0;
    *count = 0;
    *held = all;
    *values = calloc(kind->param_count + 1, sizeof **values);
    if (!all || !*values)
        return tl_fail_memory(c->error);
    c->set = set;
    c->params_text[0] = '\0';
    for (uint32_t i = 0; i < kind->param_count; i++) {
        const tl_param *p = &kind->params[i];
        const tl_value *given = given_value(c->args, p);
        uint64_t key = tl_key(tl_key_text((uint64_t)set, kind->name), i);
        bool draw = set > 0, required = (p->flags & TL_PARAM_REQUIRED) != 0;
        bool changed = draw && tl_uniform(tl_key(key, 1)) < CHANGED;
        if (given)
            all[i].value = *given;
        else if (required ? !(p->flags & TL_PARAM_FILE) : changed)
            make(p, tl_key(key, 2), draw, &vectors, &all[i]);
        if ((int)i == varied) {
            const tl_value was = all[i].value;
            make_other(p, key, &vectors, was.key ? &was : NULL, &all[i]);
        }
        if (!all[i].value.key)
            continue;
        (*values)[(*count)++] = all[i].value;
        add_text(c, &all[i].value);
    }
    return TL_OK;
}

tl_status tl_check_params(tl_checker *c, int set, int varied, void *params, void **held)
{
    const tl_kind *kind = c->kind;
    char context[160];
    tl_value *values;
    size_t count;
    tl_status status = tl_check_values(c, set, varied, &values, &count, held);
    snprintf(context, sizeof context, "'%s' cannot be tried", kind->name);
    memset(params, 0, kind->params_size);
    const tl_args args = {values, count};
    if (status == TL_OK)
        status =
            tl_args_read(kind->params, kind->param_count, kind->param_stride, &args, false, params, context, c->error);
    free(values);
    return status;
}

tl_status tl_check_create(tl_checker *c, tl_status (*create)(const void *, void **, tl_report *), void *params,
                          void **self)
{
    tl_report report = {.size = sizeof report};
    *self = create ? NULL : params;
    tl_status status = create ? create(params, self, &report) : TL_OK;
    if (status != TL_OK)
        tl_fail(c->error, status, "'%s' cannot be tried: %s", c->kind->name, tl_report_text(&report, status));
    return status;
}

tl_status tl_check_sets(tl_checker *c, tl_status (*try_set)(tl_checker *c, void *params, void *user), void *user)
{
    void *params = malloc(c->kind->params_size + 1), *held;
    int tried = 0, most = 200 * TL_CHECK_SETS; /* kinds refuse some drawn sets */
    tl_status status = params ? TL_OK : tl_fail_memory(c->error);
    for (int set = 0; status == TL_OK && set < most && tried < TL_CHECK_SETS; set++) {
        tl_status now = tl_check_params(c, set, TL_CHECK_NONE, params, &held);
        if (now == TL_OK)
            now = try_set(c, params, user);
        free(held);
        tried += now == TL_OK;
        /* what is wrong with values that the user has given is to be told */
        if (now == TL_E_MEMORY || (set == 0 && c->args && c->args->count > 0))
            status = now;
    }
    free(params);
    /* with the sentence of the last attempt */
    return status == TL_OK && tried == 0 ? TL_E_ARGUMENT : status;
}

/* ---------------------------------------------------------------- draws -------------------
 *
 * Faults found, and random numbers for what kinds are tried with. */

void tl_check_note(tl_checker *c, int check, const char *format, ...)
{
    char *text = c->fault[check];
    size_t size = sizeof c->fault[check];
    if (tl_check_failed(c, check))
        return;
    va_list list;
    va_start(list, format);
    tl_text_vprint(text, size, format, list);
    va_end(list);
    size_t used = strlen(text);
    if (c->params_text[0])
        snprintf(text + used, size - used, " (with %s)", c->params_text);
}

double tl_check_scale(uint64_t key, double low, double high)
{
    double power = tl_check_between(key, low, high) * 3.32192809488736235, whole = floor(power);
    return ldexp(1 + (power - whole), (int)whole); /* 2^power, within 9 % */
}

tl_vec3 tl_check_direction(uint64_t key)
{
    double z = tl_check_between(tl_key(key, 1), -1, 1);
    double turn = tl_check_between(tl_key(key, 2), 0, 6.28318530717958648);
    double across = sqrt(fmax(0, 1 - z * z));
    return tl_v3(across * tl_cos(turn), across * tl_sin(turn), z);
}

double tl_check_nobodys(int column, bool other)
{
    static const double numbers[] = {1.375e-9, -3.25e-4, 0.8125, -4.75e5, 6.5e-2, -1.5};
    double number = numbers[(size_t)column % (sizeof numbers / sizeof *numbers)];
    return other ? -1.25e-3 * number : number;
}

void tl_check_fill(const tl_check_batch *b, double *column, const double *from, double padding, double nobodys)
{
    size_t i = 0;
    for (; from && i < b->count; i++)
        column[i] = from[tl_check_entry(b, i)];
    for (; from && i < b->padded; i++)
        column[i] = padding;
    for (; i < b->end; i++)
        column[i] = nobodys;
}
