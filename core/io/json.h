/* json.h - JSON, put at the end of a piece: pieces.h. */
#ifndef TL_IO_JSON_H
#define TL_IO_JSON_H

#include "io/pieces.h"

/* As it is. */
void tl_json_bytes(tl_piece *to, const char *text, size_t length);
void tl_json_put(tl_piece *to, const char *text);
/* With the digits that give back the same double. */
void tl_json_number(tl_piece *to, double value);
void tl_json_whole(tl_piece *to, uint32_t value);
/* In quotes, escaped as JSON wants it; what is no UTF-8 becomes the replacement character. */
void tl_json_text(tl_piece *to, const char *text);

#endif
