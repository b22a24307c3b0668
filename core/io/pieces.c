/* pieces.c - see pieces.h.
 *
 * Pieces are small enough to stay in a processor's cache until the system has copied them. There are two sets of
 * them: while one thread writes one set, the others fill the other, and then it helps them. */
#include "io/pieces.h"

#include "base/error.h"
#include "base/parallel.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a piece, about. */
#define PIECE_BYTES 65536

/* One batch: item 0 writes the pieces of the batch before, the items after it fill one piece each. */
typedef struct batch {
    tl_piece *full, *empty;
    tl_output *output;
    size_t first, rows, each; /* rows: of all batches */
    tl_piece_fn fn;
    const void *user;
} batch;

unsigned char *tl_piece_reserve(tl_piece *piece, size_t bytes)
{
    if (!piece->data || piece->length + bytes > piece->capacity) {
        size_t capacity = piece->capacity ? piece->capacity : PIECE_BYTES;
        while (capacity < piece->length + bytes)
            capacity *= 2;
        unsigned char *data = piece->failed ? NULL : realloc(piece->data, capacity);
        if (!data) {
            piece->failed = true;
            return NULL;
        }
        piece->data = data;
        piece->capacity = capacity;
    }
    return piece->data + piece->length;
}

unsigned char *tl_piece_add(tl_piece *piece, size_t bytes)
{
    unsigned char *to = tl_piece_reserve(piece, bytes);
    piece->length += to ? bytes : 0;
    return to;
}

void tl_piece_put(tl_piece *piece, const void *from, size_t bytes)
{
    unsigned char *to = tl_piece_add(piece, bytes);
    if (to)
        memcpy(to, from, bytes);
}

static void write_out(tl_piece *pieces, tl_output *output)
{
    for (size_t i = 0; i < TL_PIECES; i++) {
        tl_output_put(output, pieces[i].data, pieces[i].length);
        pieces[i].length = 0;
    }
}

static void work(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)end, (void)chunk, (void)thread;
    const batch *b = user;
    if (begin == 0) {
        write_out(b->full, b->output);
        return;
    }
    size_t first = b->first + (begin - 1) * b->each, last = first + b->each;
    b->fn(b->user, first, last < b->rows ? last : b->rows, &b->empty[begin - 1]);
}

tl_status tl_pieces_write(tl_pieces *pieces, size_t rows, size_t bytes, tl_piece_fn fn, const void *user)
{
    batch b = {.output = pieces->output, .rows = rows, .fn = fn, .user = user};
    b.each = bytes < PIECE_BYTES ? PIECE_BYTES / bytes : 1;
    b.full = pieces->piece[0];
    b.empty = pieces->piece[1];
    for (size_t i = 0; i < TL_PIECES; i++)
        b.full[i].length = b.empty[i].length = 0;
    bool failed = false;
    while (b.first < rows && !failed) {
        size_t left = (rows - b.first + b.each - 1) / b.each;
        size_t count = left < TL_PIECES ? left : TL_PIECES;
        tl_parallel_for(pieces->model->pool, 1 + count, 1, work, &b);
        b.first += count * b.each;
        for (size_t i = 0; i < TL_PIECES; i++)
            failed = failed || b.empty[i].failed;
        tl_piece *filled = b.empty;
        b.empty = b.full;
        b.full = filled;
        if (tl_model_go_on(pieces->model) != TL_OK)
            return TL_E_CANCELLED;
    }
    if (failed)
        return tl_fail_memory(&pieces->model->error);
    write_out(b.full, pieces->output);
    return TL_OK;
}

void tl_pieces_free(tl_pieces *pieces)
{
    for (size_t i = 0; i < 2 * TL_PIECES; i++)
        free(pieces->piece[i / TL_PIECES][i % TL_PIECES].data);
    *pieces = (tl_pieces){.model = NULL};
}
