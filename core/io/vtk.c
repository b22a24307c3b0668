/* vtk.c - a frame for ParaView: blocks, contacts and joint faces, or some of these, or a section, and the index of
 * each series. Files of one number are of one frame; a part that is left out of a frame has no file of that number.
 *
 * The files of a frame are all written under temporary names before the first is renamed. So a full disk or a folder
 * without permission leaves the series as it was. */

#include "base/error.h"
#include "base/number.h"
#include "base/output_file.h"
#include "base/signals.h"
#include "io/json.h"
#include "io/pieces.h"
#include "io/vtk_blocks.h"
#include "io/vtk_contacts.h"
#include "model/options.h"
#include "model/rows.h"
#include "state/outputs.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/number.h>
#include <talus/text.h>
#include <unistd.h>

/* A change of an index on its way: an entry that goes into the space it has, or the whole of it anew. */
typedef struct tl_vtk_index_change {
    tl_output whole;
    tl_vtk_index *index; /* as it is */
    tl_vtk_index next;   /* as it will be */
    char *path;
    tl_piece entry;
    off_t at; /* where it goes */
    int file; /* descriptor to write it to; 0: the whole is written anew */
} tl_vtk_index_change;

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
 * tell them
 * apart. */
#define STAGE 1e-9

/* Name of a file of the series: PREFIX_CONTENT_NNNNNN.vtk. The text is the caller's; NULL when out of memory. */
static char *vtk_frame_name(const tl_vtk_series *series, const char *content, size_t frame)
{
    size_t capacity = strlen(series->prefix) + strlen(content) + 32;
    char *name = malloc(capacity);
    if (name)
        snprintf(name, capacity, "%s_%s_%06zu.vtk", series->prefix, content, frame);
    return name;
}

/* Name of its index: PREFIX_CONTENT.vtk.series. */
static char *index_name(const tl_vtk_series *series, const char *content)
{
    size_t capacity = strlen(series->prefix) + strlen(content) + 32;
    char *name = malloc(capacity);
    if (name)
        snprintf(name, capacity, "%s_%s.vtk.series", series->prefix, content);
    return name;
}

/* The time under which the next frame is listed: that of the model, or a little more than that of the frame before.
 * Readers take frames of one time for one frame, so stages without a step between them would not be seen. */
static double vtk_series_time(const tl_vtk_series *series, double time)
{
    if (series->count == 0)
        return time;
    double last = series->times[series->count - 1];
    return fmax(time, last + STAGE * fmax(1, fabs(last)));
}

/* Adds one frame of the list, its time with all digits; false when out of memory. */
static bool put_entry(const tl_vtk_series *series, const char *content, size_t frame, double time, tl_piece *to)
{
    char *name = vtk_frame_name(series, content, frame), number[TL_NUMBER_TEXT];
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

/* Makes ready what adds the next frame, at `time`, to the index of `content`, number `part` of the series. */
static tl_status vtk_index_open(tl_vtk_index_change *change, tl_vtk_series *series, size_t part, const char *content,
                                double time, tl_error *error)
{
    *change = (tl_vtk_index_change){.index = &series->index[part]};
    change->path = index_name(series, content);
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

static tl_status vtk_index_commit(tl_vtk_index_change *change, tl_error *error)
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

/* Frees; what is not committed is dropped. Does nothing to a zeroed or dropped change. */
static void vtk_index_drop(tl_vtk_index_change *change)
{
    if (change->file)
        close(change->file);
    tl_output_drop(&change->whole);
    free(change->path);
    free(change->entry.data);
    *change = (tl_vtk_index_change){.file = 0};
}

/* ---------------------------------------------------------------- frames ------------------ */

typedef struct part {
    const char *content; /* in the file's name */
    tl_status (*write)(tl_model *m, const tl_vtk_parts *fields, tl_pieces *out);
} part;

/* What is written: the parts of a kind of frame whose bits are set. */
typedef struct frame {
    const char *function; /* of the user's */
    const part *parts;
    size_t count;
    unsigned wanted;
    const tl_plane *section;    /* of a section */
    const tl_vtk_parts *fields; /* of a whole frame: what is added to its arrays */
} frame;

enum { BLOCKS, CONTACTS, JOINTS, PART_COUNT };

static const part frame_parts[PART_COUNT] = {
    [BLOCKS] = {"blocks", tl_vtk_blocks},
    [CONTACTS] = {"contacts", tl_vtk_contacts},
    [JOINTS] = {"joints", tl_vtk_joints},
};

static const part section_part = {"section", NULL};

static_assert(PART_COUNT <= TL_VTK_PARTS, "a series has an index for each file of a frame");

static bool wants(const frame *f, size_t i)
{
    return f->wanted >> i & 1;
}

static tl_status write_part(tl_model *m, const tl_vtk_series *series, const frame *f, size_t i, tl_pieces *pieces,
                            tl_output *output)
{
    const part *p = &f->parts[i];
    char *name = vtk_frame_name(series, p->content, series->count);
    tl_status status = name ? tl_output_open(output, name, &m->error) : tl_fail_memory(&m->error);
    free(name);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    pieces->output = output;
    if (status == TL_OK)
        status = f->section ? tl_vtk_section(m, *f->section, pieces) : p->write(m, f->fields, pieces);
    return status == TL_OK ? tl_output_finish(output, &m->error) : status;
}

static tl_status check_prefix(const char *function, const char *prefix, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT, "%s: prefix = '%s' must end in a name for the files, as in 'out/run'",
                       function, prefix);
    const char *slash = strrchr(prefix, '/');
    if (!tl_text_is_utf8(slash ? slash + 1 : prefix))
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: prefix = '%s' must end in a name in UTF-8, as the list of the frames "
                       "has it, which is JSON",
                       function, prefix);
    return TL_OK;
}

