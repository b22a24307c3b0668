/* number.h - the one reader and the one writer of numbers as text. Neither depends on the locale of the process, which
 * may have a decimal comma.
 *
 * The reader gives the C library no decimal point: it writes 12.5e300 as 125e299 and hands that to strtod, which rounds
 * to the nearest double. The writer hands one conversion after the other to snprintf. In the text of a floating one,
 * whatever is neither digit, letter, sign nor space is the locale's decimal point, and becomes '.'.
 *
 * Both are functions of their arguments alone: they may be called by several threads, and while the locale changes.
 * They need no memory. */
#ifndef TALUS_NUMBER_H
#define TALUS_NUMBER_H

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/plugin.h>

/* ---------------------------------------------------------------- reading ---------------- */

/* Digits that decide how a decimal number is rounded to a double: half-way between two doubles there are at most 767.
 * Of what follows only counts whether it is zero. */
#define TL_DECIMAL_DIGITS 800
/* Exponents of ten are read up to this; all that is beyond is zero or infinite, with any number of digits that fits
 * into memory. */
#define TL_DECIMAL_EXPONENT 1000000000000000

/* Reads an exponent such as e-3 at `text`, if there is one; gives the text after it. */
static inline const char *tl_exponent_read(const char *text, long long *exponent)
{
    const char *at = text + 1;
    *exponent = 0;
    if (*text != 'e' && *text != 'E')
        return text;
    int negative = *at == '-';
    at += *at == '-' || *at == '+';
    if (*at < '0' || *at > '9')
        return text;
    for (; *at >= '0' && *at <= '9'; at++)
        if (*exponent < TL_DECIMAL_EXPONENT)
            *exponent = 10 * *exponent + (*at - '0');
    if (negative)
        *exponent = -*exponent;
    return at;
}

/* A decimal number without a point: sign, digits without zeros before them, and a power of ten. */
typedef struct tl_decimal {
    char text[TL_DECIMAL_DIGITS + 32];
    size_t sign, count; /* bytes of the sign, and of sign and digits */
    long long exponent;
} tl_decimal;

/* Takes the number at `text` apart; gives the text after it, or `text` where there is none. */
static inline const char *tl_decimal_read(const char *text, tl_decimal *d)
{
    int digits = 0, point = 0, more = 0;
    long long exponent, shift = 0;
    const char *at = text;
    d->count = 0;
    if (*at == '-' || *at == '+')
        d->text[d->count++] = *at++;
    d->sign = d->count;
    for (; (*at >= '0' && *at <= '9') || (*at == '.' && !point); at++) {
        if (*at == '.') {
            point = 1;
            continue;
        }
        digits = 1;
        shift -= point;
        if (d->count == d->sign && *at == '0')
            continue;
        if (d->count < d->sign + TL_DECIMAL_DIGITS) {
            d->text[d->count++] = *at;
        } else {
            shift++;
            more |= *at != '0';
        }
    }
    if (!digits)
        return text;
    at = tl_exponent_read(at, &exponent);
    if (more) {
        d->text[d->count++] = '1';
        shift--;
    }
    d->exponent = exponent + shift;
    return at;
}

/* The double nearest to a decimal number. Whole numbers of up to 15 digits and powers of ten up to 22 are doubles. IEEE
 * 754 rounds their product or quotient as it should be; others are left to strtod. */
