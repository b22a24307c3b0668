/* vtk_file.c - legacy VTK, version 3.0, binary: VTK User's Guide, "VTK File Formats". */
#include "io/vtk_file.h"

#include "base/error.h"
#include "model/scope.h"
#include "zone/zones.h"

#include <string.h>

static void put_double(FILE *file, double value)
{
    unsigned char bytes[sizeof value];
    tl_vtk_put_double(bytes, value);
    fwrite(bytes, 1, sizeof bytes, file);
}

/* A text goes after its length, whose two highest bits tell how many bytes the length takes. */
static void put_string(FILE *file, const char *text)
{
    size_t length = strlen(text);
    const unsigned bytes = length < (size_t)1 << 6 ? 1 : length < (size_t)1 << 14 ? 2 : 4;
    const uint32_t mark = bytes == 1 ? 3 : bytes == 2 ? 2 : 1;
    unsigned char head[TL_VTK_INT_BYTES];
    tl_vtk_put_int(head, (int32_t)(mark << 30 | (uint32_t)length << (32 - 8 * bytes)));
    fwrite(head, 1, bytes, file);
    fwrite(text, 1, length, file);
}

void tl_vtk_field(FILE *file, const char *name, size_t arrays)
{
    fprintf(file, "FIELD %s %zu\n", name, arrays);
}

void tl_vtk_array(FILE *file, const char *name, size_t components, size_t tuples, const char *type)
{
    fprintf(file, "%s %zu %zu %s\n", name, components, tuples, type);
}

void tl_vtk_line(FILE *file)
{
    fputc('\n', file);
}

tl_status tl_vtk_list(tl_pieces *out, size_t rows, size_t bytes, tl_piece_fn fn, const void *user)
{
    tl_status status = tl_pieces_write(out, rows, 1 + bytes / (rows + 1), fn, user);
    tl_vtk_line(out->output->file);
    return status;
}

static void put_laws(FILE *file, const tl_model *m)
{
    char law[TL_LAW_TEXT];
    tl_vtk_array(file, "law_names", 1, m->joint_law_count + 1, TL_VTK_STRING);
    put_string(file, ""); /* law 0 is none */
    for (size_t i = 0; i < m->joint_law_count; i++)
        put_string(file, tl_law_text(m, &m->joint_laws[i], law));
    tl_vtk_line(file);
}

void tl_vtk_header(FILE *file, const tl_model *m, const char *content, const char *dataset, bool laws)
{
    fprintf(file, "# vtk DataFile Version 3.0\nTalus %s: %s, cycle %lld\nBINARY\nDATASET %s\n", TALUS_VERSION, content,
            (long long)m->cycles, dataset);

    const bool deforms = tl_model_deforms(m);
    tl_vtk_field(file, "FieldData", 3 + (size_t)laws + (size_t)(m->group_count > 0) + (size_t)deforms);
    tl_vtk_array(file, "TIME", 1, 1, TL_VTK_DOUBLE);
    put_double(file, m->time);
    tl_vtk_line(file);
    /* As a double: a long run counts past 32 bits. */
    tl_vtk_array(file, "CYCLE", 1, 1, TL_VTK_DOUBLE);
    put_double(file, (double)m->cycles);
    tl_vtk_line(file);
    tl_vtk_array(file, "joint_names", 1, m->joint_count + 1, TL_VTK_STRING);
    put_string(file, ""); /* joint 0 is none */
    for (size_t i = 0; i < m->joint_count; i++)
        put_string(file, m->joints[i].name);
    tl_vtk_line(file);
    if (laws)
        put_laws(file, m);
    if (m->group_count > 0) {
        tl_vtk_array(file, "group_names", 1, m->group_count, TL_VTK_STRING);
        for (size_t i = 0; i < m->group_count; i++)
            put_string(file, m->groups[i]);
        tl_vtk_line(file);
    }
    if (deforms) {
        tl_vtk_array(file, "solid_names", 1, m->zones->solid_count, TL_VTK_STRING);
        for (size_t i = 0; i < m->zones->solid_count; i++)
            put_string(file, m->zones->solid[i].name);
        tl_vtk_line(file);
    }
}

tl_status tl_vtk_countable(size_t count, const char *content, tl_error *error)
{
    if (count > INT32_MAX)
        return tl_fail(error, TL_E_IO,
                       "cannot write the %s: %zu numbers are more than the %d a legacy VTK file can count", content,
                       count, INT32_MAX);
    return TL_OK;
}
