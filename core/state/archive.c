/* archive.c - a file of named chunks, each compressed and with a checksum.
 *
 *     file    magic, format, byte order, then chunks; the last is "end", whose data is the sum of all checksums
 *             before it
 *     chunk   head of 48 bytes, name, data
 *     head    bytes of the name (4), 1 if the data is compressed (4), bytes of an item, items, bytes of the data
 *             as stored, XXH64 of name and stored data, XXH64 of the 40 bytes before
 *
 * Numbers are as the machine has them; a file of another byte order is refused. Data is compressed with zstd where
 * that makes it shorter. A file that was cut off lacks its end. */
#include "state/archive.h"

#include "base/output_file.h"
#include "base/regular.h"
#include "base/table.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>
#include <talus/version.h>
#include <xxhash.h>
#include <zstd.h>

static const char magic[8] = TL_ARCHIVE_MAGIC;

/* Level of compression. It gives a third of the size at some 600 MB/s, for a hundred thousand blocks of rock. Higher
 * levels take longer than a disk. */
#define LEVEL 1
/* Data of fewer bytes is stored as it is. */
#define SHORT_DATA 128
/* Bytes of a file by which it is told what it is; room for a version. */
#define FIRST_BYTES 256
#define WRITER 32
/* Bytes that there is memory for when a file is read; more is had as it turns out to be longer. */
#define READ_AT_FIRST ((size_t)1 << 20)
/* Bytes of a frame that is skipped beside what is in it; it holds less than 4 GiB, so data has less than 128 GiB. */
#define SKIPPED 8

const char *tl_chunk_name(char name[TL_CHUNK_NAME], const char *format, ...)
{
    va_list args;
    va_start(args, format);
    tl_text_vprint(name, TL_CHUNK_NAME, format, args);
    va_end(args);
    return name;
}

/* ---------------------------------------------------------------- writing ---------------- */

static void put_head(tl_archive_writer *w)
{
    tl_archive_head head = {.format = TL_ARCHIVE_FORMAT, .order = TL_ARCHIVE_ORDER};
    memcpy(head.magic, magic, sizeof magic);
    tl_output_put(&w->out, &head, sizeof head);
}

tl_status tl_archive_begin(tl_archive_writer *w, const char *path, tl_error *error)
{
    *w = (tl_archive_writer){.buffer = NULL};
    tl_status status = tl_output_open(&w->out, path, error);
    if (status != TL_OK)
        return status;
    w->out.durable = true;
    put_head(w);
    return TL_OK;
}

tl_status tl_archive_begin_in_memory(tl_archive_writer *w, char **bytes, size_t *length, tl_error *error)
{
    *w = (tl_archive_writer){.buffer = NULL, .in_memory = true};
    *bytes = NULL;
    w->out.file = open_memstream(bytes, length);
    if (!w->out.file)
        return tl_fail_memory(error);
    put_head(w);
    return TL_OK;
}

/* Makes packed data long enough for what it stands for, by a frame that zstd skips; its length then. */
static size_t pad(unsigned char *packed, size_t length, size_t bytes)
{
    const size_t least = bytes / TL_ARCHIVE_DENSEST + 1;
    if (length >= least)
        return length;
    const size_t rest = least > length + SKIPPED ? least - length - SKIPPED : 0;
    const uint32_t head[2] = {ZSTD_MAGIC_SKIPPABLE_START, (uint32_t)rest};
    memcpy(packed + length, head, sizeof head);
    memset(packed + length + SKIPPED, 0, rest);
    return length + SKIPPED + rest;
}

/* Compresses into the writer's buffer; 0: not shorter. */
static size_t pack(tl_archive_writer *w, const void *data, size_t bytes)
{
    size_t bound = ZSTD_compressBound(bytes) + bytes / TL_ARCHIVE_DENSEST + SKIPPED + 1;
    if (bound > w->buffer_bytes) {
        free(w->buffer);
        w->buffer = malloc(bound);
        w->buffer_bytes = w->buffer ? bound : 0;
        w->lost = w->lost || !w->buffer;
    }
    if (!w->buffer)
        return 0;
    size_t packed = ZSTD_compress(w->buffer, bound, data, bytes, LEVEL);
    packed = ZSTD_isError(packed) ? bytes : pad(w->buffer, packed, bytes);
    return packed >= bytes ? 0 : packed;
}

