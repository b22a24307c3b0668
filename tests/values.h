/* values.h - named values for generators, as a script would give them. */
#ifndef TALUS_TESTS_VALUES_H
#define TALUS_TESTS_VALUES_H

#include <stdio.h>
#include <talus/values.h>

static inline tl_value number(const char *key, double value)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBER, .number = value};
}

static inline tl_value text(const char *key, const char *value)
{
    return (tl_value){.key = key, .type = TL_VALUE_STRING, .text = value};
}

static inline tl_value vector(const char *key, const double *data)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBERS, .data = data, .count = 3};
}

/* The last remark that a generator has made, for tl_model_set_log. */
static char remark[512];

static inline void keep_remark(void *user, const char *line)
{
    (void)user;
    snprintf(remark, sizeof remark, "%s", line);
}

#endif
