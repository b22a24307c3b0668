/* vtk.c - a frame for ParaView: blocks, contacts and joint faces, and the index of each series.
 *
 * The six files of a frame are all written under temporary names before the first is renamed, so
 * that a full disk or a folder without permission leaves the series as it was. */
#include "base/error.h"
#include "io/output_file.h"
#include "io/vtk_data.h"
#include "io/vtk_series.h"

#include <stdlib.h>
#include <string.h>

typedef struct part {
    const char *content; /* in the file's name */
    tl_status (*write)(tl_model *m, FILE *file);
} part;

static const part parts[] = {
    {"blocks", tl_vtk_blocks},
    {"contacts", tl_vtk_contacts},
    {"joints", tl_vtk_joints},
};

enum { PART_COUNT = sizeof parts / sizeof *parts };

/* Opens the file of that name, which is freed; NULL stands for no memory to make it. */
static tl_status open_named(tl_output *output, char *name, tl_error *error)
{
    tl_status status = name ? tl_output_open(output, name, error) : tl_fail_memory(error);
    free(name);
    return status;
}

static tl_status write_part(tl_model *m, const tl_vtk_series *series, const part *p,
                            tl_output *output)
{
    char *name = tl_vtk_frame_name(series, p->content, series->count);
    tl_status status = open_named(output, name, &m->error);
    if (status == TL_OK)
        status = p->write(m, output->file);
    return status == TL_OK ? tl_output_finish(output, &m->error) : status;
}

static tl_status write_index(tl_model *m, const tl_vtk_series *series, const part *p,
                             tl_output *output)
{
    tl_status status = open_named(output, tl_vtk_index_name(series, p->content), &m->error);
    if (status == TL_OK && !tl_vtk_series_index(series, p->content, m->time, output->file))
        status = tl_fail_memory(&m->error);
    return status == TL_OK ? tl_output_finish(output, &m->error) : status;
}

static tl_status check_prefix(const char *prefix, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT,
                       "write_vtk: prefix = '%s' must end in a name for the files, as in 'out/run'",
                       prefix);
    return TL_OK;
}

tl_status tl_write_vtk(tl_model *m, const char *prefix)
{
    tl_status status = check_prefix(prefix, &m->error);
    if (status != TL_OK)
        return status;
    tl_vtk_series *series = tl_vtk_series_of(m, prefix);
    if (!series)
        return tl_fail_memory(&m->error);

    /* The data first, then the indices, so that no index ever names a file that is not there. */
    tl_output outputs[2 * PART_COUNT] = {{0}};
    for (int i = 0; status == TL_OK && i < PART_COUNT; i++)
        status = write_part(m, series, &parts[i], &outputs[i]);
    for (int i = 0; status == TL_OK && i < PART_COUNT; i++)
        status = write_index(m, series, &parts[i], &outputs[PART_COUNT + i]);
    for (int i = 0; status == TL_OK && i < 2 * PART_COUNT; i++)
        status = tl_output_commit(&outputs[i], &m->error);
    for (int i = 0; i < 2 * PART_COUNT; i++)
        tl_output_drop(&outputs[i]);
    if (status == TL_OK)
        tl_vtk_series_add(series, m->time);
    else if (status == TL_E_IO)
        tl_error_prefix(&m->error, "write_vtk: ");
    return status;
}
