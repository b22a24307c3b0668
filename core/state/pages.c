/* pages.c - the pages for browsers written so far, in an archive: a resumed run goes on with a page after the frames that it
 * had when the model was saved. The frames are in the page's file only, so what is saved is how the file ended.
 *
 *     pages            number of pages
 *     pages.K.prefix   as it was given to write_html
 *     pages.K.end      frames, length, bytes compared and their digest: tl_page_end */
#include "state/pages.h"

#include "io/page.h"

#include <stdio.h>
#include <string.h>

/* Longest prefix and page, bytes, in a file. */
#define LONGEST_PREFIX 4096
#define LONGEST_PAGE ((uint64_t)1 << 40)

enum { FRAMES, AT, CHECKED, DIGEST_A, DIGEST_B, NUMBERS };

/* The name of an entry of page `k`. */
static const char *entry(char name[TL_CHUNK_NAME], size_t k, const char *what)
{
    snprintf(name, TL_CHUNK_NAME, "pages.%zu.%.16s", k, what);
    return name;
}

void tl_pages_save(const tl_model *m, tl_archive_writer *w)
{
    char name[TL_CHUNK_NAME];
    uint64_t count = 0;
    for (const tl_page *page = m->pages; page; page = page->next) {
        const tl_page_end *end = &page->end;
        const uint64_t numbers[NUMBERS] = {end->frames, end->at, end->checked, end->digest.a,
                                           end->digest.b};
        if (end->frames == 0)
            continue;
        tl_archive_put(w, entry(name, count, "prefix"), page->prefix, 1, strlen(page->prefix));
        tl_archive_put(w, entry(name, count, "end"), numbers, sizeof *numbers, NUMBERS);
        count++;
    }
    tl_archive_put(w, "pages", &count, sizeof count, 1);
}

static bool end_is_sound(const tl_page_end *end)
{
    return end->frames > 0 && end->frames <= UINT32_MAX && end->at <= LONGEST_PAGE &&
           end->checked <= TL_PAGE_CHECKED && end->checked <= end->at;
}

static tl_status restore_page(tl_model *m, size_t k, const tl_archive *a)
{
    char prefix[LONGEST_PREFIX], name[TL_CHUNK_NAME];
    uint64_t numbers[NUMBERS];
    bool read = tl_archive_text(a, entry(name, k, "prefix"), prefix, sizeof prefix) &&
                tl_archive_get(a, entry(name, k, "end"), numbers, sizeof *numbers, NUMBERS);
    tl_page_end end = {0};
    if (read)
        end = (tl_page_end){
            numbers[FRAMES], numbers[AT], numbers[CHECKED], {numbers[DIGEST_A], numbers[DIGEST_B]}};
    if (!read || !end_is_sound(&end))
        return tl_archive_bad(a, &m->error, "a page is missing or does not fit");
    return tl_page_restore(m, prefix, end) ? TL_OK : tl_fail_memory(&m->error);
}

tl_status tl_pages_restore(tl_model *m, const tl_archive *a)
{
    uint64_t count;
    if (!tl_archive_find(a, "pages")) /* saved by a program that wrote none */
        return TL_OK;
    if (!tl_archive_get(a, "pages", &count, sizeof count, 1) || count > a->chunk_count)
        return tl_archive_bad(a, &m->error, "'pages' does not fit");
    tl_status status = TL_OK;
    for (size_t k = 0; status == TL_OK && k < count; k++)
        status = restore_page(m, k, a);
    return status;
}
