/* vtk_elements.c - the elements of a frame.
 *
 * An element is a cell of an UNSTRUCTURED_GRID, its nodes are points where they are now. Nodes on faces are a cloud
 * (cell type 2), others a polyline (4). One of triangles has a cell for each (5), all with the data of the whole.
 *
 * Point data  displacement  since it was installed, m
 *             force         on its block, N
 *             block_id      0: the ground, or a block that has been deleted
 *             weight        m or m2 that it stands for
 *             and each state of nodes by its name
 *
 * Cell data   element_id
 *             flags         1 yielded, 2 broken, 4 detached
 *             stored        J
 *             and each state of the whole by its name
 *
 * States are NaN where the kind has none of that name.
 * Real numbers are in single precision, but the points. */
#include "io/vtk_elements.h"

#include "base/columns.h"
#include "base/error.h"
#include "element/carry.h"
#include "element/follow.h"
#include "element/set.h"
#include "io/vtk_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLACE, MOVED, FORCE, BLOCK, WEIGHT, NODE_STATE, ID, FLAGS, STORED, WHOLE_STATE, CELLS, TYPES };

/* A list of the file: what it is of, and the name of the state. */
typedef struct list {
    const tl_model *m;
    int of;
    const char *name;
} list;

static bool lies_on_a_face(const struct tl_elements *e, size_t row)
{
    return tl_v3_norm2(tl_node_outward(&e->nodes, e->table.node_begin[row])) > 0;
}

static bool has_triangles(const struct tl_elements *e, size_t row)
{
    return tl_element_ops_of(&e->set[e->table.set[row]])->triangles != 0;
}

/* Cells of an element: one, or one for each triangle. */
static uint32_t cells_of(const struct tl_elements *e, size_t row)
{
    return has_triangles(e, row) ? e->table.node_count[row] / 3 : 1;
}

/* The value of a state by its name; NaN: the kind has none of it. */
static double state_of(const struct tl_elements *e, size_t element, size_t row, const char *name, bool whole)
{
    uint32_t column;
    bool of_whole;
    if (!tl_element_column(e->set[e->table.set[element]].kind, name, &column, &of_whole) || of_whole != whole)
        return NAN;
    return whole ? e->table.state[column][row] : e->nodes.state[column][row];
}

static unsigned char *put_node(const list *l, size_t element, size_t row, unsigned char *to)
{
    const struct tl_elements *e = l->m->elements;
    const tl_vec3 u = tl_node_moved(l->m, row);
    switch (l->of) {
    case PLACE: return tl_vtk_put_vec3(to, tl_v3_add(l->m->origin, tl_v3_add(tl_columns_get(e->nodes.rest, row), u)));
    case MOVED: return tl_vtk_put_float3(to, u);
    case FORCE: return tl_vtk_put_float3(to, tl_columns_get(e->nodes.force, row));
    case BLOCK: return tl_vtk_put_int(to, e->nodes.block[row] == TL_GONE ? 0 : (int32_t)e->nodes.block[row]);
    case WEIGHT: return tl_vtk_put_float(to, e->nodes.weight[row]);
    default: return tl_vtk_put_float(to, state_of(e, element, row, l->name, false));
    }
}

/* Cell `cell` of an element. */
static unsigned char *put_cell(const list *l, size_t row, uint32_t cell, unsigned char *to)
{
    const tl_element_table *t = &l->m->elements->table;
    const bool triangle = has_triangles(l->m->elements, row);
    const uint32_t count = triangle ? 3 : t->node_count[row];
    switch (l->of) {
    case ID: return tl_vtk_put_int(to, (int32_t)t->id[row]);
    case FLAGS: return tl_vtk_put_int(to, (int32_t)t->flags[row]);
    case STORED: return tl_vtk_put_float(to, t->stored[row]);
    case TYPES: return tl_vtk_put_int(to, triangle ? 5 : lies_on_a_face(l->m->elements, row) ? 2 : 4);
    case CELLS:
        to = tl_vtk_put_int(to, (int32_t)count);
        for (uint32_t k = 0; k < count; k++)
            to = tl_vtk_put_int(to, (int32_t)(t->node_begin[row] + count * cell + k));
        return to;
    default: return tl_vtk_put_float(to, state_of(l->m->elements, row, row, l->name, true));
    }
}

/* Bytes of an element in a list: most of a node are those of its place. */
static size_t bytes_of(const list *l, size_t row)
{
    return TL_VTK_VEC3_BYTES * ((size_t)l->m->elements->table.node_count[row] + 1);
}

