/* json.h - JSON, put at the end of a piece: pieces.h. */
#ifndef TL_IO_JSON_H
#define TL_IO_JSON_H

#include "io/pieces.h"

/* As it is. */
void tl_json_put(tl_piece *to, const char *text);
/* The format as it is, but for %s, %g, %u, %v and %r. A text by %s is in quotes and escaped, and what is no UTF-8 in
 * it becomes the replacement character. A double by %g has the digits that give back the same one. A uint32_t goes by
 * %u, a tl_vec3 as a list by %v, and a text as it is by %r. */
void tl_json_print(tl_piece *to, const char *format, ...);

#endif
