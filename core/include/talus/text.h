/* text.h - texts as people see them: what is UTF-8, and names in a sentence. */
#ifndef TALUS_TEXT_H
#define TALUS_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Bytes of the first letter of a text that is not empty and ends in a 0; 0 when it is none of UTF-8: cut off, longer
 * than it need be, half of a pair or beyond the last one. */
static inline size_t tl_utf8_next(const char *text)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *c = (const unsigned char *)text;
    size_t bytes = *c < 0x80 ? 1 : *c < 0xc0 ? 0 : *c < 0xe0 ? 2 : *c < 0xf0 ? 3 : *c < 0xf8 ? 4 : 0;
    unsigned code = bytes > 1 ? *c & (0x7fu >> bytes) : *c;
    for (size_t i = 1; i < bytes; i++) {
        if ((c[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (c[i] & 0x3fu);
    }
    return code < least[bytes] || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff ? 0 : bytes;
}

static inline bool tl_text_is_utf8(const char *text)
{
    for (size_t bytes; *text; text += bytes)
        if ((bytes = tl_utf8_next(text)) == 0)
            return false;
    return true;
}

/* Bytes of the first letter of a text when a line for people can have it; 0 of what is no UTF-8, and of control
 * characters (of ASCII, and U+0080 to U+009F). Those may end the line or hold a terminal's codes. */
static inline size_t tl_text_shown(const char *text)
{
    unsigned char first = (unsigned char)*text;
    bool control = first < ' ' || first == 0x7f || (first == 0xc2 && (unsigned char)text[1] < 0xa0);
    return control ? 0 : tl_utf8_next(text);
}

/* Whether tl_text_clean has nothing to do. */
static inline bool tl_text_is_clean(const char *text)
{
    for (size_t bytes; *text; text += bytes)
        if ((bytes = tl_text_shown(text)) == 0)
            return false;
    return true;
}

/* Makes one line for people of the text in `size` bytes: what cannot be shown becomes \n, \t, \r, or \x1b and the like
 * for each byte. What then has no room is cut off at the end. */
static inline void tl_text_clean(char *text, size_t size)
{
    static const char digits[] = "0123456789abcdef";
    for (char *at = text; *at;) {
        size_t bytes = tl_text_shown(at);
        if (bytes > 0) {
            at += bytes;
            continue;
        }
        unsigned char byte = (unsigned char)*at;
        char named = byte == '\n' ? 'n' : byte == '\t' ? 't' : byte == '\r' ? 'r' : '\0';
        const char escape[4] = {'\\', named ? named : 'x', digits[byte >> 4], digits[byte & 15]};
        size_t length = named ? 2 : 4, room = size - 1 - (size_t)(at - text);
        if (length > room) {
            *at = '\0';
            return;
        }
        size_t rest = strlen(at + 1);
        rest = rest < room - length ? rest : room - length;
        memmove(at + length, at + 1, rest);
        at[length + rest] = '\0';
        memcpy(at, escape, length);
        at += length;
    }
}

#endif
