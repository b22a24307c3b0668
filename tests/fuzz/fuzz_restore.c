/* fuzz_restore.c - saved models with anything in their chunks: a model that can be run, or a sentence, comes of each.
 *
 * Checksums would refuse what was changed at random before anything looks at it. So the chunks of a file are taken apart, one is
 * changed, and the file is put together anew with right checksums, as by somebody who means harm. */
#include "state/archive.h"
#include "state/restore.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include <zstd.h>

#define MOST_CHUNKS 1024
/* Chunks of more bytes are left as they are stored. */
#define MOST_UNPACKED (1 << 20)
/* Steps that a restored model makes. */
#define STEPS 3

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
int LLVMFuzzerInitialize(int *count, char ***arguments);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* ---------------------------------------------------------------- files ------------------ */

typedef struct part {
    char name[TL_CHUNK_NAME];
    size_t name_bytes, size, items, bytes;
    uint8_t *data;
} part;

typedef struct parts {
    part list[MOST_CHUNKS];
    size_t count;
} parts;

static void free_parts(parts *p)
{
    for (size_t i = 0; i < p->count; i++)
        free(p->list[i].data);
    p->count = 0;
}

static bool unpack(const tl_chunk_head *head, const uint8_t *stored, part *out)
{
    size_t bytes = head->packed ? (size_t)(head->size * head->items) : (size_t)head->stored;
    if (head->packed && (head->size > MOST_UNPACKED || head->items > MOST_UNPACKED || bytes > MOST_UNPACKED))
        return false;
    out->data = malloc(bytes + 1);
    out->bytes = bytes;
    if (head->packed)
        return ZSTD_decompress(out->data, bytes, stored, head->stored) == bytes;
    memcpy(out->data, stored, bytes);
    return true;
}

/* Takes a file apart, up to what is no whole chunk. */
static void take_apart(const uint8_t *data, size_t size, parts *p)
{
    p->count = 0;
    for (size_t at = sizeof(tl_archive_head); p->count < MOST_CHUNKS;) {
        tl_chunk_head head;
        if (size < at + sizeof head)
            return;
        memcpy(&head, data + at, sizeof head);
        at += sizeof head;
        if (head.name_bytes >= TL_CHUNK_NAME || head.name_bytes > size - at ||
            head.stored > size - at - head.name_bytes)
            return;
        part *one = &p->list[p->count];
        *one = (part){.name_bytes = head.name_bytes, .size = head.size, .items = head.items};
        memcpy(one->name, data + at, head.name_bytes);
        at += head.name_bytes;
        p->count++;
        if (!unpack(&head, data + at, one))
            one->bytes = 0;
        at += (size_t)head.stored;
        if (strcmp(one->name, "end") == 0)
            return;
    }
}

/* Puts it together, not compressed; 0: there is no room. */
static size_t put_together(const parts *p, uint8_t *data, size_t most)
{
    tl_archive_head file = {TL_ARCHIVE_MAGIC, TL_ARCHIVE_FORMAT, TL_ARCHIVE_ORDER};
    size_t at = sizeof file;
    uint64_t sum = 0;
    if (most < at)
        return 0;
    memcpy(data, &file, sizeof file);
    for (size_t i = 0; i <= p->count; i++) {
        bool last = i == p->count;
        const part *one =
            last ? &(part){.name = "end", .name_bytes = 3, .size = 8, .items = 1, .bytes = 8, .data = (uint8_t *)&sum}
                 : &p->list[i];
        if (!last && strcmp(one->name, "end") == 0)
            continue;
        tl_chunk_head head = {
            .name_bytes = (uint32_t)one->name_bytes, .size = one->size, .items = one->items, .stored = one->bytes};
        if (most - at < sizeof head + one->name_bytes + one->bytes)
            return 0;
        head.sum = XXH64(one->name, one->name_bytes, 0);
        if (one->bytes)
            head.sum = XXH64(one->data, one->bytes, head.sum);
        head.head_sum = XXH64(&head, TL_CHUNK_HEAD_SUMMED, 0);
        memcpy(data + at, &head, sizeof head);
        memcpy(data + at + sizeof head, one->name, one->name_bytes);
        if (one->bytes)
            memcpy(data + at + sizeof head + one->name_bytes, one->data, one->bytes);
        at += sizeof head + one->name_bytes + one->bytes;
        sum = XXH64(&head.sum, sizeof head.sum, sum);
    }
    return at;
}

