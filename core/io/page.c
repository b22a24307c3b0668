/* page.c - a page for a browser, frame by frame: tl_write_html.
 *
 * What a frame is made of tells scene.h; here it becomes an element of the page (docs/scene_format.md). The frames
 * are in the file only. A model remembers what a reader of the page knows, and how the file ended. So it goes on with
 * its own page and with no other. */
#define _GNU_SOURCE /* pread, pwrite */
#include "io/page.h"

#include "base/error.h"
#include "base/output_file.h"
#include "base/parallel.h"
#include "base/signals.h"
#include "io/extra_fields.h"
#include "io/json.h"
#include "io/page_asset.h"
#include "io/scene.h"
#include "model/options.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/text.h>
#include <unistd.h>
#include <zlib.h>

/* What stands of a page when a frame is to be added. */
typedef enum tl_page_stand {
    TL_PAGE_GONE,   /* the file is not the one that was left */
    TL_PAGE_WHOLE,  /* it is as it was left */
    TL_PAGE_LONGER, /* it is, but more has been added since */
} tl_page_stand;

/* ---------------------------------------------------------------- pages of a model ------- */

static void scene_destroy(tl_scene *scene)
{
    tl_scene_free(scene);
    free(scene);
}

/* The page of a prefix with what its reader knows; NULL when out of memory. */
static tl_page *page_of(tl_model *m, const char *prefix)
{
    tl_page *page = tl_page_of(m, prefix);
    if (!page || page->scene)
        return page;
    page->scene_destroy = scene_destroy;
    page->scene = calloc(1, sizeof *page->scene);
    if (!page->scene)
        return NULL;
    page->scene->sent.frames = (uint32_t)page->end.frames;
    return page;
}

/* ---------------------------------------------------------------- the file ----------------
 *
 * How frames come to the end of a page.
 *
 * A page is its beginning, the elements of its frames, and an empty comment. A frame is added in place, so that what it
 * costs does not grow with the page:
 *
 *     ... </script> <!---->                                  as it was left, up to `at` and the comment
 *     ... </script> <!--<script ...> ... </script> <!---->   the frame is written over the second half of the comment
 *     ... </script>     <script ...> ... </script> <!---->   the first half is blanked
 *
 * Until the last write, of four bytes within a page of the system, the new element is part of a comment. So the file
 * is a whole page at any moment, however the program ends. A comment without an end, while the element is not all
 * there, goes to the end of the file. */

static const char opening[] = "<!--", closing[] = "-->\n", blank[] = "    ";

enum { HALF = 4 };

/* What a page may connect to: a piece of the page's policy, and what stands there in a page that is served. */
static const char nowhere[] = "connect-src 'none'", at_home[] = "connect-src 'self'";

/* Bytes that are copied at a time. */
#define COPIED ((size_t)1 << 18)

/* ---------------------------------------------------------------- what is there ---------- */

/* Reads all of the bytes; false when there are fewer. */
static bool read_at(int file, void *to, size_t bytes, uint64_t at)
{
    unsigned char *next = to;
    while (bytes > 0) {
        ssize_t got = pread(file, next, bytes, (off_t)at);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        next += got;
        at += (uint64_t)got;
        bytes -= (size_t)got;
    }
    return true;
}

/* The digest of the last bytes of what ends at `at`; false when they are not there. */
static bool digest_of(int file, uint64_t at, uint64_t checked, tl_hash *digest)
{
    unsigned char bytes[TL_PAGE_CHECKED];
    if (checked > sizeof bytes || checked > at || !read_at(file, bytes, checked, at - checked))
        return false;
    *digest = tl_hash_start();
    tl_hash_bytes(digest, bytes, checked);
    return true;
}

static tl_page_stand page_look(const char *path, const tl_page_end *end)
{
    struct stat info;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return TL_PAGE_GONE;
    tl_page_stand stand = TL_PAGE_GONE;
    tl_hash digest;
    char tail[2 * HALF];
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode) && (uint64_t)info.st_size >= end->at &&
        digest_of(file, end->at, end->checked, &digest) && digest.a == end->digest.a && digest.b == end->digest.b)
        stand = (uint64_t)info.st_size == end->at + sizeof tail && read_at(file, tail, sizeof tail, end->at) &&
                        memcmp(tail, "<!---->\n", sizeof tail) == 0
                    ? TL_PAGE_WHOLE
                    : TL_PAGE_LONGER;
    close(file);
    return stand;
}

