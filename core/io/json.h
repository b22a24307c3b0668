/* json.h - JSON, put at the end of a piece: pieces.h. */
#ifndef TL_IO_JSON_H
#define TL_IO_JSON_H

#include "io/pieces.h"

/* As it is. */
void tl_json_bytes(tl_piece *to, const char *text, size_t length);
void tl_json_put(tl_piece *to, const char *text);
/* The format as it is, but for %s, a text in quotes, escaped as JSON wants it, in which what is no UTF-8 becomes the replacement
 * character; %g, a double with the digits that give back the same one; %u, a uint32_t; %v, a tl_vec3 as a list; and %r, a text as
 * it is. */
void tl_json_print(tl_piece *to, const char *format, ...);

#endif
