/* vtk.c - a frame for ParaView: blocks, contacts and joint faces, or a section, and the index of each
 * series.
 *
 * The files of a frame are all written under temporary names before the first is renamed, so
 * that a full disk or a folder without permission leaves the series as it was. */
#include "base/error.h"
#include "base/signals.h"
#include "io/output_file.h"
#include "io/vtk_data.h"
#include "io/vtk_index.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

typedef struct part {
    const char *content; /* in the file's name */
    tl_status (*write)(tl_model *m, const tl_plane *section, FILE *file);
} part;

static tl_status write_blocks(tl_model *m, const tl_plane *section, FILE *file)
{
    (void)section;
    return tl_vtk_blocks(m, file);
}

static tl_status write_contacts(tl_model *m, const tl_plane *section, FILE *file)
{
    (void)section;
    return tl_vtk_contacts(m, file);
}

static tl_status write_joints(tl_model *m, const tl_plane *section, FILE *file)
{
    (void)section;
    return tl_vtk_joints(m, file);
}

static tl_status write_section(tl_model *m, const tl_plane *section, FILE *file)
{
    return tl_vtk_section(m, *section, file);
}

static const part frame_parts[] = {
    {"blocks", write_blocks},
    {"contacts", write_contacts},
    {"joints", write_joints},
};

static const part section_part = {"section", write_section};

enum { PART_COUNT = sizeof frame_parts / sizeof *frame_parts };
static_assert(PART_COUNT <= TL_VTK_PARTS, "a series has an index for each file of a frame");

static tl_status write_part(tl_model *m, const tl_vtk_series *series, const part *p,
                            const tl_plane *section, tl_output *output)
{
    char *name = tl_vtk_frame_name(series, p->content, series->count);
    tl_status status = name ? tl_output_open(output, name, &m->error) : tl_fail_memory(&m->error);
    free(name);
    if (status == TL_OK)
        status = tl_output_go_on(m);
    if (status == TL_OK)
        status = p->write(m, section, output->file);
    return status == TL_OK ? tl_output_finish(output, &m->error) : status;
}

static tl_status check_prefix(const char *function, const char *prefix, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: prefix = '%s' must end in a name for the files, as in 'out/run'",
                       function, prefix);
    return TL_OK;
}

/* The data first, then the indices, so that no index ever names a file that is not there. */
static tl_status write_files(tl_model *m, tl_vtk_series *series, const part *parts, int count,
                             const tl_plane *section)
{
    tl_output data[PART_COUNT] = {{0}};
    tl_vtk_index_change indices[PART_COUNT] = {{.file = 0}};
    tl_status status = TL_OK;
    for (int i = 0; status == TL_OK && i < count; i++)
        status = write_part(m, series, &parts[i], section, &data[i]);
    for (int i = 0; status == TL_OK && i < count; i++)
        status =
            tl_vtk_index_open(&indices[i], series, (size_t)i, parts[i].content, m->time, &m->error);
    if (status == TL_OK)
        status = tl_output_go_on(m);
    for (int i = 0; status == TL_OK && i < count; i++)
        status = tl_output_commit(&data[i], &m->error);
    for (int i = 0; status == TL_OK && i < count; i++)
        status = tl_vtk_index_commit(&indices[i], &m->error);
    for (int i = 0; i < count; i++) {
        tl_output_drop(&data[i]);
        tl_vtk_index_drop(&indices[i]);
    }
    return status;
}

/* Writes the next frame, of `count` files, of the series of that prefix and kind. */
static tl_status write_frame(tl_model *m, const char *function, const char *prefix,
                             const part *parts, int count, const tl_plane *section)
{
    tl_status status = check_prefix(function, prefix, &m->error);
    if (status != TL_OK)
        return status;
    tl_vtk_series *series = tl_vtk_series_of(m, prefix, parts[0].content);
    if (!series)
        return tl_fail_memory(&m->error);

    sigset_t before;
    tl_signals_hold(&before, false);
    atomic_store(&m->interrupted, false);
    status = write_files(m, series, parts, count, section);
    tl_signals_release(&before);
    if (status == TL_OK)
        tl_vtk_series_add(series, m->time);
    else if (status == TL_E_IO)
        tl_error_prefix(&m->error, "%s: ", function);
    return status;
}

tl_status tl_write_vtk(tl_model *m, const char *prefix)
{
    return write_frame(m, "write_vtk", prefix, frame_parts, PART_COUNT, NULL);
}

tl_status tl_write_section(tl_model *m, const char *prefix, const tl_halfspace *plane)
{
    if (!(plane->dip >= 0 && plane->dip <= 90) || !isfinite(plane->dip_direction) ||
        !tl_v3_finite(plane->origin))
        return tl_fail(
            &m->error, TL_E_ARGUMENT,
            "write_section: dip = %g must be in [0, 90], dip_direction and origin finite",
            plane->dip);
    tl_vec3 normal = tl_plane_normal(plane->dip, plane->dip_direction);
    tl_plane section = {normal, tl_v3_dot(normal, tl_v3_sub(plane->origin, m->origin))};
    return write_frame(m, "write_section", prefix, &section_part, 1, &section);
}
