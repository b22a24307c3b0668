/* utf8.h - letters of texts in UTF-8. */
#ifndef TL_IO_UTF8_H
#define TL_IO_UTF8_H

#include <stddef.h>

/* Bytes of the first letter of a text that is not empty and ends in a 0; 0 when it is none of UTF-8: cut off, longer than it need be,
 * half of a pair or beyond the last one. */
static inline size_t tl_utf8_next(const char *text)
{
    static const unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char *c = (const unsigned char *)text;
    size_t bytes = *c < 0x80   ? 1
                   : *c < 0xc0 ? 0
                   : *c < 0xe0 ? 2
                   : *c < 0xf0 ? 3
                   : *c < 0xf8 ? 4
                               : 0;
    unsigned code = bytes > 1 ? *c & (0x7fu >> bytes) : *c;
    for (size_t i = 1; i < bytes; i++) {
        if ((c[i] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (c[i] & 0x3fu);
    }
    return code < least[bytes] || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff ? 0 : bytes;
}

#endif
