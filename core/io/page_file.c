/* page_file.c - how frames come to the end of a page.
 *
 * A page is its beginning, the elements of its frames, and an empty comment. A frame is added in place, so that what it
 * costs does not grow with the page:
 *
 *     ... </script> <!---->                                  as it was left, up to `at` and the comment
 *     ... </script> <!--<script ...> ... </script> <!---->   the frame is written over the second half of the comment
 *     ... </script>     <script ...> ... </script> <!---->   the first half is blanked
 *
 * Until the last write, of four bytes within a page of the system, the new element is part of a comment, so the file is a
 * whole page at any moment, however the program ends. A comment without an end, while the element is not all there, goes to
 * the end of the file. */
#define _GNU_SOURCE /* pread, pwrite */
#include "io/page_file.h"

#include "base/error.h"
#include "io/json.h"
#include "io/page_asset.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/text.h>
#include <unistd.h>

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

tl_page_stand tl_page_look(const char *path, const tl_page_end *end)
{
    struct stat info;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return TL_PAGE_GONE;
    tl_page_stand stand = TL_PAGE_GONE;
    tl_hash digest;
    char tail[2 * HALF];
    if (fstat(file, &info) == 0 && S_ISREG(info.st_mode) && (uint64_t)info.st_size >= end->at &&
        digest_of(file, end->at, end->checked, &digest) && digest.a == end->digest.a &&
        digest.b == end->digest.b)
        stand = (uint64_t)info.st_size == end->at + sizeof tail &&
                        read_at(file, tail, sizeof tail, end->at) &&
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

void tl_page_pad(tl_piece *element)
{
    while (element->length % HALF && !element->failed)
        tl_json_put(element, "\n");
}

void tl_page_beginning(tl_piece *to, const char *title, bool live)
{
    for (size_t i = 0; tl_page_before[i]; i++)
        tl_json_put(to,
                    live && strcmp(tl_page_before[i], nowhere) == 0 ? at_home : tl_page_before[i]);
    for (size_t bytes; *title; title += bytes ? bytes : 1) {
        bytes = tl_utf8_next(title);
        if (*title == '&' || *title == '<' || *title == '>')
            tl_json_put(to, *title == '&' ? "&amp;" : *title == '<' ? "&lt;" : "&gt;");
        else if (bytes > 0)
            tl_json_bytes(to, title, bytes);
        else
            tl_json_put(to, "\xef\xbf\xbd"); /* the replacement character */
    }
    for (size_t i = 0; tl_page_after[i]; i++)
        tl_json_put(to, tl_page_after[i]);
    tl_page_pad(to);
}

uint64_t tl_page_length(const char *title, uint64_t at, const tl_piece *element)
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
        status = tl_output_go_on(m);
    return status == TL_OK ? tl_output_commit(output, &m->error) : status;
}

tl_status tl_page_begin(tl_model *m, const char *path, const char *title, const tl_piece *element,
                        tl_page_end *end)
{
    tl_piece beginning = {0};
    tl_page_beginning(&beginning, title, false);
    tl_output output = {.path = NULL};
    tl_status status =
        beginning.failed ? tl_fail_memory(&m->error) : tl_output_open(&output, path, &m->error);
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

static tl_status add_to_copy(tl_model *m, const char *path, const tl_piece *element,
                             tl_page_end *end)
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

static tl_status add_in_place(tl_model *m, const char *path, const tl_piece *element,
                              tl_page_end *end)
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

tl_status tl_page_add(tl_model *m, const char *path, tl_page_stand stand, const tl_piece *element,
                      tl_page_end *end)
{
    return stand == TL_PAGE_WHOLE ? add_in_place(m, path, element, end)
                                  : add_to_copy(m, path, element, end);
}
