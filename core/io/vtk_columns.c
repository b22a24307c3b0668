/* vtk_columns.c - see vtk_columns.h. */
#include "io/vtk_columns.h"

#include "base/error.h"
#include "base/output_file.h"
#include "base/pages.h"
#include "io/extra_fields.h"
#include "io/vtk_file.h"
#include "query/point_fields.h"

#include <math.h>
#include <stdlib.h>

#define CONTEXT "write_vtk: contact_fields"

static size_t bytes_of(const tl_vtk_column *column)
{
    return column->width * (column->type[0] == 'd' ? sizeof(double) : sizeof(float));
}

/* Lists the given columns and those of the states. */
static bool list_columns(tl_vtk_columns *c, const tl_vtk_column *list, const char *state_type)
{
    c->count = c->given + c->states.count + c->field_count;
    c->list = malloc((c->count + 1) * sizeof *c->list);
    c->at = malloc((c->count + 1) * sizeof *c->at);
    if (!c->list || !c->at)
        return false;
    memcpy(c->list, list, c->given * sizeof *list);
    for (size_t s = 0; s < c->states.count; s++)
        c->list[c->given + s] =
            (tl_vtk_column){c->states.at[s].name, state_type, (unsigned)c->states.at[s].width};
    for (size_t f = 0; f < c->field_count; f++)
        c->list[c->given + c->states.count + f] =
            (tl_vtk_column){c->fields[f].name, TL_VTK_DOUBLE, 1};
    return true;
}

static bool make_memory(tl_vtk_columns *c)
{
    size_t bytes = 0;
    for (size_t k = 0; k < c->count; k++)
        bytes += c->rows * bytes_of(&c->list[k]);
    c->memory = malloc(bytes + 1);
    if (!c->memory)
        return false;
    tl_pages_large(c->memory, bytes);
    unsigned char *at = c->memory;
    for (size_t k = 0; k < c->count; k++) {
        c->at[k] = at;
        at += c->rows * bytes_of(&c->list[k]);
    }
    return true;
}

/* A state that is called as one of the given columns is called law_NAME here. */
static void rename_states(tl_vtk_columns *c, const tl_vtk_column *list)
{
    for (size_t s = 0; s < c->states.count; s++)
        for (size_t k = 0; k < c->given; k++) {
            tl_law_state *state = &c->states.at[s];
            if (list[k].name && strcmp(list[k].name, state->name) == 0)
                snprintf(state->name, sizeof state->name, "law_%s", list[k].name);
        }
}

tl_status tl_vtk_columns_make(tl_vtk_columns *columns, tl_model *m, const tl_vtk_column *list,
                              size_t given, const char *state_type, size_t rows,
                              const tl_extra_field *fields, size_t field_count)
{
    *columns = (tl_vtk_columns){
        .given = given, .rows = rows, .fields = fields, .field_count = field_count};
    tl_status status = tl_law_states_list(m, &columns->states);
    rename_states(columns, list);
    for (size_t k = 0; status == TL_OK && k < given; k++)
        if (list[k].name)
            status = tl_extra_fields_differ(CONTEXT, fields, field_count, list[k].name, &m->error);
    for (size_t k = 0; status == TL_OK && k < columns->states.count; k++)
        status = tl_extra_fields_differ(CONTEXT, fields, field_count, columns->states.at[k].name,
                                        &m->error);
    if (status == TL_OK && !(list_columns(columns, list, state_type) && make_memory(columns)))
        status = tl_fail_memory(&m->error);
    return status;
}

void tl_vtk_columns_free(tl_vtk_columns *columns)
{
    tl_law_states_free(&columns->states);
    free(columns->list);
    free(columns->at);
    free(columns->memory);
    *columns = (tl_vtk_columns){0};
}

void tl_vtk_set_rest(const tl_vtk_columns *columns, const tl_model *m, size_t row, uint32_t contact,
                     size_t number)
{
    for (size_t s = 0; s < columns->states.count; s++) {
        const tl_law_state *state = &columns->states.at[s];
        double value[3] = {NAN, NAN, NAN};
        if (contact != TL_NO_ROW)
            tl_law_state_of_contact(m, &columns->states, state, contact, value);
        for (size_t w = 0; w < state->width; w++)
            tl_vtk_set_real(columns, columns->given + s, row * state->width + w, value[w]);
    }
    for (size_t f = 0; f < columns->field_count; f++) {
        double value = contact == TL_NO_ROW ? NAN : columns->fields[f].values[number];
        tl_vtk_set_real(columns, columns->given + columns->states.count + f, row, value);
    }
}

void tl_vtk_put_column(const tl_vtk_columns *columns, size_t column, tl_output *output)
{
    const tl_vtk_column *of = &columns->list[column];
    if (of->name)
        tl_vtk_array(output->file, of->name, of->width, columns->rows, of->type);
    tl_output_put(output, columns->at[column], columns->rows * bytes_of(of));
    tl_vtk_line(output->file);
}

void tl_vtk_put_columns(const tl_vtk_columns *columns, size_t first, tl_output *output)
{
    tl_vtk_field(output->file, "FieldData", columns->count - first);
    for (size_t k = first; k < columns->count; k++)
        tl_vtk_put_column(columns, k, output);
}
