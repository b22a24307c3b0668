/* test_archive.c - files of named chunks: what is written is read, of any number of chunks; cut off anywhere, or of chunks whose heads do not
 * fit, with right checksums, it is refused; a file of an older format tells who has written it, when that can be told. */
#include "state/archive.h"

#include "check.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <xxhash.h>

static const char path[] = TALUS_TEST_TMP "/archive.talus";

/* More chunks than any list of them begins with. */
#define CHUNKS 1000

TEST(many_chunks_come_back)
{
    tl_archive_writer to;
    tl_archive from;
    tl_error error;
    char name[32];
    CHECK(tl_archive_begin(&to, path, &error) == TL_OK);
    for (uint32_t i = 0; i < CHUNKS; i++) {
        tl_text_print(name, sizeof name, "chunk.%u", i);
        tl_archive_put(&to, name, &i, sizeof i, 1);
    }
    CHECK(tl_archive_end(&to, &error) == TL_OK);
    CHECK(tl_archive_open(&from, path, &error) == TL_OK);
    CHECK(from.chunk_count == CHUNKS + 1);
    for (uint32_t i = 0; i < CHUNKS; i++) {
        uint32_t is = 0;
        tl_text_print(name, sizeof name, "chunk.%u", i);
        CHECK(tl_archive_get(&from, name, &is, sizeof is, 1) && is == i);
    }
    tl_archive_close(&from);
}

/* ---------------------------------------------------------------- bytes ------------------ */

/* An archive in memory; as much again is behind it, so that a read beyond its end finds what it looks for. */
typedef struct made {
    unsigned char bytes[4096];
    size_t length;
    uint64_t sum;
} made;

static void begin(made *to, uint32_t format)
{
    const tl_archive_head head = {TL_ARCHIVE_MAGIC, format, TL_ARCHIVE_ORDER};
    memcpy(to->bytes, &head, sizeof head);
    to->length = sizeof head;
    to->sum = 0;
}

/* Adds a chunk whose head says what it is told to, with checksums of that. */
static void put(made *to, const char *name, tl_chunk_head head, const void *data, size_t bytes)
{
    const XXH64_hash_t of_name = XXH64(name, strlen(name), 0);
    head.sum = bytes ? XXH64(data, bytes, of_name) : of_name;
    head.head_sum = XXH64(&head, TL_CHUNK_HEAD_SUMMED, 0);
    to->sum = XXH64(&head.sum, sizeof head.sum, to->sum);
    memcpy(to->bytes + to->length, &head, sizeof head);
    to->length += sizeof head;
    memcpy(to->bytes + to->length, name, strlen(name));
    to->length += strlen(name);
    memcpy(to->bytes + to->length, data, bytes);
    to->length += bytes;
}

static tl_chunk_head head_of(const char *name, size_t bytes)
{
    return (tl_chunk_head){.name_bytes = (uint32_t)strlen(name), .size = 1, .items = bytes, .stored = bytes};
}

static void end(made *to)
{
    const uint64_t sum = to->sum;
    tl_chunk_head head = head_of("end", sizeof sum);
    head.size = sizeof sum;
    head.items = 1;
    put(to, "end", head, &sum, sizeof sum);
}

/* The sentence about the first `length` bytes; empty: they are an archive. What is behind them is there, too. */
static const char *refusal(const made *of, size_t length)
{
    static tl_error error;
    tl_archive a;
    unsigned char *bytes = malloc(sizeof of->bytes);
    if (!CHECK(bytes))
        exit(1);
    memcpy(bytes, of->bytes, sizeof of->bytes);
    error = (tl_error){0};
    tl_status status = tl_archive_of_bytes(&a, "bytes", bytes, length, &error);
    CHECK(status == TL_OK || status == TL_E_ARGUMENT);
    if (status == TL_OK)
        tl_archive_close(&a);
    return error.text;
}

TEST(cut_off_anywhere_it_is_refused)
{
    static made m;
    begin(&m, TL_ARCHIVE_FORMAT);
    put(&m, "one", head_of("one", 5), "12345", 5);
    end(&m);
    CHECK_CONTAINS(refusal(&m, m.length - 1), "cannot restore 'bytes'");
    for (size_t length = 0; length < m.length; length++)
        CHECK(*refusal(&m, length));
    CHECK(!*refusal(&m, m.length));
    CHECK_CONTAINS(refusal(&m, m.length + 1), "its end does not fit");
}

TEST(heads_that_do_not_fit_are_refused)
{
    static char name[TL_CHUNK_NAME + 2];
    static made m;
    for (int k = 0; k < 5; k++) {
        memset(name, 'n', sizeof name - 1);
        name[k == 0 ? TL_CHUNK_NAME : k == 1 ? TL_CHUNK_NAME + 1 : 3] = '\0';
        tl_chunk_head head = head_of(name, 5);
        head.packed = k == 2 ? 2 : 0;
        head.items = k == 3 ? 6 : 5; /* more than is stored */
        begin(&m, TL_ARCHIVE_FORMAT);
        put(&m, name, head, "12345", 5);
        end(&m);
        CHECK(!*refusal(&m, m.length) == (k == 0 || k == 4));
        name[TL_CHUNK_NAME] = name[3] = 'n';
    }
}

TEST(an_older_format_tells_its_writer)
{
    static char longest[64];
    static made m;
    memset(longest, '1', sizeof longest);
    const char *const versions[] = {"0.0.7", longest, "0.0.7", "0.0\n7", "0.\xff.7"};
    for (size_t k = 0; k < sizeof versions / sizeof *versions; k++) {
        const size_t bytes = k == 1 ? sizeof longest : strlen(versions[k]);
        tl_chunk_head head = head_of("program", bytes);
        head.packed = k == 2;
        begin(&m, TL_ARCHIVE_FORMAT - 1);
        put(&m, "program", head, versions[k], bytes);
        end(&m);
        const char *text = refusal(&m, m.length);
        CHECK_CONTAINS(text, "use the version that has written it");
        CHECK((strstr(text, "written by Talus 0.0.7") != NULL) == (k == 0));
        CHECK((strstr(text, "written by") != NULL) == (k == 0));
    }
}

TEST_MAIN(RUN(many_chunks_come_back), RUN(cut_off_anywhere_it_is_refused), RUN(heads_that_do_not_fit_are_refused),
          RUN(an_older_format_tells_its_writer))
