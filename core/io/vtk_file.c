/* vtk_file.c - legacy VTK, version 3.0, binary: VTK User's Guide, "VTK File Formats". */
#include "io/vtk_file.h"

#include "base/error.h"

#include <string.h>

static void put_bytes(FILE *file, uint64_t bits, int bytes)
{
    unsigned char big[8];
    for (int i = 0; i < bytes; i++)
        big[i] = (unsigned char)(bits >> (8 * (bytes - 1 - i)));
    fwrite(big, 1, (size_t)bytes, file);
}

void tl_vtk_int(FILE *file, int32_t value)
{
    put_bytes(file, (uint32_t)value, 4);
}

void tl_vtk_double(FILE *file, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bytes(file, bits, 8);
}

void tl_vtk_vec3(FILE *file, tl_vec3 value)
{
    tl_vtk_double(file, value.x);
    tl_vtk_double(file, value.y);
    tl_vtk_double(file, value.z);
}

/* A text goes after its length, whose two highest bits tell how many bytes the length takes. */
void tl_vtk_string(FILE *file, const char *text)
{
    size_t length = strlen(text);
    if (length < (size_t)1 << 6)
        put_bytes(file, (uint64_t)3 << 6 | length, 1);
    else if (length < (size_t)1 << 14)
        put_bytes(file, (uint64_t)2 << 14 | length, 2);
    else
        put_bytes(file, (uint64_t)1 << 30 | length, 4);
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

void tl_vtk_header(FILE *file, const tl_model *m, const char *content, const char *dataset)
{
    fprintf(file, "# vtk DataFile Version 3.0\nTalus %s: %s, cycle %lld\nBINARY\nDATASET %s\n",
            TALUS_VERSION, content, (long long)m->cycles, dataset);

    tl_vtk_field(file, "FieldData", m->group_count > 0 ? 4 : 3);
    tl_vtk_array(file, "TIME", 1, 1, TL_VTK_DOUBLE);
    tl_vtk_double(file, m->time);
    tl_vtk_line(file);
    /* As a double: a long run counts past 32 bits. */
    tl_vtk_array(file, "CYCLE", 1, 1, TL_VTK_DOUBLE);
    tl_vtk_double(file, (double)m->cycles);
    tl_vtk_line(file);
    tl_vtk_array(file, "joint_names", 1, m->joint_count + 1, TL_VTK_STRING);
    tl_vtk_string(file, ""); /* joint 0 is none */
    for (size_t i = 0; i < m->joint_count; i++)
        tl_vtk_string(file, m->joints[i].name);
    tl_vtk_line(file);
    if (m->group_count > 0) {
        tl_vtk_array(file, "group_names", 1, m->group_count, TL_VTK_STRING);
        for (size_t i = 0; i < m->group_count; i++)
            tl_vtk_string(file, m->groups[i]);
        tl_vtk_line(file);
    }
}

tl_status tl_vtk_countable(size_t count, const char *content, tl_error *error)
{
    if (count > INT32_MAX)
        return tl_fail(
            error, TL_E_IO,
            "cannot write the %s: %zu numbers are more than the %d a legacy VTK file can "
            "count",
            content, count, INT32_MAX);
    return TL_OK;
}