/* The data first, then the indices, so that no index ever names a file that is not there. */
static tl_status write_files(tl_model *m, tl_vtk_series *series, const frame *f, double time)
{
    tl_output data[PART_COUNT] = {{0}};
    tl_vtk_index_change indices[PART_COUNT] = {{.file = 0}};
    tl_pieces pieces = {.model = m};
    tl_status status = TL_OK;
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = write_part(m, series, f, i, &pieces, &data[i]);
    tl_pieces_free(&pieces);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = vtk_index_open(&indices[i], series, i, f->parts[i].content, time, &m->error);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = tl_output_commit(&data[i], &m->error);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = vtk_index_commit(&indices[i], &m->error);
    for (size_t i = 0; i < f->count; i++) {
        tl_output_drop(&data[i]);
        vtk_index_drop(&indices[i]);
    }
    return status;
}

/* Writes the next frame of the series of that prefix and kind. */
static tl_status write_frame(tl_model *m, const char *prefix, const frame *f)
{
    tl_status status = check_prefix(f->function, prefix, &m->error);
    if (status != TL_OK)
        return status;
    char *own = tl_output_prefix(prefix, ".vtk");
    tl_vtk_series *series = own ? tl_vtk_series_of(m, own, f->parts[0].content) : NULL;
    free(own);
    if (!series)
        return tl_fail_memory(&m->error);

    sigset_t before;
    tl_signals_hold(&before, false);
    atomic_store(&m->interrupted, false);
    double time = vtk_series_time(series, m->time);
    status = write_files(m, series, f, time);
    tl_signals_release(&before);
    if (status == TL_OK)
        tl_vtk_series_add(series, time, f->wanted);
    else if (status == TL_E_IO)
        tl_error_prefix(&m->error, "%s: ", f->function);
    return status;
}

tl_status tl_write_vtk(tl_model *m, const char *prefix, const tl_vtk_parts *parts)
{
    tl_vtk_parts read;
    const tl_vtk_parts *of = &read;
    tl_status status = TL_OPTIONS_READ(tl_vtk_parts, parts, &read, &m->error);
    if (status != TL_OK)
        return status;
    frame f = {.function = "write_vtk", .parts = frame_parts, .count = PART_COUNT, .fields = of};
    f.wanted = (unsigned)(of->blocks != 0) << BLOCKS | (unsigned)(of->contacts != 0) << CONTACTS |
               (unsigned)(of->joints != 0) << JOINTS;
    if (f.wanted == 0)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "write_vtk: blocks, contacts and joints are all false, so there is nothing "
                       "to write; leave out what is to be written");
    tl_rows_tidy(m);
    return write_frame(m, prefix, &f);
}

tl_status tl_write_section(tl_model *m, const char *prefix, const tl_halfspace *plane)
{
    tl_rows_tidy(m);
    if (!(plane->dip >= 0 && plane->dip <= 90) || !isfinite(plane->dip_direction) || !tl_v3_finite(plane->origin))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "write_section: dip = %g must be in [0, 90], dip_direction and origin finite", plane->dip);
    tl_vec3 normal = tl_plane_normal(plane->dip, plane->dip_direction);
    tl_plane section = {normal, tl_v3_dot(normal, tl_v3_sub(plane->origin, m->origin))};
    const frame f = {"write_section", &section_part, 1, 1, &section, NULL};
    return write_frame(m, prefix, &f);
}