static uint64_t sum_of(const char *name, size_t name_bytes, const void *data, size_t bytes)
{
    XXH64_hash_t sum = XXH64(name, name_bytes, 0);
    return bytes ? XXH64(data, bytes, sum) : sum;
}

void tl_archive_put(tl_archive_writer *w, const char *name, const void *data, size_t size, size_t items)
{
    size_t bytes = size * items;
    size_t packed = bytes < SHORT_DATA ? 0 : pack(w, data, bytes);
    const void *stored = packed ? w->buffer : data;
    tl_chunk_head head = {.name_bytes = (uint32_t)strlen(name),
                          .packed = packed > 0,
                          .size = size,
                          .items = items,
                          .stored = packed ? packed : bytes};
    head.sum = sum_of(name, head.name_bytes, stored, head.stored);
    head.head_sum = XXH64(&head, TL_CHUNK_HEAD_SUMMED, 0);
    w->sum = XXH64(&head.sum, sizeof head.sum, w->sum);
    w->chunks++;
    tl_output_put(&w->out, &head, sizeof head);
    tl_output_put(&w->out, name, head.name_bytes);
    tl_output_put(&w->out, stored, head.stored);
}

void tl_archive_put_text(tl_archive_writer *w, const char *name, const char *text)
{
    tl_archive_put(w, name, text, 1, strlen(text));
}

tl_status tl_archive_end(tl_archive_writer *w, tl_error *error)
{
    const uint64_t sum = w->sum;
    tl_archive_put(w, "end", &sum, sizeof sum, 1);
    if (w->in_memory) {
        const bool bad = w->lost || w->out.code != 0;
        free(w->buffer);
        return fclose(w->out.file) == 0 && !bad ? TL_OK : tl_fail_memory(error);
    }
    tl_status status = w->lost ? tl_fail_memory(error) : tl_output_finish(&w->out, error);
    if (status == TL_OK)
        status = tl_output_commit(&w->out, error);
    tl_output_drop(&w->out);
    free(w->buffer);
    return status;
}

/* ---------------------------------------------------------------- reading ---------------- */

tl_status tl_archive_bad(const tl_archive *a, tl_error *error, const char *format, ...)
{
    char what[TL_ERROR_TEXT / 2];
    va_list args;
    va_start(args, format);
    tl_text_vprint(what, sizeof what, format, args);
    va_end(args);
    return tl_fail(error, TL_E_ARGUMENT, "cannot restore '%.200s': the file is damaged: %s", a->path, what);
}

/* The version of the program that has written a file, by its first bytes: its first chunk in all formats since 7.
 * Empty: unknown. */
static void find_writer(const unsigned char *bytes, size_t length, char version[WRITER])
{
    static const char name[] = "program";
    const size_t at = sizeof(tl_archive_head), text = at + sizeof(tl_chunk_head) + strlen(name);
    tl_chunk_head head;
    *version = '\0';
    if (length < text)
        return;
    memcpy(&head, bytes + at, sizeof head);
    if (head.name_bytes != strlen(name) || head.packed || head.stored >= WRITER || head.stored > length - text ||
        memcmp(bytes + text - strlen(name), name, strlen(name)) != 0)
        return;
    memcpy(version, bytes + text, head.stored);
    version[head.stored] = '\0';
    if (!tl_text_is_utf8(version) || strpbrk(version, "\r\n\t"))
        *version = '\0';
}

static tl_status refuse_format(const char *path, const unsigned char *bytes, size_t length, uint32_t format,
                               tl_error *error)
{
    char writer[WRITER];
    find_writer(bytes, length, writer);
    const char *by = *writer ? ", written by Talus " : "";
    return tl_fail(error, TL_E_ARGUMENT,
                   "cannot restore '%.200s': it has format %u%s%s, and this version of Talus, " TALUS_VERSION
                   ", reads format %d: use the version that has written it",
                   path, format, by, writer, TL_ARCHIVE_FORMAT);
}

