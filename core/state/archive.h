/* archive.h - a file of named chunks, each compressed and with a checksum. */
#ifndef TL_STATE_ARCHIVE_H
#define TL_STATE_ARCHIVE_H

#include "base/error.h"
#include "base/output_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Longest name of a chunk. */
#define TL_CHUNK_NAME 96

/* Makes the name of a chunk by a format, "law.%zu.tag", and gives it; what is too long is cut off. */
const char *tl_chunk_name(char name[TL_CHUNK_NAME], const char *format, ...) TL_PRINTF(2, 3);

/* ---- writing ---- */

typedef struct tl_archive_writer {
    tl_output out;
    void *buffer; /* for what is compressed */
    size_t buffer_bytes;
    uint64_t sum; /* of the checksums so far */
    uint64_t chunks;
    bool lost;      /* out of memory */
    bool in_memory; /* there is no file */
} tl_archive_writer;

/* Opens the archive that is to become `path`, durably. */
tl_status tl_archive_begin(tl_archive_writer *w, const char *path, tl_error *error);
/* Begins an archive in memory: *bytes, to be freed, and *length once it has ended. */
tl_status tl_archive_begin_in_memory(tl_archive_writer *w, char **bytes, size_t *length, tl_error *error);
/* Adds a chunk of `items` items of `size` bytes; what fails is found by tl_archive_end. */
void tl_archive_put(tl_archive_writer *w, const char *name, const void *data, size_t size, size_t items);
/* Adds the bytes of a text. */
void tl_archive_put_text(tl_archive_writer *w, const char *name, const char *text);
/* Gives the file its name when all is well; else what was there stays. */
tl_status tl_archive_end(tl_archive_writer *w, tl_error *error);

/* ---- reading ---- */

typedef struct tl_chunk {
    const char *name; /* not terminated */
    size_t name_bytes;
    const unsigned char *data; /* as it is stored */
    uint64_t size, items, stored;
    bool packed;
} tl_chunk;

/* An archive in memory. Whatever the bytes are, its functions read nothing beyond them. */
typedef struct tl_archive {
    char *path; /* of the file, for sentences */
    unsigned char *bytes;
    size_t length;
    tl_chunk *chunks;
    size_t chunk_count;
    struct ZSTD_DCtx_s *unpacker;
} tl_archive;

/* Reads a file and checks its checksums. TL_E_IO: it cannot be read; TL_E_ARGUMENT: it is no archive, of another
 * format, cut off or damaged. */
tl_status tl_archive_open(tl_archive *archive, const char *path, tl_error *error);
/* The same of bytes, which then belong to the archive; `path` is what sentences call it. */
tl_status tl_archive_of_bytes(tl_archive *archive, const char *path, unsigned char *bytes, size_t length,
                              tl_error *error);
void tl_archive_close(tl_archive *archive);

/* A chunk, or NULL. */
const tl_chunk *tl_archive_find(const tl_archive *archive, const char *name);
/* Items of a chunk; 0 of one that is not there, or has 2^32 - 1 or more. */
size_t tl_archive_items(const tl_archive *archive, const char *name);
/* Whether there is a chunk of so many items of that size. */
bool tl_archive_has(const tl_archive *archive, const char *name, size_t size, size_t items);
/* Puts the items of a chunk into `to`, which has room for them. false: it is not there, has items of another size or
 * number, or does not unpack to them. */
bool tl_archive_get(const tl_archive *archive, const char *name, void *to, size_t size, size_t items);
/* The bytes of a chunk as a text with its terminating zero. false: it is not there, needs more room or holds a zero. */
bool tl_archive_text(const tl_archive *archive, const char *name, char *text, size_t capacity);
/* "cannot restore 'path': the file is damaged: ..." */
tl_status tl_archive_bad(const tl_archive *archive, tl_error *error, const char *format, ...) TL_PRINTF(3, 4);

/* ---- what a file consists of ---- */

#define TL_ARCHIVE_MAGIC                                                                                               \
    {                                                                                                                  \
        'T', 'A', 'L', 'U', 'S', '\r', '\n', '\x1a'                                                                    \
    }
/* Format of the file, and of what the chunks hold: another is refused. */
#define TL_ARCHIVE_FORMAT 23
/* Data has at most so many bytes for one that is stored. So a file can cost no more memory than some multiple of its
 * size. What would be shorter is followed by an empty frame of zstd. */
#define TL_ARCHIVE_DENSEST 32u
/* Tells the order of bytes in numbers. */
#define TL_ARCHIVE_ORDER 0x01020304u

typedef struct tl_archive_head {
    char magic[8];
    uint32_t format, order;
} tl_archive_head;

/* Of a chunk: the bytes of its name; whether its data is compressed; bytes of an item, items, and bytes of the data
 * as stored. The xxHash sums are of name and data, and of this head before the last. */
typedef struct tl_chunk_head {
    uint32_t name_bytes, packed;
    uint64_t size, items, stored, sum, head_sum;
} tl_chunk_head;

#define TL_CHUNK_HEAD_SUMMED offsetof(tl_chunk_head, head_sum)

#endif
