/* vtk_series.c - ParaView's file series: a JSON list of file names and times.
 *
 *     {"file-series-version": "1.0", "files": [{"name": "run_blocks_000000.vtk", "time": 0}, ...]}
 *
 * Names are relative to the index, so a folder of results can be moved. */
#include "io/vtk_series.h"

#include <stdlib.h>
#include <string.h>

static void series_destroy(tl_vtk_series *series)
{
    while (series) {
        tl_vtk_series *next = series->next;
        free(series->prefix);
        free(series->times);
        free(series);
        series = next;
    }
}

static bool make_room(tl_vtk_series *series)
{
    if (series->count < series->capacity)
        return true;
    size_t capacity = series->capacity ? 2 * series->capacity : 16;
    double *times = realloc(series->times, capacity * sizeof *times);
    if (!times)
        return false;
    series->times = times;
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
        if (!series->prefix) {
            free(series);
            return NULL;
        }
        series->kind = kind;
        series->next = m->vtk;
        m->vtk = series;
        m->vtk_destroy = series_destroy;
    }
    return make_room(series) ? series : NULL;
}

char *tl_vtk_frame_name(const tl_vtk_series *series, const char *content, size_t frame)
{
    size_t room = strlen(series->prefix) + strlen(content) + 32;
    char *name = malloc(room);
    if (name)
        snprintf(name, room, "%s_%s_%06zu.vtk", series->prefix, content, frame);
    return name;
}

char *tl_vtk_index_name(const tl_vtk_series *series, const char *content)
{
    size_t room = strlen(series->prefix) + strlen(content) + 32;
    char *name = malloc(room);
    if (name)
        snprintf(name, room, "%s_%s.vtk.series", series->prefix, content);
    return name;
}

static void put_json_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            fprintf(file, "\\%c", *text);
        else if ((unsigned char)*text < 0x20)
            fprintf(file, "\\u%04x", (unsigned)(unsigned char)*text);
        else
            fputc(*text, file);
    }
    fputc('"', file);
}

/* With all digits, and a decimal point whatever the locale of the process writes. */
static void put_json_number(FILE *file, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g", value);
    char *comma = strchr(text, ',');
    if (comma)
        *comma = '.';
    fputs(text, file);
}

bool tl_vtk_series_index(const tl_vtk_series *series, const char *content, double time, FILE *file)
{
    fprintf(file, "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n");
    for (size_t frame = 0; frame <= series->count; frame++) {
        char *name = tl_vtk_frame_name(series, content, frame);
        if (!name)
            return false;
        const char *slash = strrchr(name, '/');
        fprintf(file, "    {\"name\": ");
        put_json_text(file, slash ? slash + 1 : name);
        fprintf(file, ", \"time\": ");
        put_json_number(file, frame < series->count ? series->times[frame] : time);
        fprintf(file, "}%s\n", frame < series->count ? "," : "");
        free(name);
    }
    fprintf(file, "  ]\n}\n");
    return true;
}

void tl_vtk_series_add(tl_vtk_series *series, double time)
{
    series->times[series->count++] = time;
}
