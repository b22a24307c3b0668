/* vtk_series.c - the frames of each prefix, and the names of their files. */
#include "io/vtk_series.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Frames of one time are listed this far apart, s, or this part of the time: too little to see, enough to tell them apart. */
#define STAGE 1e-9

static void series_destroy(tl_vtk_series *series)
{
    while (series) {
        tl_vtk_series *next = series->next;
        free(series->prefix);
        free(series->kind);
        free(series->frames);
        free(series);
        series = next;
    }
}

static bool reserve_frame(tl_vtk_series *series)
{
    if (series->count < series->capacity)
        return true;
    size_t capacity = series->capacity ? 2 * series->capacity : 16;
    tl_vtk_frame *frames = realloc(series->frames, capacity * sizeof *frames);
    if (!frames)
        return false;
    series->frames = frames;
    series->capacity = capacity;
    return true;
}

tl_vtk_series *tl_vtk_series_of(tl_model *m, const char *prefix, const char *kind)
{
    tl_vtk_series *series = m->vtk;
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
        series->next = m->vtk;
        m->vtk = series;
        m->vtk_destroy = series_destroy;
    }
    return reserve_frame(series) ? series : NULL;
}

char *tl_vtk_frame_name(const tl_vtk_series *series, const char *content, size_t frame)
{
    size_t capacity = strlen(series->prefix) + strlen(content) + 32;
    char *name = malloc(capacity);
    if (name)
        snprintf(name, capacity, "%s_%s_%06zu.vtk", series->prefix, content, frame);
    return name;
}

char *tl_vtk_index_name(const tl_vtk_series *series, const char *content)
{
    size_t capacity = strlen(series->prefix) + strlen(content) + 32;
    char *name = malloc(capacity);
    if (name)
        snprintf(name, capacity, "%s_%s.vtk.series", series->prefix, content);
    return name;
}

double tl_vtk_series_time(const tl_vtk_series *series, double time)
{
    if (series->count == 0)
        return time;
    double last = series->frames[series->count - 1].time;
    return fmax(time, last + STAGE * fmax(1, fabs(last)));
}

void tl_vtk_series_add(tl_vtk_series *series, tl_vtk_frame frame)
{
    series->frames[series->count++] = frame;
    for (unsigned k = 0; k < TL_VTK_PARTS; k++)
        series->written[k] += frame.parts >> k & 1;
}