/* Notes that a page ends with this element, in front of `at`. */
static void note_end(tl_page_end *end, uint64_t at, const tl_piece *element)
{
    size_t checked = element->length < TL_PAGE_CHECKED ? element->length : TL_PAGE_CHECKED;
    end->at = at;
    end->checked = checked;
    end->digest = tl_hash_start();
    tl_hash_bytes(&end->digest, element->data + element->length - checked, checked);
}

/* ---------------------------------------------------------------- a new file ------------- */

static void page_pad(tl_piece *element)
{
    while (element->length % HALF && !element->failed)
        tl_json_put(element, "\n");
}

void tl_page_beginning(tl_piece *to, const char *title, bool live)
{
    for (size_t i = 0; tl_page_before[i]; i++)
        tl_json_put(to, live && strcmp(tl_page_before[i], nowhere) == 0 ? at_home : tl_page_before[i]);
    for (size_t bytes; *title; title += bytes ? bytes : 1) {
        bytes = tl_utf8_next(title);
        if (*title == '&' || *title == '<' || *title == '>')
            tl_json_put(to, *title == '&' ? "&amp;" : *title == '<' ? "&lt;" : "&gt;");
        else if (bytes > 0)
            tl_piece_put(to, title, bytes);
        else
            tl_json_put(to, "\xef\xbf\xbd"); /* the replacement character */
    }
    for (size_t i = 0; tl_page_after[i]; i++)
        tl_json_put(to, tl_page_after[i]);
    page_pad(to);
}

/* Bytes of a page with such an element as its only frame, or after a page that ends at `at`. */
static uint64_t page_length(const char *title, uint64_t at, const tl_piece *element)
{
    tl_piece beginning = {0};
    if (at == 0)
        tl_page_beginning(&beginning, title, false);
    uint64_t before = at ? at + HALF : beginning.length;
    free(beginning.data);
    return before + element->length + 2 * HALF;
}

/* Ends a new file with an element. */
static tl_status finish(tl_model *m, tl_output *output, const tl_piece *element)
{
    tl_output_put(output, element->data, element->length);
    tl_output_put(output, opening, HALF);
    tl_output_put(output, closing, HALF);
    tl_status status = tl_output_finish(output, &m->error);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    return status == TL_OK ? tl_output_commit(output, &m->error) : status;
}

/* Writes the page with its first frame under a new name and renames it. */
static tl_status page_begin(tl_model *m, const char *path, const char *title, const tl_piece *element, tl_page_end *end)
{
    tl_piece beginning = {0};
    tl_page_beginning(&beginning, title, false);
    tl_output output = {.path = NULL};
    tl_status status = beginning.failed ? tl_fail_memory(&m->error) : tl_output_open(&output, path, &m->error);
    if (status == TL_OK) {
        tl_output_put(&output, beginning.data, beginning.length);
        status = finish(m, &output, element);
    }
    if (status == TL_OK)
        note_end(end, beginning.length + element->length, element);
    tl_output_drop(&output);
    free(beginning.data);
    return status;
}

/* ---------------------------------------------------------------- an element ------------- */

/* The element of the next frame. */
static tl_status make_element(tl_model *m, tl_scene *scene, const tl_html *options, tl_piece *element)
{
    tl_piece chunks = {0};
    tl_scene_facts facts;
    tl_status status = tl_scene_write(scene, m, options, &chunks, &facts);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    if (status == TL_OK) {
        tl_json_print(element,
                      "<script type=\"text/talus\" data-frame=\"%u\" data-bytes=\"%g\" data-time=\"%g\" "
                      "data-cycle=\"%g\" data-largest=\"%g\" data-model=\"%u\">",
                      scene->sent.frames, (double)chunks.length, facts.time, (double)facts.cycle, facts.largest,
                      (uint32_t)(facts.news > 0));
        status = tl_pack(m, chunks.data, chunks.length, element);
    }
    free(chunks.data);
    if (status != TL_OK)
        return status;
    tl_json_put(element, "</script>\n");
    page_pad(element);
    return element->failed ? tl_fail_memory(&m->error) : TL_OK;
}

/* ---------------------------------------------------------------- a longer file ---------- */

