/* vtk_series.c - the names of frames' files, and ParaView's file series: see vtk_series.h. */
#include "io/vtk_series.h"

#include "base/error.h"
#include "base/number.h"
#include "io/json.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/number.h>
#include <unistd.h>

/* ---------------------------------------------------------------- series ------------------
 *
 * The names of the frames' files, and ParaView's file series: a JSON list of file names and times.
 *
 *     {"file-series-version": "1.0", "files": [{"name": "run_blocks_000000.vtk", "time": 0}, ...]}
 *
 * Names are relative to the index, so a folder of results can be moved.
 *
 * To write the whole list with every frame would take a time that grows as the square of their number. A long list is
 * written with as much blank space before its end as it has text. The entries of the frames that follow are put
 * there, each by one call within one page of the system. Such a call is done or not done however the program ends. So
 * the file is a complete list after every frame and at any moment in between. When the space is used up, or the file
 * is not the one that was written, the whole is written anew. */

/* Bytes that the system writes as one, at multiples of that: no system has smaller pages. */
#define PAGE 4096
/* Shorter lists get no space: they are cheap to write, and easy to read. */
#define LEAST_ROOMY 16

static const char before_entry[] = ",\n";
static const char tail[] = "\n  ]\n}\n";

/* Tolerance: frames of one time are listed this far apart, s, or this part of the time: too little to see, enough to
 * tell them apart. */
#define STAGE 1e-9

/* PREFIX_CONTENT and an ending. The text is the caller's; NULL when out of memory. */
static char *name_of(const tl_vtk_series *series, const char *content, const char *ending)
{
    size_t capacity = strlen(series->prefix) + strlen(content) + strlen(ending) + 2;
    char *name = malloc(capacity);
    if (name)
        snprintf(name, capacity, "%s_%s%s", series->prefix, content, ending);
    return name;
}

char *tl_vtk_frame_name(const tl_vtk_series *series, const char *content, size_t frame)
{
    char ending[32];
    snprintf(ending, sizeof ending, "_%06zu.vtk", frame);
    return name_of(series, content, ending);
}

double tl_vtk_series_time(const tl_vtk_series *series, double time)
{
    if (series->count == 0)
        return time;
    double last = series->times[series->count - 1];
    return fmax(time, last + STAGE * fmax(1, fabs(last)));
}

/* Adds one frame of the list, its time with all digits; false when out of memory. */
static bool put_entry(const tl_vtk_series *series, const char *content, size_t frame, double time, tl_piece *to)
{
    char *name = tl_vtk_frame_name(series, content, frame), number[TL_NUMBER_TEXT];
    if (!name)
        return false;
    const char *slash = strrchr(name, '/');
    tl_text_print(number, sizeof number, "%.17g", time);
    tl_json_print(to, "    {\"name\": %s, \"time\": %r}", slash ? slash + 1 : name, number);
    free(name);
    return !to->failed;
}

/* Adds all frames so far that have the file and one more at `time`. */
static bool put_list(const tl_vtk_series *series, size_t part, const char *content, double time, tl_piece *to)
{
    tl_json_put(to, "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n");
    for (size_t frame = 0; frame < series->count; frame++) {
        if (!(series->parts[frame] >> part & 1))
            continue;
        if (!put_entry(series, content, frame, series->times[frame], to))
            return false;
        tl_json_put(to, before_entry);
    }
    return put_entry(series, content, series->count, time, to);
}

/* Writes the list and notes where the next frame goes. */
static tl_status write_whole(tl_vtk_index_change *change, const tl_vtk_series *series, size_t part, const char *content,
                             double time, tl_error *error)
{
    tl_piece list = {0};
    tl_status status = put_list(series, part, content, time, &list)
                           ? tl_output_open(&change->whole, change->path, error)
                           : tl_fail_memory(error);
    if (status == TL_OK) {
        const off_t end = (off_t)list.length;
        const off_t blank = series->written[part] >= LEAST_ROOMY ? end : 0;
        tl_output_put(&change->whole, list.data, list.length);
        fprintf(change->whole.file, "%*s%s", (int)blank, "", tail);
        change->next = (tl_vtk_index){series->written[part] + 1, end, end + blank, {0}};
        status = tl_output_finish(&change->whole, error);
    }
    free(list.data);
    return status;
}

/* Opens the index for an entry that goes into its space; false when the whole is to be written anew. */
static bool open_reserved(tl_vtk_index_change *change, size_t written)
{
    const tl_vtk_index *index = change->index;
    off_t length = (off_t)change->entry.length, at = index->place, next = (at / PAGE + 1) * PAGE;
    if (at + length > next) /* within one page */
        at = next;
    if (index->frames != written || length > PAGE || at + length > index->end)
        return false;
    int file = open(change->path, O_WRONLY | O_CLOEXEC);
    if (file < 0)
        return false;
    change->file = fcntl(file, F_DUPFD_CLOEXEC, 1); /* 0 stands for none */
    close(file);
    struct stat info;
    if (change->file > 0 && fstat(change->file, &info) == 0 && S_ISREG(info.st_mode) &&
        info.st_dev == index->written.device && info.st_ino == index->written.number &&
        info.st_size == index->end + (off_t)sizeof tail - 1) {
        change->next = *index;
        change->next.frames++;
        change->next.place = at + length;
        change->at = at;
        return true;
    }
    if (change->file > 0)
        close(change->file);
    change->file = 0;
    return false;
}

tl_status tl_vtk_index_open(tl_vtk_index_change *change, tl_vtk_series *series, size_t part, const char *content,
                            double time, tl_error *error)
{
    *change = (tl_vtk_index_change){.index = &series->index[part]};
    change->path = name_of(series, content, ".vtk.series");
    tl_json_put(&change->entry, before_entry);
    if (!change->path || !put_entry(series, content, series->count, time, &change->entry))
        return tl_fail_memory(error);
    if (open_reserved(change, series->written[part]))
        return TL_OK;
    return write_whole(change, series, part, content, time, error);
}

/* Writes the entry by one call, so that it is there or not. */
static tl_status commit_entry(tl_vtk_index_change *change, tl_error *error)
{
    change->index->frames = 0; /* no longer known until it is done */
    errno = 0;
    ssize_t written = pwrite(change->file, change->entry.data, change->entry.length, change->at);
    int code = written == (ssize_t)change->entry.length ? 0 : errno ? errno : EIO;
    if (close(change->file) != 0 && code == 0)
        code = errno;
    change->file = 0;
    return code ? tl_output_fail(error, change->path, code) : TL_OK;
}

tl_status tl_vtk_index_commit(tl_vtk_index_change *change, tl_error *error)
{
    tl_status status;
    if (change->file) {
        status = commit_entry(change, error);
    } else {
        struct stat info;
        change->index->frames = 0;
        status = tl_output_commit(&change->whole, error);
        if (status == TL_OK && stat(change->path, &info) == 0)
            change->next.written = (tl_vtk_file_id){info.st_dev, info.st_ino};
    }
    if (status == TL_OK)
        *change->index = change->next;
    return status;
}

void tl_vtk_index_drop(tl_vtk_index_change *change)
{
    if (change->file)
        close(change->file);
    tl_output_drop(&change->whole);
    free(change->path);
    free(change->entry.data);
    *change = (tl_vtk_index_change){.file = 0};
}
