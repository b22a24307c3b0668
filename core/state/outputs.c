/* outputs.c - the files that a model has written so far, and these in an archive. A resumed run goes on with the next
 * frame, and the frames of before stay in the index. A page goes on after the frames that it had when the model was
 * saved. The frames of a page are in its file only, so what is saved is how the file ended.
 *
 *     frames             number of series; of each, from the last that was begun:
 *     frames.K.prefix    as it was given to write_vtk or write_section
 *     frames.K.kind      what its first file holds
 *     frames.K.times     of its frames, s
 *     frames.K.parts     a bit for each file of a frame
 *     pages              number of pages
 *     pages.K.prefix     as it was given to write_html
 *     pages.K.end        frames, length, bytes compared and their digest: tl_page_end */
#include "state/outputs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest prefix, kind and page, bytes, in a file. */
#define LONGEST_PREFIX 4096
#define LONGEST_KIND 64
#define LONGEST_PAGE ((uint64_t)1 << 40)

enum { FRAMES, AT, CHECKED, DIGEST_A, DIGEST_B, NUMBERS };

/* What a model keeps of the files it has written. */
typedef struct tl_outputs {
    tl_vtk_series *series;
    tl_page *pages;
} tl_outputs;

static void series_destroy(tl_vtk_series *series)
{
    while (series) {
        tl_vtk_series *next = series->next;
        free(series->prefix);
        free(series->kind);
        free(series->times);
        free(series->parts);
        free(series);
        series = next;
    }
}

static void pages_destroy(tl_page *page)
{
    while (page) {
        tl_page *next = page->next;
        if (page->scene)
            page->scene_destroy(page->scene);
        free(page->prefix);
        free(page);
        page = next;
    }
}

static void outputs_destroy(tl_outputs *o)
{
    series_destroy(o->series);
    pages_destroy(o->pages);
    free(o);
}

/* Finds or makes what is kept; NULL when out of memory. */
static tl_outputs *outputs_of(tl_model *m)
{
    if (!m->outputs && (m->outputs = calloc(1, sizeof *m->outputs)) != NULL)
        m->outputs_destroy = outputs_destroy;
    return m->outputs;
}

static bool reserve_frames(tl_vtk_series *series, size_t count)
{
    return tl_grow(&series->times, &series->time_capacity, count, sizeof *series->times) &&
           tl_grow(&series->parts, &series->part_capacity, count, sizeof *series->parts);
}

tl_vtk_series *tl_vtk_series_of(tl_model *m, const char *prefix, const char *kind)
{
    tl_outputs *o = outputs_of(m);
    if (!o)
        return NULL;
    tl_vtk_series *series = o->series;
    while (series && (strcmp(series->prefix, prefix) != 0 || strcmp(series->kind, kind) != 0))
        series = series->next;
    if (!series) {
        series = calloc(1, sizeof *series);
        if (!series)
            return NULL;
        series->prefix = strdup(prefix);
        series->kind = strdup(kind);
        if (!series->prefix || !series->kind) {
            series_destroy(series);
            return NULL;
        }
        series->next = o->series;
        o->series = series;
    }
    return reserve_frames(series, series->count + 1) ? series : NULL;
}

void tl_vtk_series_add(tl_vtk_series *series, double time, uint32_t parts)
{
    series->times[series->count] = time;
    series->parts[series->count++] = parts;
    for (unsigned k = 0; k < TL_VTK_PARTS; k++)
        series->written[k] += parts >> k & 1;
}

tl_page *tl_page_of(tl_model *m, const char *prefix)
{
    tl_outputs *o = outputs_of(m);
    if (!o)
        return NULL;
    tl_page *page = o->pages;
    while (page && strcmp(page->prefix, prefix) != 0)
        page = page->next;
    if (page)
        return page;
    page = calloc(1, sizeof *page);
    char *copy = page ? strdup(prefix) : NULL;
    if (!copy) {
        free(page);
        return NULL;
    }
    page->prefix = copy;
    page->next = o->pages;
    o->pages = page;
    return page;
}

/* ---------------------------------------------------------------- frames in an archive --- */

static void save_frames(const tl_model *m, tl_archive_writer *w)
{
    char name[TL_CHUNK_NAME];
    uint64_t count = 0;
    for (const tl_vtk_series *of = m->outputs ? m->outputs->series : NULL; of; of = of->next) {
        const size_t k = (size_t)count++;
        tl_archive_put_text(w, tl_chunk_name(name, "frames.%zu.prefix", k), of->prefix);
        tl_archive_put_text(w, tl_chunk_name(name, "frames.%zu.kind", k), of->kind);
        tl_archive_put(w, tl_chunk_name(name, "frames.%zu.times", k), of->times, sizeof *of->times, of->count);
        tl_archive_put(w, tl_chunk_name(name, "frames.%zu.parts", k), of->parts, sizeof *of->parts, of->count);
    }
    tl_archive_put(w, "frames", &count, sizeof count, 1);
}

