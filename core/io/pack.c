/* pack.c - zlib (RFC 1950) and base64 (RFC 4648), by several threads.
 *
 * The bytes are divided into pieces, each is compressed for itself and ends at a whole byte, so that the pieces one after
 * the other are one stream. */
#include "io/pack.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* Bytes of a piece, and most that one can become: a stored block of five bytes for each 16 kB, and its end. */
#define PIECE ((size_t)256 << 10)
#define PACKED (PIECE + 5 * (PIECE >> 14) + 64)
/* Bytes whose text a thread writes at a time: a multiple of three, so the texts join. */
#define TEXT_CHUNK ((size_t)3 << 16)

/* Bytes of a piece that are tried, and the share of the length without looking for what repeats above which it is not looked
 * for. */
#define PROBE ((size_t)8 << 10)
#define WORTH 0.9
/* No strategy. */
#define NO_MEMORY (-1)

/* A stream begins with its method (deflate, a window of 32 kB) and level (fastest), and ends with a checksum. */
#define HEAD_BYTES 2
#define SUM_BYTES 4

typedef struct packer {
    const unsigned char *data;
    size_t bytes, pieces;
    unsigned char *packed; /* [pieces * PACKED] */
    size_t *length;        /* [pieces] of each when packed; 0: no memory */
    uLong *sum;            /* [pieces] checksum of each */
} packer;

static size_t piece_bytes(const packer *p, size_t i)
{
    return i + 1 < p->pieces ? PIECE : p->bytes - i * PIECE;
}

/* Compresses bytes into the place of piece i and ends at a whole byte, or ends the stream; how many bytes come of it, or 0
 * when out of memory. */
static size_t compress_bytes(const packer *p, size_t i, const unsigned char *from, size_t bytes,
                             int strategy, int end)
{
    z_stream z = {.next_in = NULL};
    /* Level 1 with a window of 2^15 bytes; the minus leaves out head and checksum. */
    if (deflateInit2(&z, 1, Z_DEFLATED, -15, 8, strategy) != Z_OK)
        return 0;
    z.next_in = (unsigned char *)(uintptr_t)from;
    z.avail_in = (uInt)bytes;
    z.next_out = p->packed + i * PACKED;
    z.avail_out = (uInt)PACKED;
    int code = deflate(&z, end);
    bool good =
        z.avail_in == 0 && z.avail_out > 0 && code == (end == Z_FINISH ? Z_STREAM_END : Z_OK);
    size_t length = good ? PACKED - z.avail_out : 0;
    deflateEnd(&z);
    return length;
}

/* Whether looking for what repeats is worth its time, three times that of coding alone: not in most numbers of moving blocks.
 * A part of the piece tells. NO_MEMORY: nothing does. */
static int strategy_of(const packer *p, size_t i, const unsigned char *from, size_t bytes)
{
    if (bytes < 4 * PROBE)
        return Z_DEFAULT_STRATEGY;
    from += (bytes - PROBE) / 2;
    size_t repeats = compress_bytes(p, i, from, PROBE, Z_DEFAULT_STRATEGY, Z_FINISH);
    size_t codes = compress_bytes(p, i, from, PROBE, Z_RLE, Z_FINISH);
    if (repeats == 0 || codes == 0)
        return NO_MEMORY;
    return (double)repeats > WORTH * (double)codes ? Z_RLE : Z_DEFAULT_STRATEGY;
}

/* Packs one piece; 0 when out of memory. */
static size_t pack_piece(const packer *p, size_t i)
{
    const unsigned char *from = p->data + i * PIECE;
    size_t bytes = piece_bytes(p, i);
    int strategy = strategy_of(p, i, from, bytes);
    if (strategy == NO_MEMORY)
        return 0;
    return compress_bytes(p, i, from, bytes, strategy,
                          i + 1 == p->pieces ? Z_FINISH : Z_FULL_FLUSH);
}

static void pack_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const packer *p = user;
    for (size_t i = begin; i < end; i++) {
        p->length[i] = pack_piece(p, i);
        p->sum[i] = adler32(1, p->data + i * PIECE, (uInt)piece_bytes(p, i));
    }
}

/* Makes one stream of the pieces, in the place of the first; its length, or 0 when out of memory. */
static size_t join(packer *p)
{
    /* the head goes before the first piece */
    unsigned char *to = p->packed - HEAD_BYTES;
    uLong sum = 1;
    to[0] = 0x78;
    to[1] = 0x01;
    to += HEAD_BYTES;
    for (size_t i = 0; i < p->pieces; i++) {
        if (p->length[i] == 0)
            return 0;
        memmove(to, p->packed + i * PACKED, p->length[i]);
        to += p->length[i];
        sum = adler32_combine(sum, p->sum[i], (z_off_t)piece_bytes(p, i));
    }
    for (int k = 0; k < SUM_BYTES; k++)
        to[k] = (unsigned char)(sum >> (24 - 8 * k));
    return (size_t)(to + SUM_BYTES - (p->packed - HEAD_BYTES));
}

/* ---------------------------------------------------------------- text ------------------- */

typedef struct writer {
    const unsigned char *data;
    size_t bytes;
    unsigned char *text;
} writer;

static const char letters[65] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static void text_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const writer *w = user;
    unsigned char *to = w->text + begin / 3 * 4;
    size_t i = begin;
    for (; i + 2 < end; i += 3, to += 4) {
        uint32_t bits = (uint32_t)w->data[i] << 16 | (uint32_t)w->data[i + 1] << 8 | w->data[i + 2];
        for (int k = 0; k < 4; k++)
            to[k] = (unsigned char)letters[bits >> (18 - 6 * k) & 63];
    }
    if (i == end)
        return;
    bool two = i + 1 < end;
    uint32_t bits = (uint32_t)w->data[i] << 16 | (two ? (uint32_t)w->data[i + 1] << 8 : 0);
    to[0] = (unsigned char)letters[bits >> 18];
    to[1] = (unsigned char)letters[bits >> 12 & 63];
    to[2] = two ? (unsigned char)letters[bits >> 6 & 63] : '=';
    to[3] = '=';
}

static bool put_text(tl_model *m, const unsigned char *data, size_t bytes, tl_piece *out)
{
    size_t length = (bytes + 2) / 3 * 4;
    unsigned char *text = tl_piece_reserve(out, length);
    if (!text)
        return false;
    writer w = {data, bytes, text};
    tl_parallel_for(m->pool, bytes, TEXT_CHUNK, text_range, &w);
    out->length += length;
    return true;
}

tl_status tl_pack(tl_model *m, const unsigned char *data, size_t bytes, tl_piece *out)
{
    packer p = {.data = data, .bytes = bytes};
    p.pieces = bytes ? (bytes + PIECE - 1) / PIECE : 1;
    unsigned char *memory = malloc(HEAD_BYTES + p.pieces * PACKED + SUM_BYTES);
    p.length = malloc(p.pieces * sizeof *p.length);
    p.sum = malloc(p.pieces * sizeof *p.sum);
    bool good = memory && p.length && p.sum;
    if (good) {
        p.packed = memory + HEAD_BYTES;
        tl_parallel_for(m->pool, p.pieces, 1, pack_range, &p);
        size_t length = join(&p);
        good = length && put_text(m, memory, length, out);
    }
    free(memory);
    free(p.length);
    free(p.sum);
    return good ? TL_OK : tl_fail_memory(&m->error);
}