static inline double tl_decimal_value(tl_decimal *d)
{
    static const double tens[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                  1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    if (FLT_EVAL_METHOD == 0 && d->count - d->sign <= 15 && d->exponent >= -22 && d->exponent <= 22) {
        long long whole = 0;
        for (size_t i = d->sign; i < d->count; i++)
            whole = 10 * whole + (d->text[i] - '0');
        double value = (double)whole;
        value = d->exponent < 0 ? value / tens[-d->exponent] : value * tens[d->exponent];
        return d->sign && d->text[0] == '-' ? -value : value;
    }
    if (d->count == d->sign)
        d->text[d->count++] = '0';
    unsigned long long power = (unsigned long long)(d->exponent < 0 ? -d->exponent : d->exponent);
    char digits[24], *end = d->text + d->count;
    size_t n = 0;
    do
        digits[n++] = (char)('0' + power % 10);
    while ((power /= 10) > 0);
    *end++ = 'e';
    *end++ = d->exponent < 0 ? '-' : '+';
    while (n > 0)
        *end++ = digits[--n];
    *end = '\0';
    return strtod(d->text, NULL);
}

/* The number that `text` begins with: a sign, digits with or without a point, an exponent; or nan or inf. No spaces, no
 * hexadecimal digits. *end, unless NULL, is what follows, or `text` where there is no number. Too large a number is
 * infinite. */
static inline double tl_number_read(const char *text, const char **end)
{
    tl_decimal d;
    size_t sign = *text == '-' || *text == '+';
    if (text[sign] && strchr("iInN", text[sign])) {
        char *after;
        double word = strtod(text, &after);
        if (end)
            *end = after;
        return word;
    }
    const char *after = tl_decimal_read(text, &d);
    if (end)
        *end = after;
    return after == text ? 0 : tl_decimal_value(&d);
}

/* ---------------------------------------------------------------- writing ---------------- */

/* Bytes of the longest text of one floating conversion: the 309 digits of the largest double, and as many as anybody
 * wants behind the point. Longer ones are cut off. */
#define TL_DECIMAL_TEXT 512

/* What is written, where, and how long it would be where there is room for all. */
typedef struct tl_printer {
    char *to;
    size_t size, length;
} tl_printer;

/* Room that is left. */
static inline size_t tl_printer_room(const tl_printer *p)
{
    return p->length < p->size ? p->size - p->length : 0;
}

static inline void tl_printer_put(tl_printer *p, const char *text, size_t length)
{
    size_t room = tl_printer_room(p);
    if (room > 0)
        memcpy(p->to + p->length, text, length < room ? length : room);
    p->length += length;
}

/* A floating conversion of which snprintf has made `text`. */
static inline void tl_printer_put_decimal(tl_printer *p, char *text)
{
    static const char letters[] = "0123456789+-abcdefinpxABCDEFINPX ";
    size_t before = strspn(text, letters), point = strcspn(text + before, letters);
    if (point > 0) {
        text[before] = '.';
        memmove(text + before + 1, text + before + point, strlen(text + before + point) + 1);
    }
    tl_printer_put(p, text, strlen(text));
}

/* Writes the conversion at `format`, which begins with '%', and goes past its arguments; gives the text after it. */
static inline const char *tl_printer_convert(tl_printer *p, const char *format, va_list *arguments)
{
    char one[40] = "%", decimal[TL_DECIMAL_TEXT];
    size_t n = 1, longs = 0;
    const char *at = format + 1;
    for (; *at && strchr("-+ #0123456789.*", *at) && n < 24; at++) {
        if (*at != '*') {
            one[n++] = *at;
            continue;
        }
        int star = va_arg(*arguments, int);
        if (star < 0 && one[n - 1] == '.')
            n--; /* as if no precision were given */
        else
            n += (size_t)snprintf(one + n, 12, "%d", star);
    }
    char wide = strchr("zjt", *at) ? *at : '\0';
    for (; *at && strchr("hlzjt", *at) && n < 36; at++) {
        longs += *at == 'l';
        one[n++] = *at;
    }
    one[n] = *at;
    one[n + 1] = '\0';
    size_t room = tl_printer_room(p);
    char *to = room > 0 ? p->to + p->length : NULL;
    int length = 0;
    if (!*at || *at == '%') {
        tl_printer_put(p, at, *at == '%');
        return at + (*at == '%');
    }
    if (strchr("eEfFgGaA", *at)) {
        snprintf(decimal, sizeof decimal, one, va_arg(*arguments, double));
        tl_printer_put_decimal(p, decimal);
    } else if (*at == 's' || *at == 'p') {
        length = snprintf(to, room, one, va_arg(*arguments, void *));
    } else if (wide == 'z') {
        length = snprintf(to, room, one, va_arg(*arguments, size_t));
    } else if (wide == 'j') {
        length = snprintf(to, room, one, va_arg(*arguments, intmax_t));
    } else if (wide == 't') {
        length = snprintf(to, room, one, va_arg(*arguments, ptrdiff_t));
    } else if (longs > 1) {
        length = snprintf(to, room, one, va_arg(*arguments, long long));
    } else if (longs == 1) {
        length = snprintf(to, room, one, va_arg(*arguments, long));
    } else {
        length = snprintf(to, room, one, va_arg(*arguments, int));
    }
    p->length += length > 0 ? (size_t)length : 0;
    return at + 1;
}

/* As vsnprintf, for all conversions but those of wide characters, long doubles and %n. */
static inline int tl_text_vprint(char *to, size_t size, const char *format, va_list arguments)
{
    tl_printer p = {to, size, 0};
    va_list rest;
    va_copy(rest, arguments);
    while (*format) {
        size_t plain = strcspn(format, "%");
        tl_printer_put(&p, format, plain);
        format += plain;
        if (*format)
            format = tl_printer_convert(&p, format, &rest);
    }
    va_end(rest);
    if (size > 0)
        to[p.length < size ? p.length : size - 1] = '\0';
    return (int)p.length;
}

/* As snprintf: writes a text and a 0 at its end into `size` bytes; gives the length that it has where there is room. */
TL_PRINTF(3, 4)
static inline int tl_text_print(char *to, size_t size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = tl_text_vprint(to, size, format, arguments);
    va_end(arguments);
    return length;
}

#endif