/* Reads the frames of a series that has room for them. */
static bool read_frames(const tl_archive *a, size_t k, size_t count, tl_vtk_series *to)
{
    char name[TL_CHUNK_NAME];
    if (!tl_archive_get(a, tl_chunk_name(name, "frames.%zu.times", k), to->times, sizeof *to->times, count) ||
        !tl_archive_get(a, tl_chunk_name(name, "frames.%zu.parts", k), to->parts, sizeof *to->parts, count))
        return false;
    while (to->count < count && isfinite(to->times[to->count]) && to->parts[to->count] >> TL_VTK_PARTS == 0)
        tl_vtk_series_add(to, to->times[to->count], to->parts[to->count]);
    return to->count == count;
}

static tl_status restore_series(tl_model *m, size_t k, const tl_archive *a)
{
    char prefix[LONGEST_PREFIX], kind[LONGEST_KIND], name[TL_CHUNK_NAME];
    const size_t count = tl_archive_items(a, tl_chunk_name(name, "frames.%zu.times", k));
    tl_vtk_series *series = NULL;
    bool read = tl_archive_text(a, tl_chunk_name(name, "frames.%zu.prefix", k), prefix, sizeof prefix) &&
                tl_archive_text(a, tl_chunk_name(name, "frames.%zu.kind", k), kind, sizeof kind);
    if (read) {
        series = tl_vtk_series_of(m, prefix, kind);
        if (!series || !reserve_frames(series, count))
            return tl_fail_memory(&m->error);
        read = series->count == 0 && read_frames(a, k, count, series);
    }
    return read ? TL_OK : tl_archive_bad(a, &m->error, "a series of frames is missing or does not fit");
}

static tl_status restore_frames(tl_model *m, const tl_archive *a)
{
    uint64_t count;
    if (!tl_archive_get(a, "frames", &count, sizeof count, 1) || count > a->chunk_count)
        return tl_archive_bad(a, &m->error, "'frames' is missing or does not fit");
    for (size_t k = (size_t)count; k-- > 0;) { /* the last is found first */
        tl_status status = restore_series(m, k, a);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- pages in an archive ---- */

static void save_pages(const tl_model *m, tl_archive_writer *w)
{
    char name[TL_CHUNK_NAME];
    size_t count = 0;
    for (const tl_page *page = m->outputs ? m->outputs->pages : NULL; page; page = page->next) {
        const tl_page_end *end = &page->end;
        const uint64_t numbers[NUMBERS] = {end->frames, end->at, end->checked, end->digest.a, end->digest.b};
        if (end->frames == 0)
            continue;
        tl_archive_put_text(w, tl_chunk_name(name, "pages.%zu.prefix", count), page->prefix);
        tl_archive_put(w, tl_chunk_name(name, "pages.%zu.end", count), numbers, sizeof *numbers, NUMBERS);
        count++;
    }
    const uint64_t saved = count;
    tl_archive_put(w, "pages", &saved, sizeof saved, 1);
}

static bool end_is_sound(const tl_page_end *end)
{
    return end->frames > 0 && end->frames <= UINT32_MAX && end->at <= LONGEST_PAGE && end->checked <= TL_PAGE_CHECKED &&
           end->checked <= end->at;
}

static tl_status restore_page(tl_model *m, size_t k, const tl_archive *a)
{
    char prefix[LONGEST_PREFIX], name[TL_CHUNK_NAME];
    uint64_t numbers[NUMBERS];
    bool read = tl_archive_text(a, tl_chunk_name(name, "pages.%zu.prefix", k), prefix, sizeof prefix) &&
                tl_archive_get(a, tl_chunk_name(name, "pages.%zu.end", k), numbers, sizeof *numbers, NUMBERS);
    tl_page_end end = {0};
    if (read)
        end = (tl_page_end){numbers[FRAMES], numbers[AT], numbers[CHECKED], {numbers[DIGEST_A], numbers[DIGEST_B]}};
    if (!read || !end_is_sound(&end))
        return tl_archive_bad(a, &m->error, "a page is missing or does not fit");
    tl_page *page = tl_page_of(m, prefix);
    if (!page)
        return tl_fail_memory(&m->error);
    page->end = end;
    page->restored = true;
    return TL_OK;
}

static tl_status restore_pages(tl_model *m, const tl_archive *a)
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

/* ---------------------------------------------------------------- both ------------------- */

static void save_outputs(const tl_model *m, tl_archive_writer *w)
{
    save_pages(m, w);
    save_frames(m, w);
}

static tl_status restore_outputs(tl_model *m, const tl_archive *a)
{
    tl_status status = restore_frames(m, a);
    return status == TL_OK ? restore_pages(m, a) : status;
}

const tl_state_part tl_outputs_part = {save_outputs, restore_outputs, NULL};
