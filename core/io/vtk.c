/* vtk.c - a frame for ParaView: blocks, contacts and joint faces, or some of these, or a section, and the index of
 * each series. Files of one number are of one frame; a part that is left out of a frame has no file of that number.
 *
 * The files of a frame are all written under temporary names before the first is renamed, so
 * that a full disk or a folder without permission leaves the series as it was. */
#include "base/error.h"

#include "base/signals.h"
#include "io/output_file.h"
#include "io/vtk_data.h"
#include "io/vtk_index.h"
#include "model/options.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <talus/text.h>

typedef struct frame frame;

typedef struct part {
    const char *content; /* in the file's name */
    tl_status (*write)(tl_model *m, const frame *f, tl_pieces *out);
} part;

/* What is written: the parts of a kind of frame whose bits are set. */
struct frame {
    const char *function; /* of the user's */
    const part *parts;
    size_t count;
    unsigned wanted;
    const tl_plane *section;    /* of a section */
    const tl_vtk_parts *fields; /* of a whole frame: what is added to its arrays */
};

static tl_status write_blocks(tl_model *m, const frame *f, tl_pieces *out)
{
    return tl_vtk_blocks(m, f->fields, out);
}

static tl_status write_contacts(tl_model *m, const frame *f, tl_pieces *out)
{
    return tl_vtk_contacts(m, f->fields, out);
}

static tl_status write_joints(tl_model *m, const frame *f, tl_pieces *out)
{
    return tl_vtk_joints(m, f->fields, out);
}

static tl_status write_section(tl_model *m, const frame *f, tl_pieces *out)
{
    return tl_vtk_section(m, *f->section, out);
}

enum { BLOCKS, CONTACTS, JOINTS, PART_COUNT };

static const part frame_parts[PART_COUNT] = {
    [BLOCKS] = {"blocks", write_blocks},
    [CONTACTS] = {"contacts", write_contacts},
    [JOINTS] = {"joints", write_joints},
};

static const part section_part = {"section", write_section};

static_assert(PART_COUNT <= TL_VTK_PARTS, "a series has an index for each file of a frame");

static bool wants(const frame *f, size_t i)
{
    return f->wanted >> i & 1;
}

static tl_status write_part(tl_model *m, const tl_vtk_series *series, const frame *f, size_t i,
                            tl_pieces *pieces, tl_output *output)
{
    const part *p = &f->parts[i];
    char *name = tl_vtk_frame_name(series, p->content, series->count);
    tl_status status = name ? tl_output_open(output, name, &m->error) : tl_fail_memory(&m->error);
    free(name);
    if (status == TL_OK)
        status = tl_output_go_on(m);
    pieces->output = output;
    if (status == TL_OK)
        status = p->write(m, f, pieces);
    return status == TL_OK ? tl_output_finish(output, &m->error) : status;
}

static tl_status check_prefix(const char *function, const char *prefix, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: prefix = '%s' must end in a name for the files, as in 'out/run'",
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
            status =
                tl_vtk_index_open(&indices[i], series, i, f->parts[i].content, time, &m->error);
    if (status == TL_OK)
        status = tl_output_go_on(m);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = tl_output_commit(&data[i], &m->error);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = tl_vtk_index_commit(&indices[i], &m->error);
    for (size_t i = 0; i < f->count; i++) {
        tl_output_drop(&data[i]);
        tl_vtk_index_drop(&indices[i]);
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
    double time = tl_vtk_series_time(series, m->time);
    status = write_files(m, series, f, time);
    tl_signals_release(&before);
    if (status == TL_OK)
        tl_vtk_series_add(series, (tl_vtk_frame){time, f->wanted});
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
    if (!(plane->dip >= 0 && plane->dip <= 90) || !isfinite(plane->dip_direction) ||
        !tl_v3_finite(plane->origin))
        return tl_fail(
            &m->error, TL_E_ARGUMENT,
            "write_section: dip = %g must be in [0, 90], dip_direction and origin finite",
            plane->dip);
    tl_vec3 normal = tl_plane_normal(plane->dip, plane->dip_direction);
    tl_plane section = {normal, tl_v3_dot(normal, tl_v3_sub(plane->origin, m->origin))};
    const frame f = {"write_section", &section_part, 1, 1, &section, NULL};
    return write_frame(m, prefix, &f);
}
