/* test_restore_cost.c - what a file may cost. Saved models of which one field or one length is another one, with right checksums,
 * are refused or sound, with no more memory than a multiple of their size. */
#include "contact_scene.h"
#include "state/archive.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <talus/state.h>
#include <xxhash.h>

static const char truth[] = TALUS_TEST_TMP "/costs.talus", lie_path[] = TALUS_TEST_TMP "/cost.talus";

#define MOST_BYTES (100u << 20)
#define LIES 300

/* With sanitizers memory is not what a program takes. */
#if defined __SANITIZE_ADDRESS__
#define SANITIZED 1
#elif defined __has_feature
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif

/* A small wall, after some steps. */
static void save_truth(void)
{
    tl_model *m = scene_model(1);
    tl_solve_result result;
    for (int k = 0; k < 12; k++)
        scene_box(m, tl_v3(k % 3, 0, k / 3), tl_v3(k % 3 + 1, 1, k / 3 + 1));
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    scene_ok(m, tl_model_cycle(m, 10, &result));
    scene_ok(m, tl_model_save(m, truth));
    tl_model_destroy(m);
}

static unsigned char *bytes_of(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    unsigned char *bytes = malloc(1 << 20);
    CHECK(file && bytes);
    *length = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

static void write_bytes(const unsigned char *bytes, size_t length)
{
    FILE *file = fopen(lie_path, "wb");
    CHECK(file && fwrite(bytes, 1, length, file) == length);
    fclose(file);
}

/* A number as a liar would choose it: of the size of what is there, or of none. */
static uint64_t lie_about(uint64_t *seed, uint64_t was)
{
    const uint64_t all[] = {0,       1,          was + 1,    was - 1,    2 * was,   64 * was,  was << 20,
                            1 << 27, 270000000u, UINT32_MAX, 1ull << 40, INT64_MAX, UINT64_MAX};
    return all[(size_t)scene_between(seed, 0, sizeof all / sizeof *all - 0.001)];
}

/* Puts right all checksums of chunks' heads and of the end. */
static void sum_up(unsigned char *bytes, size_t length)
{
    uint64_t sum = 0, before = 0;
    for (size_t at = sizeof(tl_archive_head); at + sizeof(tl_chunk_head) <= length;) {
        tl_chunk_head head;
        memcpy(&head, bytes + at, sizeof head);
        size_t name = at + sizeof head, data = name + head.name_bytes;
        bool end = head.name_bytes == 3 && memcmp(bytes + name, "end", 3) == 0;
        if (data + head.stored > length || head.stored > length)
            return;
        before = sum;
        if (end)
            memcpy(bytes + data, &before, sizeof before);
        head.sum = XXH64(bytes + name, head.name_bytes, 0);
        head.sum = head.stored ? XXH64(bytes + data, head.stored, head.sum) : head.sum;
        head.head_sum = XXH64(&head, TL_CHUNK_HEAD_SUMMED, 0);
        memcpy(bytes + at, &head, sizeof head);
        sum = XXH64(&head.sum, sizeof head.sum, sum);
        at = data + head.stored;
    }
}

/* The file once more, with one number of a head or of data that is not packed changed. Gives what was. */
static void change_bytes(uint64_t *seed, char what[200])
{
    size_t length, at = sizeof(tl_archive_head), chunks = 0;
    unsigned char *bytes = bytes_of(truth, &length);
    size_t starts[1000];
    while (at + sizeof(tl_chunk_head) <= length && chunks < 1000) {
        tl_chunk_head head;
        memcpy(&head, bytes + at, sizeof head);
        starts[chunks++] = at;
        at += sizeof head + head.name_bytes + head.stored;
    }
    size_t chunk = starts[(size_t)scene_between(seed, 0, (double)chunks - 1.001)], place;
    tl_chunk_head head;
    memcpy(&head, bytes + chunk, sizeof head);
    const size_t fields[] = {offsetof(tl_chunk_head, size), offsetof(tl_chunk_head, items),
                             offsetof(tl_chunk_head, items)};
    if (head.packed || head.stored < 8 || scene_between(seed, 0, 1) < 0.4) {
        place = chunk + fields[(size_t)scene_between(seed, 0, 2.999)];
    } else {
        size_t words = head.stored / 8;
        place = chunk + sizeof head + head.name_bytes + 8 * (size_t)scene_between(seed, 0, (double)words - 0.001);
    }
    uint64_t was, is;
    memcpy(&was, bytes + place, sizeof was);
    is = lie_about(seed, was);
    memcpy(bytes + place, &is, sizeof is);
    snprintf(what, 200, "%.*s, byte %zu: %llu for %llu", (int)head.name_bytes,
             (const char *)bytes + chunk + sizeof head, place - chunk, (unsigned long long)is, (unsigned long long)was);
    sum_up(bytes, length);
    write_bytes(bytes, length);
    free(bytes);
}

/* The file once more, with the list of one chunk longer or shorter, of zeros where it is longer, or with one of its numbers changed. */
static void change_list(uint64_t *seed, char what[200])
{
    tl_archive from;
    tl_archive_writer to;
    tl_error error;
    CHECK(tl_archive_open(&from, truth, &error) == TL_OK);
    CHECK(tl_archive_begin(&to, lie_path, &error) == TL_OK);
    size_t chosen = (size_t)scene_between(seed, 0, (double)from.chunk_count - 1.001);
    bool longer = scene_between(seed, 0, 1) < 0.5;
    for (size_t i = 0; i + 1 < from.chunk_count; i++) { /* the writer adds its own end */
        const tl_chunk *chunk = &from.chunks[i];
        size_t size = (size_t)chunk->size, items = (size_t)chunk->items, told = items;
        char name[TL_CHUNK_NAME + 1];
        snprintf(name, sizeof name, "%.*s", (int)chunk->name_bytes, chunk->name);
        if (i == chosen && longer)
            told = (size_t)scene_between(seed, 0, 2.5e6 / (double)size);
        unsigned char *data = calloc((items > told ? items : told) + 1, size);
        CHECK(data && tl_archive_get(&from, name, data, size, items));
        if (i == chosen && !longer && size * items >= 8) {
            size_t at = 8 * (size_t)scene_between(seed, 0, (double)(size * items / 8) - 0.001);
            uint64_t was, is;
            memcpy(&was, data + at, sizeof was);
            is = lie_about(seed, was);
            memcpy(data + at, &is, sizeof is);
        }
        if (i == chosen)
            snprintf(what, 200, "%s: %zu for %zu", name, told, items);
        tl_archive_put(&to, name, data, size, told);
        free(data);
    }
    CHECK(tl_archive_end(&to, &error) == TL_OK);
    tl_archive_close(&from);
}

/* How much memory the program has, as its limit counts it. */
static size_t memory_now(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%lu", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return pages * 4096u;
}

static void limit_memory(size_t bytes)
{
#ifndef SANITIZED
    struct rlimit limit;
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = bytes ? bytes : limit.rlim_max;
    CHECK(setrlimit(RLIMIT_AS, &limit) == 0);
#else
    (void)bytes;
#endif
}

TEST(files_that_lie_cost_little)
{
    int sound = 0, refused = 0;
    save_truth();
    for (uint64_t k = 1; k <= LIES; k++) {
        uint64_t seed = k * 77;
        char what[200] = "";
        tl_error error = {0};
        tl_model *m = NULL;
        if (k % 2)
            change_bytes(&seed, what);
        else
            change_list(&seed, what);
        size_t had = memory_now();
        limit_memory(had ? had + MOST_BYTES : 0);
        tl_status status = tl_model_restore(lie_path, 1, NULL, NULL, &m, &error);
        limit_memory(0);
        if (!CHECK(status != TL_E_MEMORY && !strchr(error.text, '\n')))
            printf("  seed %d, %s: status %d, %s\n", (int)k, what, (int)status, error.text);
        sound += status == TL_OK;
        refused += status != TL_OK;
        if (m) {
            tl_solve_result result;
            tl_model_cycle(m, 3, &result); /* it may say no, in a sentence */
            tl_model_destroy(m);
        }
    }
    printf("  %d refused, %d sound\n", refused, sound);
    CHECK(refused > LIES / 2);
}

/* A sparse file of some gigabytes is not read: there is no memory for it. */
TEST(a_long_file_that_is_none_is_refused_at_once)
{
    tl_error error = {0};
    tl_model *m = NULL;
    FILE *file = fopen(lie_path, "wb");
    CHECK(file && fseek(file, 6000000000L, SEEK_SET) == 0 && fputc(1, file) != EOF);
    fclose(file);
    size_t had = memory_now();
    limit_memory(had ? had + MOST_BYTES : 0);
    CHECK(tl_model_restore(lie_path, 1, NULL, NULL, &m, &error) == TL_E_ARGUMENT);
    limit_memory(0);
    CHECK_CONTAINS(error.text, "it is no saved model");
    remove(lie_path);
}

TEST_MAIN(RUN(files_that_lie_cost_little), RUN(a_long_file_that_is_none_is_refused_at_once))
