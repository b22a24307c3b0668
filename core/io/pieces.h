/* pieces.h - long lists of a file, prepared in pieces by several threads and written in order.
 *
 * Which rows make a piece does not depend on the number of threads, nor what is written. */
#ifndef TL_IO_PIECES_H
#define TL_IO_PIECES_H

#include "base/output_file.h"
#include "model/model.h"

/* Pieces that are prepared while as many are written. */
#define TL_PIECES 8

/* Bytes that are to be written, and room for more. */
typedef struct tl_piece {
    unsigned char *data;
    size_t length, capacity;
    bool failed; /* out of memory */
} tl_piece;

typedef struct tl_pieces {
    tl_model *model;
    tl_output *output;
    tl_piece piece[2][TL_PIECES];
} tl_pieces;

/* Room for `bytes` at the end of the piece; who writes there adds to its length. NULL: out of memory, which the piece
 * notes. */
unsigned char *tl_piece_reserve(tl_piece *piece, size_t bytes);

/* The same, of bytes that are part of the piece at once. */
unsigned char *tl_piece_add(tl_piece *piece, size_t bytes);

/* Puts bytes that there are at the end of the piece. */
void tl_piece_put(tl_piece *piece, const void *from, size_t bytes);

/* Puts what rows [begin, end) are in the file at the end of the piece; on any thread. */
typedef void (*tl_piece_fn)(const void *user, size_t begin, size_t end, tl_piece *piece);

/* Writes `rows` rows of about `bytes` each to the output. The disk's errors stay in the output: output_file.h. */
tl_status tl_pieces_write(tl_pieces *pieces, size_t rows, size_t bytes, tl_piece_fn fn, const void *user);
void tl_pieces_free(tl_pieces *pieces);

#endif