/* By the first bytes of a file, as many as there are. */
static tl_status check_file_head(const char *path, const unsigned char *bytes, size_t length, tl_error *error)
{
    tl_archive_head head;
    if (length < sizeof head || memcmp(bytes, magic, sizeof magic) != 0)
        return tl_fail(error, TL_E_ARGUMENT, "cannot restore '%.200s': it is no saved model", path);
    memcpy(&head, bytes, sizeof head);
    if (head.order != TL_ARCHIVE_ORDER)
        return tl_fail(error, TL_E_ARGUMENT,
                       "cannot restore '%.200s': it was written by a machine of another byte order", path);
    return head.format == TL_ARCHIVE_FORMAT ? TL_OK : refuse_format(path, bytes, length, head.format, error);
}

/* Whether stored data may stand for so many items. */
static bool is_dense(const tl_chunk_head *head)
{
    uint64_t most = head->stored > UINT64_MAX / TL_ARCHIVE_DENSEST
                        ? UINT64_MAX
                        : head->stored * (head->packed ? TL_ARCHIVE_DENSEST : 1);
    return head->size == 0 || head->items <= most / head->size;
}

/* Reads the chunk at `*at`, and moves that on; false: there is no whole one. */
static bool read_chunk(const tl_archive *a, size_t *at, tl_chunk *chunk, uint64_t *sum)
{
    tl_chunk_head head;
    size_t left = a->length - *at;
    if (left < sizeof head)
        return false;
    memcpy(&head, a->bytes + *at, sizeof head);
    left -= sizeof head;
    if (XXH64(&head, TL_CHUNK_HEAD_SUMMED, 0) != head.head_sum || head.packed > 1 || head.name_bytes > TL_CHUNK_NAME ||
        head.name_bytes > left || head.stored > left - head.name_bytes || !is_dense(&head))
        return false;
    const unsigned char *name = a->bytes + *at + sizeof head;
    *chunk = (tl_chunk){.name = (const char *)name,
                        .name_bytes = head.name_bytes,
                        .data = name + head.name_bytes,
                        .size = head.size,
                        .items = head.items,
                        .stored = head.stored,
                        .packed = head.packed};
    *at += sizeof head + head.name_bytes + (size_t)head.stored;
    *sum = XXH64(&head.sum, sizeof head.sum, *sum);
    return sum_of(chunk->name, chunk->name_bytes, chunk->data, chunk->stored) == head.sum;
}

static bool is_named(const tl_chunk *chunk, const char *name)
{
    return strlen(name) == chunk->name_bytes && memcmp(chunk->name, name, chunk->name_bytes) == 0;
}

/* Lists the chunks. The last must be the end, with nothing behind it. */
static tl_status list_chunks(tl_archive *a, tl_error *error)
{
    size_t at = sizeof(tl_archive_head), capacity = 0;
    uint64_t sum = 0, before;
    tl_chunk chunk;
    do {
        before = sum;
        if (!read_chunk(a, &at, &chunk, &sum))
            return tl_archive_bad(a, error, "chunk %zu of it is not whole, or its checksum is wrong",
                                  a->chunk_count + 1);
        if (!tl_grow(&a->chunks, &capacity, a->chunk_count + 1, sizeof *a->chunks))
            return tl_fail_memory(error);
        a->chunks[a->chunk_count++] = chunk;
    } while (!is_named(&chunk, "end"));
    uint64_t told;
    if (at != a->length || !tl_archive_get(a, "end", &told, sizeof told, 1) || told != before)
        return tl_archive_bad(a, error, "its end does not fit the rest");
    return TL_OK;
}

