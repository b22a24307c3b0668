/* vtk_index.c - ParaView's file series: a JSON list of file names and times.
 *
 *     {"file-series-version": "1.0", "files": [{"name": "run_blocks_000000.vtk", "time": 0}, ...]}
 *
 * Names are relative to the index, so a folder of results can be moved.
 *
 * To write the whole list with every frame would take a time that grows as the square of their number. A long list is
 * written with as much blank room before its end as it has text, and the entries of the frames that follow are put there:
 * one call to write each, within one page of the system, which is done or not done however the program ends. So the file
 * is a complete list after every frame and at any moment in between. When the room is used up, or the file is not the one
 * that was written, the whole is written anew. */
#include "io/vtk_index.h"

#include "base/error.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/number.h>
#include <unistd.h>

/* Bytes that the system writes as one, at multiples of that: no system has smaller pages. */
#define PAGE 4096
/* Shorter lists get no room: they are cheap to write, and easy to read. */
#define LEAST_ROOMY 16

static const char before_entry[] = ",\n";
static const char tail[] = "\n  ]\n}\n";

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

/* With all digits. */
static void put_json_number(FILE *file, double value)
{
    char text[32];
    tl_text_print(text, sizeof text, "%.17g", value);
    fputs(text, file);
}

/* One frame of the list; false when out of memory. */
static bool put_entry(const tl_vtk_series *series, const char *content, size_t frame, double time,
                      FILE *file)
{
    char *name = tl_vtk_frame_name(series, content, frame);
    if (!name)
        return false;
    const char *slash = strrchr(name, '/');
    fprintf(file, "    {\"name\": ");
    put_json_text(file, slash ? slash + 1 : name);
    fprintf(file, ", \"time\": ");
    put_json_number(file, time);
    fprintf(file, "}");
    free(name);
    return true;
}

/* Writes the list with all frames so far that have the file and one more at `time`, and notes where the next goes. */
static tl_status write_whole(tl_vtk_index_change *change, const tl_vtk_series *series, size_t part,
                             const char *content, double time, tl_error *error)
{
    tl_status status = tl_output_open(&change->whole, change->path, error);
    if (status != TL_OK)
        return status;
    FILE *file = change->whole.file;
    fprintf(file, "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [\n");
    for (size_t frame = 0; frame <= series->count; frame++) {
        bool last = frame == series->count;
        if (!last && !(series->frames[frame].parts >> part & 1))
            continue;
        if (!put_entry(series, content, frame, last ? time : series->frames[frame].time, file))
            return tl_fail_memory(error);
        if (!last)
            fputs(before_entry, file);
    }
    off_t end = ftello(file);
    off_t blank = series->written[part] >= LEAST_ROOMY && end > 0 ? end : 0;
    for (off_t i = 0; i < blank; i++)
        fputc(' ', file);
    fputs(tail, file);
    change->next = (tl_vtk_index){series->written[part] + 1, end, end + blank, {0}};
    return tl_output_finish(&change->whole, error);
}

/* The text that the next frame adds to the list; NULL when out of memory. */
static char *entry_text(const tl_vtk_series *series, const char *content, double time,
                        size_t *length)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, length);
    if (!file)
        return NULL;
    fputs(before_entry, file);
    bool good = put_entry(series, content, series->count, time, file) && !ferror(file);
    if (fclose(file) == 0 && good)
        return text;
    free(text);
    return NULL;
}

/* Opens the index for an entry that goes into its room; false when the whole is to be written anew. */
static bool open_reserved(tl_vtk_index_change *change, size_t written)
{
    const tl_vtk_index *index = change->index;
    off_t length = (off_t)change->length, at = index->place, next = (at / PAGE + 1) * PAGE;
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

tl_status tl_vtk_index_open(tl_vtk_index_change *change, tl_vtk_series *series, size_t part,
                            const char *content, double time, tl_error *error)
{
    *change = (tl_vtk_index_change){.index = &series->index[part]};
    change->path = tl_vtk_index_name(series, content);
    change->entry = entry_text(series, content, time, &change->length);
    if (!change->path || !change->entry)
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
    ssize_t written = pwrite(change->file, change->entry, change->length, change->at);
    int code = written == (ssize_t)change->length ? 0 : errno ? errno : EIO;
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
    free(change->entry);
    *change = (tl_vtk_index_change){.file = 0};
}
