/* vtk_file.h - what a legacy VTK file is made of.
 *
 * Numbers are written binary, most significant byte first. Errors stay on the stream; whoever
 * closes it looks (output_file.h). */
#ifndef TL_IO_VTK_FILE_H
#define TL_IO_VTK_FILE_H

#include "io/pieces.h"

#include <stdio.h>
#include <string.h>

#define TL_VTK_DOUBLE "double"
#define TL_VTK_FLOAT "float"
#define TL_VTK_INT "int"
#define TL_VTK_LONG "vtktypeint64"
#define TL_VTK_STRING "string"

/* Type number of a cell whose faces are given as polygons. */
#define TL_VTK_POLYHEDRON 42
/* That of a tetrahedron: seen from its fourth point, the first three turn counter-clockwise. */
#define TL_VTK_TETRA 10

/* The five lines at the head of a file and the fields every file carries: TIME, CYCLE, and the
 * names of groups and joints, so that the numbers in `group` and `joint` can be looked up; where blocks are deformable
 * those of the solids. With `laws` the names of these, too. */
void tl_vtk_header(FILE *file, const tl_model *m, const char *content, const char *dataset, bool laws);

/* "FIELD": `arrays` arrays follow, each begun by tl_vtk_array and ended by tl_vtk_line. */
void tl_vtk_field(FILE *file, const char *name, size_t arrays);
void tl_vtk_array(FILE *file, const char *name, size_t components, size_t tuples, const char *type);
void tl_vtk_line(FILE *file);

/* A list that is made of rows, `bytes` in all, as tl_pieces_write does it, and its line. */
tl_status tl_vtk_list(tl_pieces *out, size_t rows, size_t bytes, tl_piece_fn fn, const void *user);

/* Numbers and vectors of an array: put at `to`, they give where the next goes. */
static inline unsigned char *tl_vtk_put_int(unsigned char *to, int32_t value)
{
    uint32_t bits = (uint32_t)value;
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(bits >> (24 - 8 * i));
    return to + 4;
}

/* In single precision: pictures need no more of what is not a place, and files are half as long. */
static inline unsigned char *tl_vtk_put_float(unsigned char *to, double value)
{
    float single = (float)value;
    int32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return tl_vtk_put_int(to, bits);
}

static inline unsigned char *tl_vtk_put_float3(unsigned char *to, tl_vec3 value)
{
    to = tl_vtk_put_float(to, value.x);
    to = tl_vtk_put_float(to, value.y);
    return tl_vtk_put_float(to, value.z);
}

static inline unsigned char *tl_vtk_put_long(unsigned char *to, int64_t value)
{
    to = tl_vtk_put_int(to, (int32_t)(value >> 32));
    return tl_vtk_put_int(to, (int32_t)(uint32_t)value);
}

static inline unsigned char *tl_vtk_put_double(unsigned char *to, double value)
{
    int64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return tl_vtk_put_long(to, bits);
}

static inline unsigned char *tl_vtk_put_vec3(unsigned char *to, tl_vec3 value)
{
    to = tl_vtk_put_double(to, value.x);
    to = tl_vtk_put_double(to, value.y);
    return tl_vtk_put_double(to, value.z);
}

/* Puts a vector of a point of a block: where it is, or how far it has moved. */
typedef unsigned char *(*tl_vtk_point_fn)(const tl_model *m, uint32_t block, tl_vec3 local, unsigned char *to);

static inline unsigned char *tl_vtk_put_place(const tl_model *m, uint32_t block, tl_vec3 local, unsigned char *to)
{
    return tl_vtk_put_vec3(to, tl_model_point(m, m->blocks.body[block], local));
}

static inline unsigned char *tl_vtk_put_moved(const tl_model *m, uint32_t block, tl_vec3 local, unsigned char *to)
{
    return tl_vtk_put_float3(to, tl_block_point_displacement(m, block, local));
}

/* Bytes of a vector, of one in single precision, and of a whole number. */
#define TL_VTK_VEC3_BYTES 24
#define TL_VTK_FLOAT3_BYTES 12
#define TL_VTK_INT_BYTES 4

/* Legacy files count in 32 bits: TL_E_IO with a sentence when `count` numbers are too many. */
tl_status tl_vtk_countable(size_t count, const char *content, tl_error *error);

#endif
