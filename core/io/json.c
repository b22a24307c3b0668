/* json.c - see json.h. */
#include "io/json.h"

#include "base/number.h"
#include "io/pieces.h"

#include <stdio.h>
#include <string.h>
#include <talus/text.h>

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

void tl_json_text(tl_piece *to, const char *text)
{
    tl_json_put(to, "\"");
    while (*text) {
        size_t bytes = tl_utf8_next(text);
        if (bytes > 1) {
            tl_json_bytes(to, text, bytes);
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
