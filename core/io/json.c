/* json.c - see json.h. */
#include "io/json.h"

#include "base/number.h"

#include <stdio.h>
#include <string.h>

void tl_json_bytes(tl_piece *to, const char *text, size_t length)
{
    unsigned char *at = tl_piece_reserve(to, length);
    if (!at)
        return;
    memcpy(at, text, length);
    to->length += length;
}

void tl_json_put(tl_piece *to, const char *text)
{
    tl_json_bytes(to, text, strlen(text));
}

void tl_json_number(tl_piece *to, double value)
{
    unsigned char *at = tl_piece_reserve(to, TL_NUMBER_TEXT);
    if (at)
        to->length += tl_number_text(value, (char *)at);
}

void tl_json_whole(tl_piece *to, uint32_t value)
{
    char digits[10];
    size_t at = sizeof digits;
    do
        digits[--at] = (char)('0' + value % 10);
    while ((value /= 10) > 0);
    tl_json_bytes(to, digits + at, sizeof digits - at);
}

void tl_json_text(tl_piece *to, const char *text)
{
    tl_json_put(to, "\"");
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        char escaped[8] = {(char)*c, '\0'};
        if (*c == '"' || *c == '\\')
            snprintf(escaped, sizeof escaped, "\\%c", *c);
        else if (*c < ' ')
            snprintf(escaped, sizeof escaped, "\\u%04x", *c);
        tl_json_put(to, escaped);
    }
    tl_json_put(to, "\"");
}