/* ---------------------------------------------------------------- changes ---------------- */

static uint64_t state;

static size_t any(size_t below)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return below ? (size_t)((state >> 33) % below) : 0;
}

/* One number becomes one that means something, or harm. */
static void put_number(part *p)
{
    static const double reals[] = {0, -1, 1, 1e-300, 1e300, -1e300, 1e9, 0.5};
    uint64_t numbers[] = {0,
                          1,
                          2,
                          7,
                          255,
                          65535,
                          0xffffffffu,
                          0x7fffffffu,
                          0x80000000u,
                          UINT64_MAX,
                          0x7ff8000000000000u,
                          0x7ff0000000000000u,
                          p->items,
                          p->items - 1};
    size_t width = (size_t)1 << any(4), which = any(22);
    uint64_t number = numbers[which % 14];
    if (which >= 14)
        memcpy(&number, &reals[which - 14], sizeof number);
    if (p->bytes < width)
        return;
    memcpy(p->data + any(p->bytes / width) * width, &number, width);
}

static void mutate_bytes(part *p)
{
    size_t most = p->bytes + p->bytes / 4 + 64;
    uint8_t *data = realloc(p->data, most);
    p->data = data;
    if (p->bytes == 0)
        data[0] = 0;
    p->bytes = LLVMFuzzerMutate(data, p->bytes ? p->bytes : 1, most);
    if (p->size && any(4)) { /* whole items */
        p->items = p->bytes / p->size;
        p->bytes = p->items * p->size;
    }
}

static void change(parts *p)
{
    part *one = &p->list[any(p->count)];
    switch (any(8)) {
    case 0:
        one->name[any(one->name_bytes + 1)]++; /* it is missing */
        break;
    case 1:
        one->items = any(one->items + 3);
        if (one->size && one->items <= one->bytes / one->size)
            one->bytes = one->items * one->size;
        break;
    case 2:
    case 3: mutate_bytes(one); break;
    default:
        for (size_t k = 1 + any(3); k-- > 0;)
            put_number(one);
    }
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    static parts p;
    state = seed;
    take_apart(data, size, &p);
    if (p.count == 0)
        return size;
    for (size_t k = 1 + any(3); k-- > 0;)
        change(&p);
    size_t made = put_together(&p, data, most);
    free_parts(&p);
    return made ? made : size;
}

/* ---------------------------------------------------------------- trial ------------------ */

static void say_nothing(void *user, const char *text)
{
    (void)user;
    (void)text;
}

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    (void)count;
    (void)arguments;
    tl_plugins_load_default();
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char *bytes = malloc(size + 1);
    tl_archive a;
    tl_error error = {.status = TL_OK};
    tl_model *m;
    memcpy(bytes, data, size);
    if (tl_archive_of_bytes(&a, "fuzz", bytes, size, &error) != TL_OK)
        return 0;
    if (tl_model_restore_archive(&a, 1, NULL, NULL, &m, &error) == TL_OK) {
        char hash[33];
        tl_solve_result result;
        tl_model *copy = NULL;
        tl_model_log(m, say_nothing, NULL);
        if (tl_model_copy(m, NULL, NULL, &copy) == TL_OK)
            tl_state_hash(copy, hash);
        tl_model_destroy(copy);
        tl_model_cycle(m, STEPS, &result);
        tl_model_destroy(m);
    }
    tl_archive_close(&a);
    return 0;
}
