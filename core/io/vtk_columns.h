/* vtk_columns.h - arrays of a file that are filled row by row, by several threads, and written one after the other. */
#ifndef TL_IO_VTK_COLUMNS_H
#define TL_IO_VTK_COLUMNS_H

#include "base/output_file.h"
#include "io/vtk_file.h"
#include "query/point_fields.h"

/* An array: its name, or NULL where the file gives it none, its type in the file, and the numbers of a row. */
typedef struct tl_vtk_column {
    const char *name, *type;
    unsigned width;
} tl_vtk_column;

/* Given columns, after them one for each state of the laws (law_NAME where a given one has its name), and then one for each field that the program adds. Zero at first. */
typedef struct tl_vtk_columns {
    tl_vtk_column *list;
    size_t given, count, rows;
    unsigned char **at, *memory; /* as they are in the file */
    tl_law_states states;
    const tl_extra_field *fields;
    size_t field_count;
} tl_vtk_columns;

/* Makes room for `rows` rows of `given` columns and of all states of the laws, the latter doubles or floats, and adds fields of all contacts. Freed by tl_vtk_columns_free, also after a
 * failure. */
tl_status tl_vtk_columns_make(tl_vtk_columns *columns, tl_model *m, const tl_vtk_column *list,
                              size_t given, const char *state_type, size_t rows,
                              const tl_extra_field *fields, size_t field_count);
void tl_vtk_columns_free(tl_vtk_columns *columns);

/* The states and the added fields of a contact, or NaN for TL_NO_ROW, into a row; `number` is that of the contact among all. */
void tl_vtk_set_rest(const tl_vtk_columns *columns, const tl_model *m, size_t row, uint32_t contact,
                     size_t number);
/* Writes a column, with its heading if it has a name. */
void tl_vtk_put_column(const tl_vtk_columns *columns, size_t column, tl_output *output);
/* Writes a field of the columns from `first` on. */
void tl_vtk_put_columns(const tl_vtk_columns *columns, size_t first, tl_output *output);

/* A number, or number k of a row of several, of a column of doubles or of floats. */
static inline void tl_vtk_set_real(const tl_vtk_columns *c, size_t column, size_t k, double value)
{
    if (c->list[column].type[0] == 'd')
        tl_vtk_put_double(c->at[column] + k * sizeof(double), value);
    else
        tl_vtk_put_float(c->at[column] + k * sizeof(float), value);
}

static inline void tl_vtk_set_vec3(const tl_vtk_columns *c, size_t column, size_t i, tl_vec3 value)
{
    tl_vtk_set_real(c, column, 3 * i, value.x);
    tl_vtk_set_real(c, column, 3 * i + 1, value.y);
    tl_vtk_set_real(c, column, 3 * i + 2, value.z);
}

static inline void tl_vtk_set_int(const tl_vtk_columns *c, size_t column, size_t i, uint32_t value)
{
    tl_vtk_put_int(c->at[column] + i * TL_VTK_INT_BYTES, (int32_t)value);
}

#endif