static void fill(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const list *l = user;
    const tl_element_table *t = &l->m->elements->table;
    for (size_t row = begin; row < end; row++) {
        unsigned char *first = tl_piece_reserve(piece, bytes_of(l, row)), *to = first;
        if (!first)
            return;
        if (l->of >= ID)
            for (uint32_t k = 0; k < cells_of(l->m->elements, row); k++)
                to = put_cell(l, row, k, to);
        else
            for (uint32_t k = 0; k < t->node_count[row]; k++)
                to = put_node(l, row, t->node_begin[row] + k, to);
        piece->length += (size_t)(to - first);
    }
}

static size_t cell_count(const struct tl_elements *e)
{
    size_t sum = 0;
    for (size_t row = 0; row < e->table.table.rows; row++)
        sum += cells_of(e, row);
    return sum;
}

static tl_status put_list(tl_model *m, int of, const char *name, tl_pieces *out)
{
    const size_t rows = m->elements->table.table.rows;
    return tl_vtk_list(out, rows, rows * TL_VTK_VEC3_BYTES, fill, &(list){m, of, name});
}

static tl_status put_array(tl_model *m, const char *name, size_t width, const char *type, int of, tl_pieces *out)
{
    const size_t rows = of >= ID ? cell_count(m->elements) : m->elements->nodes.table.rows;
    tl_vtk_array(out->output->file, name, width, rows, type);
    return put_list(m, of, name, out);
}

/* State k of the kinds of all sets, each name once; NULL: there are no more. */
static const char *state_name(const struct tl_elements *e, bool whole, size_t number)
{
    for (size_t s = 0; s < e->set_count; s++)
        for (uint32_t k = 0; k < e->set[s].kind->state_count; k++) {
            const tl_state *state = &e->set[s].kind->states[k];
            bool told = (state->kind == TL_STATE_WHOLE) != whole;
            for (size_t before = 0; before < s && !told; before++) {
                uint32_t column;
                bool of_whole;
                told = tl_element_column(e->set[before].kind, state->name, &column, &of_whole) && of_whole == whole;
            }
            if (!told && number-- == 0)
                return state->name;
        }
    return NULL;
}

static size_t state_count(const struct tl_elements *e, bool whole)
{
    size_t count = 0;
    while (state_name(e, whole, count))
        count++;
    return count;
}

static tl_status put_states(tl_model *m, bool whole, tl_pieces *out)
{
    tl_status status = TL_OK;
    const char *name;
    for (size_t k = 0; status == TL_OK && (name = state_name(m->elements, whole, k)) != NULL; k++)
        status = put_array(m, name, 1, TL_VTK_FLOAT, whole ? WHOLE_STATE : NODE_STATE, out);
    return status;
}

tl_status tl_vtk_elements(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    (void)parts;
    const tl_status followed = tl_elements_follow(m);
    if (followed != TL_OK)
        return followed;
    const struct tl_elements *e = m->elements;
    FILE *file = out->output->file;
    const size_t cells = cell_count(e), points = e->nodes.table.rows;
    tl_status status = tl_vtk_countable(cells + points, "elements", &m->error);
    tl_vtk_header(file, m, "elements", "UNSTRUCTURED_GRID", false);
    fprintf(file, "POINTS %zu double\n", points);
    if (status == TL_OK)
        status = put_list(m, PLACE, NULL, out);
    fprintf(file, "CELLS %zu %zu\n", cells, cells + points);
    if (status == TL_OK)
        status = put_list(m, CELLS, NULL, out);
    fprintf(file, "CELL_TYPES %zu\n", cells);
    if (status == TL_OK)
        status = put_list(m, TYPES, NULL, out);
    fprintf(file, "CELL_DATA %zu\n", cells);
    tl_vtk_field(file, "FieldData", 3 + state_count(e, true));
    if (status == TL_OK)
        status = put_array(m, "element_id", 1, TL_VTK_INT, ID, out);
    if (status == TL_OK)
        status = put_array(m, "flags", 1, TL_VTK_INT, FLAGS, out);
    if (status == TL_OK)
        status = put_array(m, "stored", 1, TL_VTK_FLOAT, STORED, out);
    if (status == TL_OK)
        status = put_states(m, true, out);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement float\n", points);
    if (status == TL_OK)
        status = put_list(m, MOVED, NULL, out);
    tl_vtk_field(file, "FieldData", 3 + state_count(e, false));
    if (status == TL_OK)
        status = put_array(m, "force", 3, TL_VTK_FLOAT, FORCE, out);
    if (status == TL_OK)
        status = put_array(m, "block_id", 1, TL_VTK_INT, BLOCK, out);
    if (status == TL_OK)
        status = put_array(m, "weight", 1, TL_VTK_FLOAT, WEIGHT, out);
    return status == TL_OK ? put_states(m, false, out) : status;
}
