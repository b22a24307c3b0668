/* draw.c - faults found, and random numbers for what kinds are tried with. */
#include "check/check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/number.h>

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
