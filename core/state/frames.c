/* frames.c - the frames of VTK files written so far, in an archive: a resumed run goes on with the next number, and the frames of
 * before stay in the index.
 *
 *     frames             number of series; of each, from the last that was begun:
 *     frames.K.prefix    as it was given to write_vtk or write_section
 *     frames.K.kind      what its first file holds
 *     frames.K.times     of its frames, s
 *     frames.K.parts     a bit for each file of a frame */
#include "state/frames.h"

#include "io/vtk_series.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest prefix and kind in a file. */
#define LONGEST_PREFIX 4096
#define LONGEST_KIND 64

/* The name of an entry of series `k`. */
static const char *entry(char name[TL_CHUNK_NAME], size_t k, const char *what)
{
    snprintf(name, TL_CHUNK_NAME, "frames.%zu.%.16s", k, what);
    return name;
}

static bool save_series(const tl_vtk_series *series, size_t k, tl_archive_writer *w)
{
    char name[TL_CHUNK_NAME];
    double *times = malloc((series->count + 1) * sizeof *times);
    uint32_t *parts = malloc((series->count + 1) * sizeof *parts);
    bool enough = times && parts;
    for (size_t i = 0; enough && i < series->count; i++) {
        times[i] = series->frames[i].time;
        parts[i] = series->frames[i].parts;
    }
    if (enough) {
        tl_archive_put(w, entry(name, k, "prefix"), series->prefix, 1, strlen(series->prefix));
        tl_archive_put(w, entry(name, k, "kind"), series->kind, 1, strlen(series->kind));
        tl_archive_put(w, entry(name, k, "times"), times, sizeof *times, series->count);
        tl_archive_put(w, entry(name, k, "parts"), parts, sizeof *parts, series->count);
    }
    free(times);
    free(parts);
    return enough;
}

bool tl_frames_save(const tl_model *m, tl_archive_writer *w)
{
    uint64_t count = 0;
    for (const tl_vtk_series *series = m->vtk; series; series = series->next)
        if (!save_series(series, count++, w))
            return false;
    tl_archive_put(w, "frames", &count, sizeof count, 1);
    return true;
}

static tl_status add_frames(tl_model *m, const char *prefix, const char *kind, const double *times,
                            const uint32_t *parts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        tl_vtk_series *series = tl_vtk_series_of(m, prefix, kind);
        if (!series)
            return tl_fail_memory(&m->error);
        tl_vtk_series_add(series, (tl_vtk_frame){times[i], parts[i]});
    }
    return TL_OK;
}

static bool frames_are_sound(const double *times, const uint32_t *parts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(times[i]) || parts[i] >> TL_VTK_PARTS != 0)
            return false;
    return true;
}

static tl_status restore_series(tl_model *m, size_t k, const tl_archive *a)
{
    char prefix[LONGEST_PREFIX], kind[LONGEST_KIND], name[TL_CHUNK_NAME];
    const tl_chunk *chunk = tl_archive_find(a, entry(name, k, "times"));
    size_t count = chunk && chunk->items < UINT32_MAX ? (size_t)chunk->items : 0;
    double *times = malloc((count + 1) * sizeof *times);
    uint32_t *parts = malloc((count + 1) * sizeof *parts);
    tl_status status = times && parts ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK &&
        !(tl_archive_text(a, entry(name, k, "prefix"), prefix, sizeof prefix) &&
          tl_archive_text(a, entry(name, k, "kind"), kind, sizeof kind) &&
          tl_archive_get(a, entry(name, k, "times"), times, sizeof *times, count) &&
          tl_archive_get(a, entry(name, k, "parts"), parts, sizeof *parts, count) &&
          frames_are_sound(times, parts, count)))
        status = tl_archive_bad(a, &m->error, "a series of frames is missing or does not fit");
    if (status == TL_OK)
        status = add_frames(m, prefix, kind, times, parts, count);
    free(times);
    free(parts);
    return status;
}

tl_status tl_frames_restore(tl_model *m, const tl_archive *a)
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
