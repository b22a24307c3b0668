/* json.c - see json.h. */
#include "io/json.h"

#include "base/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <talus/text.h>

void tl_json_put(tl_piece *to, const char *text)
{
    tl_piece_put(to, text, strlen(text));
}

static void put_number(tl_piece *to, double value)
{
    unsigned char *at = tl_piece_reserve(to, TL_NUMBER_TEXT);
    if (at)
        to->length += tl_number_text(value, (char *)at);
}

static void put_whole(tl_piece *to, uint32_t value)
{
    char digits[10];
    size_t at = sizeof digits;
    do
        digits[--at] = (char)('0' + value % 10);
    while ((value /= 10) > 0);
    tl_piece_put(to, digits + at, sizeof digits - at);
}

/* A byte of a text, escaped where JSON wants it. */
static void put_letter(tl_piece *to, unsigned char letter)
{
    char escaped[8] = {(char)letter, '\0'};
    if (letter == '"' || letter == '\\')
        snprintf(escaped, sizeof escaped, "\\%c", letter);
    else if (letter < ' ')
        snprintf(escaped, sizeof escaped, "\\u%04x", letter);
    tl_json_put(to, escaped);
}

static void put_text(tl_piece *to, const char *text)
{
    tl_json_put(to, "\"");
    while (*text) {
        size_t bytes = tl_utf8_next(text);
        if (bytes > 1) {
            tl_piece_put(to, text, bytes);
        } else if (bytes == 0) {
            tl_json_put(to, "\\ufffd");
            bytes = 1;
        } else {
            put_letter(to, (unsigned char)*text);
        }
        text += bytes;
    }
    tl_json_put(to, "\"");
}

void tl_json_print(tl_piece *to, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    for (const char *next; (next = strchr(format, '%')) != NULL; format = next + 2) {
        tl_piece_put(to, format, (size_t)(next - format));
        switch (next[1]) {
        case 's': put_text(to, va_arg(args, const char *)); break;
        case 'g': put_number(to, va_arg(args, double)); break;
        case 'u': put_whole(to, va_arg(args, uint32_t)); break;
        case 'r': tl_json_put(to, va_arg(args, const char *)); break;
        default: {
            const tl_vec3 v = va_arg(args, tl_vec3);
            tl_json_print(to, "[%g, %g, %g]", v.x, v.y, v.z);
        }
        }
    }
    va_end(args);
    tl_json_put(to, format);
}