tl_status tl_archive_of_bytes(tl_archive *a, const char *path, unsigned char *bytes, size_t length, tl_error *error)
{
    *a = (tl_archive){.path = strdup(path), .bytes = bytes, .length = length};
    a->unpacker = ZSTD_createDCtx(); /* unpacking then needs no memory of its own */
    tl_status status = a->path && a->unpacker ? check_file_head(path, bytes, length, error) : tl_fail_memory(error);
    if (status == TL_OK)
        status = list_chunks(a, error);
    if (status != TL_OK)
        tl_archive_close(a);
    return status;
}

static tl_status cannot_read(tl_error *error, const char *path, const char *why)
{
    return tl_fail(error, TL_E_IO, "cannot restore '%.200s': %s", path, why);
}

/* The bytes of a file behind its head; NULL with an errno. */
static unsigned char *read_all(FILE *file, const unsigned char *head, size_t *length)
{
    unsigned char *bytes = malloc(READ_AT_FIRST);
    size_t capacity = READ_AT_FIRST;
    if (bytes)
        memcpy(bytes, head, *length);
    do {
        if (!bytes || !tl_grow(&bytes, &capacity, *length + 1, 1)) {
            free(bytes);
            return NULL;
        }
        *length += fread(bytes + *length, 1, capacity - *length, file);
    } while (!feof(file) && !ferror(file));
    if (!ferror(file))
        return bytes;
    free(bytes);
    return NULL;
}

tl_status tl_archive_open(tl_archive *a, const char *path, tl_error *error)
{
    *a = (tl_archive){.path = NULL};
    const char *special = tl_not_regular(path);
    if (special)
        return cannot_read(error, path, special);
    FILE *file = fopen(path, "rb");
    if (!file)
        return cannot_read(error, path, strerror(errno));
    unsigned char head[FIRST_BYTES];
    errno = 0;
    size_t length = fread(head, 1, sizeof head, file);
    tl_status status = ferror(file) ? TL_OK : check_file_head(path, head, length, error);
    unsigned char *bytes = status == TL_OK ? read_all(file, head, &length) : NULL;
    int code = errno;
    fclose(file);
    if (status != TL_OK)
        return status;
    if (!bytes)
        return code == ENOMEM ? tl_fail_memory(error) : cannot_read(error, path, strerror(code));
    return tl_archive_of_bytes(a, path, bytes, length, error);
}

void tl_archive_close(tl_archive *a)
{
    free(a->path);
    free(a->bytes);
    free(a->chunks);
    ZSTD_freeDCtx(a->unpacker);
    *a = (tl_archive){.path = NULL};
}

const tl_chunk *tl_archive_find(const tl_archive *a, const char *name)
{
    for (size_t i = 0; i < a->chunk_count; i++)
        if (is_named(&a->chunks[i], name))
            return &a->chunks[i];
    return NULL;
}

size_t tl_archive_items(const tl_archive *a, const char *name)
{
    const tl_chunk *chunk = tl_archive_find(a, name);
    return chunk && chunk->items < UINT32_MAX ? (size_t)chunk->items : 0;
}

bool tl_archive_has(const tl_archive *a, const char *name, size_t size, size_t items)
{
    const tl_chunk *chunk = tl_archive_find(a, name);
    return chunk && chunk->size == size && chunk->items == items;
}

bool tl_archive_get(const tl_archive *a, const char *name, void *to, size_t size, size_t items)
{
    if (!tl_archive_has(a, name, size, items))
        return false;
    const tl_chunk *chunk = tl_archive_find(a, name);
    size_t bytes = size * items;
    if (!chunk->packed) {
        if (chunk->stored != bytes)
            return false;
        if (bytes)
            memcpy(to, chunk->data, bytes);
        return true;
    }
    return bytes && ZSTD_decompressDCtx(a->unpacker, to, bytes, chunk->data, chunk->stored) == bytes;
}

bool tl_archive_text(const tl_archive *a, const char *name, char *text, size_t capacity)
{
    const tl_chunk *chunk = tl_archive_find(a, name);
    if (!chunk || chunk->items >= capacity || !tl_archive_get(a, name, text, 1, (size_t)chunk->items))
        return false;
    text[chunk->items] = '\0';
    return strlen(text) == chunk->items;
}
