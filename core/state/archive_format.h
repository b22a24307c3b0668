/* archive_format.h - the bytes of an archive: a head, then chunks, each a head of its own, its name and its data (archive.c). */
#ifndef TL_STATE_ARCHIVE_FORMAT_H
#define TL_STATE_ARCHIVE_FORMAT_H

#include <stdint.h>

#define TL_ARCHIVE_MAGIC                                                                           \
    {                                                                                              \
        'T', 'A', 'L', 'U', 'S', '\r', '\n', '\x1a'                                                \
    }
/* Format of the file, and of what the chunks hold: another is refused. */
#define TL_ARCHIVE_FORMAT 11
/* Data has at most so many bytes for one that is stored, so that a file can cost no more memory than some multiple of its size. What would be shorter is
 * followed by an empty frame of zstd. */
#define TL_ARCHIVE_DENSEST 32u
/* Tells the order of bytes in numbers. */
#define TL_ARCHIVE_ORDER 0x01020304u

typedef struct tl_archive_head {
    char magic[8];
    uint32_t format, order;
} tl_archive_head;

/* Of a chunk: the bytes of its name; whether its data is compressed; bytes of an item, items, and bytes of the data as stored;
 * xxHash sums of name and data, and of this head before the last. */
typedef struct tl_chunk_head {
    uint32_t name_bytes, packed;
    uint64_t size, items, stored, sum, head_sum;
} tl_chunk_head;

#define TL_CHUNK_HEAD_SUMMED offsetof(tl_chunk_head, head_sum)

#endif