/* Copies the first bytes of a file. */
static tl_status copy_before(tl_model *m, const char *path, uint64_t bytes, tl_output *output)
{
    int file = open(path, O_RDONLY | O_CLOEXEC);
    unsigned char *scratch = malloc(COPIED);
    tl_status status = scratch ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK && file < 0)
        status = tl_output_fail(&m->error, path, errno);
    for (uint64_t at = 0; status == TL_OK && at < bytes; at += COPIED) {
        size_t part = bytes - at < COPIED ? (size_t)(bytes - at) : COPIED;
        errno = 0;
        if (read_at(file, scratch, part, at))
            tl_output_put(output, scratch, part);
        else
            status = tl_output_fail(&m->error, path, errno ? errno : EIO);
    }
    if (file >= 0)
        close(file);
    free(scratch);
    return status;
}

/* Adds a frame to a copy of what was left of a page that is longer. */
static tl_status add_to_copy(tl_model *m, const char *path, const tl_piece *element, tl_page_end *end)
{
    tl_output output;
    tl_status status = tl_output_open(&output, path, &m->error);
    if (status == TL_OK)
        status = copy_before(m, path, end->at, &output);
    if (status == TL_OK)
        status = finish(m, &output, element);
    tl_output_drop(&output);
    if (status == TL_OK)
        note_end(end, end->at + element->length, element);
    return status;
}

/* Writes all of the bytes; 0 or an errno. */
static int write_at(int file, const void *from, size_t bytes, uint64_t at)
{
    const unsigned char *next = from;
    while (bytes > 0) {
        ssize_t put = pwrite(file, next, bytes, (off_t)at);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return put < 0 ? errno : EIO;
        next += put;
        at += (uint64_t)put;
        bytes -= (size_t)put;
    }
    return 0;
}

/* Adds a frame to a page that stands whole. */
static tl_status add_in_place(tl_model *m, const char *path, const tl_piece *element, tl_page_end *end)
{
    int file = open(path, O_WRONLY | O_CLOEXEC);
    if (file < 0)
        return tl_output_fail(&m->error, path, errno);
    uint64_t first = end->at + HALF, last = first + element->length;
    int code = write_at(file, element->data, element->length, first);
    if (code == 0)
        code = write_at(file, opening, HALF, last);
    if (code == 0)
        code = write_at(file, closing, HALF, last + HALF);
    if (code == 0)
        code = write_at(file, blank, HALF, end->at);
    if (code != 0) { /* as it was */
        write_at(file, closing, HALF, first);
        if (ftruncate(file, (off_t)(first + HALF)) != 0)
            code = errno;
    }
    if (close(file) != 0 && code == 0)
        code = errno;
    if (code != 0)
        return tl_output_fail(&m->error, path, code);
    note_end(end, last, element);
    return TL_OK;
}

/* ---------------------------------------------------------------- a frame ---------------- */

static tl_status check_length(tl_model *m, const tl_page *page, const char *path, const tl_html *options,
                              const tl_piece *element, uint64_t most)
{
    uint64_t at = page->end.frames ? page->end.at : 0;
    uint64_t length = page_length(options->title, at, element);
    if (length <= most)
        return TL_OK;
    return tl_fail(&m->error, TL_E_ARGUMENT,
                   "write_html: with frame %llu '%s' would have %.1f MB, and a page has %.0f MB at the most; write "
                   "frames less often, leave out contacts, or go on under another name",
                   (unsigned long long)page->end.frames, path, (double)length / 1e6, (double)most / 1e6);
}

static tl_status add_frame(tl_model *m, tl_page *page, const char *path, const tl_html *options, uint64_t most)
{
    tl_page_stand stand = page->end.frames ? page_look(path, &page->end) : TL_PAGE_GONE;
    if (stand == TL_PAGE_GONE || (stand == TL_PAGE_LONGER && !page->restored)) { /* it begins anew */
        tl_scene_free(page->scene);
        page->end = (tl_page_end){0};
    }
    tl_piece element = {0};
    tl_status status = make_element(m, page->scene, options, &element);
    if (status == TL_OK)
        status = check_length(m, page, path, options, &element, most);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    if (status == TL_OK)
        status = page->end.frames == 0    ? page_begin(m, path, options->title, &element, &page->end)
                 : stand == TL_PAGE_WHOLE ? add_in_place(m, path, &element, &page->end)
                                          : add_to_copy(m, path, &element, &page->end);
    free(element.data);
    if (status != TL_OK)
        return status;
    page->end.frames++;
    page->restored = false;
    tl_scene_accept(page->scene);
    return TL_OK;
}

