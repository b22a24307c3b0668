/* pack.h - bytes as text that a browser unpacks: base64 of a zlib stream (pack.c). */
#ifndef TL_IO_PACK_H
#define TL_IO_PACK_H

#include "io/pieces.h"

/* Adds the text of `bytes` bytes to `out`; it does not depend on the number of threads. */
tl_status tl_pack(tl_model *m, const unsigned char *data, size_t bytes, tl_piece *out);

#endif