/* ---------------------------------------------------------------- what was asked --------- */

static tl_status check(const char *prefix, const tl_html *options, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT,
                       "write_html: prefix = '%s' must end in a name for the page, as in 'out/run'", prefix);
    if (options->contacts < TL_HTML_CONTACTS_FEW || options->contacts > TL_HTML_CONTACTS_NONE)
        return tl_fail(error, TL_E_ARGUMENT, "write_html: contacts = %d must be one of tl_html_contacts, 0 to %d",
                       options->contacts, TL_HTML_CONTACTS_NONE);
    tl_status status = tl_extra_fields_check("write_html: block_fields", options->block_fields,
                                             options->block_field_count, TL_ANY_ITEMS, "", error);
    if (status == TL_OK)
        status = tl_extra_fields_check("write_html: contact_fields", options->contact_fields,
                                       options->contact_field_count, TL_ANY_ITEMS, "", error);
    return status;
}

tl_status tl_page_write(tl_model *m, const char *prefix, const tl_html *given, uint64_t most)
{
    tl_html options;
    tl_status status = TL_OPTIONS_READ(tl_html, given, &options, &m->error);
    if (status == TL_OK)
        status = check(prefix, &options, &m->error);
    if (status != TL_OK)
        return status;
    char *own = tl_output_prefix(prefix, ".html"), *path = NULL;
    tl_page *page = own ? page_of(m, own) : NULL;
    if (page && (path = malloc(strlen(own) + sizeof ".html"))) {
        strcpy(path, own);
        strcat(path, ".html");
        const char *slash = strrchr(own, '/');
        options.title = options.title ? options.title : slash ? slash + 1 : own;
        sigset_t before;
        tl_signals_hold(&before, false);
        atomic_store(&m->interrupted, false);
        status = add_frame(m, page, path, &options, most);
        tl_signals_release(&before);
    } else {
        status = tl_fail_memory(&m->error);
    }
    if (status == TL_E_IO)
        tl_error_prefix(&m->error, "write_html: ");
    free(path);
    free(own);
    return status;
}

tl_status tl_write_html(tl_model *m, const char *prefix, const tl_html *options)
{
    return tl_page_write(m, prefix, options, TL_PAGE_MOST);
}

/* ---------------------------------------------------------------- packing -----------------
 *
 * Zlib (RFC 1950) and base64 (RFC 4648), by several threads.
 *
 * The bytes are divided into pieces. Each is compressed for itself and ends at a whole byte, so that the pieces one
 * after the other are one stream. */

/* Bytes of a piece, and most that one can become: a stored block of five bytes for each 16 kB, and its end. */
#define PIECE ((size_t)256 << 10)
#define PACKED (PIECE + 5 * (PIECE >> 14) + 64)
/* Bytes whose text a thread writes at a time: a multiple of three, so the texts join. */
#define TEXT_CHUNK ((size_t)3 << 16)

/* Cost only: bytes of a piece that are tried, and the share of the length without looking for what repeats above which
 * it is not looked for. */
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

/* Compresses bytes into the place of piece i and ends at a whole byte, or ends the stream. Gives how many bytes come
 * of it, or 0 when out of memory. */
static size_t compress_bytes(const packer *p, size_t i, const unsigned char *from, size_t bytes, int strategy, int end)
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
    bool good = z.avail_in == 0 && z.avail_out > 0 && code == (end == Z_FINISH ? Z_STREAM_END : Z_OK);
    size_t length = good ? PACKED - z.avail_out : 0;
    deflateEnd(&z);
    return length;
}

/* Whether looking for what repeats is worth its time, three times that of coding alone: not in most numbers of moving
 * blocks. A part of the piece tells. NO_MEMORY: nothing does. */
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
    return compress_bytes(p, i, from, bytes, strategy, i + 1 == p->pieces ? Z_FINISH : Z_FULL_FLUSH);
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
    unsigned char *text = tl_piece_add(out, length);
    if (!text)
        return false;
    writer w = {data, bytes, text};
    tl_parallel_for(m->pool, bytes, TEXT_CHUNK, text_range, &w);
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
