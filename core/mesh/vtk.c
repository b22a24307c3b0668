/* vtk.c - unstructured grids of VTK's legacy format, as text or binary (VTK file formats, "Simple legacy formats").
 *
 *     # vtk DataFile Version 3.0      a title      ASCII or BINARY      DATASET UNSTRUCTURED_GRID
 *     POINTS n type                   coordinates
 *     CELLS n size                    of each cell how many points it has, and which
 *     CELLS n+1 size                  since 5.0: OFFSETS and CONNECTIVITY
 *     CELL_TYPES n                    10: a tetrahedron; those of less than three dimensions are left out
 *     CELL_DATA n, POINT_DATA n, FIELD    arrays
 *
 * Binary numbers have their most significant byte first. Of arrays of cells those count that tell groups and blocks
 * (vtk_arrays.c). */
#include "mesh/vtk.h"

#include "mesh/vtk_arrays.h"
#include "mesh/vtk_numbers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

enum { TETRAHEDRON = 10, FIRST_SOLID = 10, LAST_LINEAR_SOLID = 16, QUADRATIC_TETRAHEDRON = 24 };

/* ---------------------------------------------------------------- the grid --------------- */

static tl_status read_points(tl_vtk *v)
{
    tl_mesh *m = v->r->mesh;
    double count;
    tl_vtk_type type = {TL_VTK_REAL, 8};
    if (m->point_count > 0)
        return tl_mesh_fault(&v->r->text, "POINTS is there twice; the file is damaged");
    tl_status status = tl_mesh_whole_number(&v->r->text, "the number of points", 1, TL_MESH_MOST, &count);
    if (status == TL_OK)
        status = tl_vtk_read_type(v, "coordinates", &type);
    if (status == TL_OK && type.bytes == 0)
        return tl_mesh_fault(&v->r->text, "coordinates must be numbers");
    if (status == TL_OK)
        status = tl_vtk_list_begin(v, 3 * count, type, "coordinates");
    if (status == TL_OK)
        status = tl_mesh_hold_points(v->r, (size_t)count);
    while (status == TL_OK && m->point_count < (uint32_t)count) {
        double x[3];
        for (int i = 0; status == TL_OK && i < 3; i++)
            status = tl_vtk_next(v, type, "a coordinate", &x[i]);
        if (status == TL_OK)
            status = tl_mesh_check_place(&v->r->text, (tl_vec3){x[0], x[1], x[2]}, "point", m->point_count);
        if (status == TL_OK) {
            m->node[m->point_count] = m->point_count;
            m->point[m->point_count++] = (tl_vec3){x[0], x[1], x[2]};
        }
    }
    return status;
}

static bool hold_cells(tl_vtk *v, double cells, double corners)
{
    v->cells = (size_t)cells;
    v->start = calloc(v->cells + 1, sizeof *v->start);
    v->line = calloc(v->cells + 1, sizeof *v->line);
    v->kind = calloc(v->cells + 1, 1);
    v->group = malloc((v->cells + 1) * sizeof *v->group);
    v->corner = malloc(((size_t)corners + 1) * sizeof *v->corner);
    for (size_t k = 0; v->group && k < v->cells; k++)
        v->group[k] = TL_MESH_NO_KEY;
    return v->start && v->line && v->kind && v->group && v->corner;
}

static tl_status read_corner(tl_vtk *v, tl_vtk_type type, size_t at)
{
    double corner;
    const tl_status status = tl_vtk_next_whole(v, type, "a point of a cell", TL_MESH_MOST, &corner);
    v->corner[at] = status == TL_OK ? (uint32_t)corner : 0;
    return status;
}

/* Cells one after the other: how many points each has, and these. */
static tl_status read_rows(tl_vtk *v, double size)
{
    static const tl_vtk_type whole = {TL_VTK_SIGNED, 4};
    tl_mesh_text *t = &v->r->text;
    size_t used = 0;
    tl_status status = TL_OK;
    for (size_t k = 0; status == TL_OK && k < v->cells; k++) {
        double count;
        status = tl_vtk_next_whole(v, whole, "how many points a cell has", size, &count);
        if (status == TL_OK && (double)(used + v->cells) + count > size)
            return tl_mesh_fault(t, "the first %zu cells have more than the %.17g numbers that are announced", k + 1,
                                 size);
        v->line[k] = v->binary ? 0 : (uint32_t)t->line;
        for (double a = 0; status == TL_OK && a < count; a++)
            status = read_corner(v, whole, used++);
        v->start[k + 1] = (uint32_t)used;
    }
    return status;
}

static tl_status expect(tl_vtk *v, const char *wanted, tl_vtk_type *type)
{
    char word[TL_MESH_WORD];
    if (!tl_mesh_word(&v->r->text, word))
        return tl_mesh_truncated(&v->r->text, wanted);
    if (!tl_mesh_alike(word, wanted))
        return tl_mesh_fault(&v->r->text, "%s is expected, not '%.40s'; the file is damaged", wanted, word);
    const tl_status status = tl_vtk_read_type(v, wanted, type);
    return status == TL_OK && type->bytes == 0 ? tl_mesh_fault(&v->r->text, "%s must be whole numbers", wanted)
                                               : status;
}

/* Cells as lists of where each begins, and of points. */
static tl_status read_offsets(tl_vtk *v, double size)
{
    tl_vtk_type type;
    double offset;
    tl_status status = expect(v, "OFFSETS", &type);
    if (status == TL_OK)
        status = tl_vtk_list_begin(v, (double)v->cells + 1, type, "offsets");
    for (size_t k = 0; status == TL_OK && k <= v->cells; k++) {
        status = tl_vtk_next_whole(v, type, "where a cell begins", size, &offset);
        v->start[k] = status == TL_OK ? (uint32_t)offset : 0;
        if (status == TL_OK && (k == 0 ? offset > 0 : v->start[k] < v->start[k - 1]))
            return tl_mesh_fault(&v->r->text, "the offsets of cells do not ascend from 0; the file is damaged");
    }
    if (status == TL_OK)
        status = expect(v, "CONNECTIVITY", &type);
    if (status == TL_OK)
        status = tl_vtk_list_begin(v, size, type, "points of cells");
    for (size_t k = 0; status == TL_OK && k < (size_t)size; k++)
        status = read_corner(v, type, k);
    return status;
}

static tl_status read_cells(tl_vtk *v)
{
    static const tl_vtk_type whole = {TL_VTK_SIGNED, 4};
    tl_mesh_text *t = &v->r->text;
    double count, size;
    if (v->start)
        return tl_mesh_fault(t, "CELLS is there twice; the file is damaged");
    tl_status status = tl_mesh_whole_number(t, "the number of cells", v->offsets ? 1 : 0, TL_MESH_MOST, &count);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "how many numbers the cells have", 0, UINT32_MAX - 1, &size);
    if (status == TL_OK && v->offsets)
        status = tl_mesh_room(t, count + size, v->binary ? 1 : 2, "numbers of cells");
    else if (status == TL_OK)
        status = tl_vtk_list_begin(v, fmax(size, count), whole, "numbers of cells");
    if (status == TL_OK && !hold_cells(v, v->offsets ? count - 1 : count, size))
        status = tl_fail_memory(t->error);
    if (status != TL_OK)
        return status;
    return v->offsets ? read_offsets(v, size) : read_rows(v, size);
}

static tl_status read_types(tl_vtk *v)
{
    static const tl_vtk_type whole = {TL_VTK_SIGNED, 4};
    tl_mesh_text *t = &v->r->text;
    double count, type;
    tl_status status = tl_mesh_whole_number(t, "the number of types", 0, TL_MESH_MOST, &count);
    if (status == TL_OK && (!v->start || fabs(count - (double)v->cells) > 0))
        return tl_mesh_fault(t, "there are %.17g types of %zu cells; the file is damaged", count,
                             v->start ? v->cells : 0);
    if (status == TL_OK)
        status = tl_vtk_list_begin(v, count, whole, "types of cells");
    for (size_t k = 0; status == TL_OK && k < v->cells; k++) {
        status = tl_vtk_next_whole(v, whole, "the type of a cell", UINT8_MAX, &type);
        v->kind[k] = (uint8_t)(status == TL_OK ? type : 0);
    }
    v->typed = true;
    return status;
}

/* ---------------------------------------------------------------- tetrahedra ------------- */

static tl_status refuse_kind(const tl_vtk *v, size_t cell)
{
    tl_mesh_text t = v->r->text;
    const unsigned kind = v->kind[cell];
    char where[40] = "";
    if (v->line[cell] > 0)
        t.line = v->line[cell];
    else
        tl_text_print(where, sizeof where, " of the list before it");
    if (kind == QUADRATIC_TETRAHEDRON || kind == 71)
        return tl_mesh_fault(&t, "cell %zu%s is a tetrahedron of higher order (type %u): save the mesh in first order",
                             cell, where, kind);
    return tl_mesh_fault(&t,
                         "cell %zu%s is of type %u: zones are tetrahedra of four points (type 10); mesh the volumes "
                         "with them",
                         cell, where, kind);
}

static bool is_flat_kind(unsigned kind)
{
    return kind < FIRST_SOLID || (kind >= 21 && kind <= 23) || kind == 28 || kind == 30 || kind == 34 || kind == 35 ||
           kind == 36 || kind == 68 || kind == 69 || kind == 70;
}

static tl_status take_cell(tl_vtk *v, size_t cell)
{
    const uint32_t *corner = v->corner + v->start[cell], count = v->start[cell + 1] - v->start[cell];
    tl_mesh_text t = v->r->text;
    if (v->line[cell] > 0)
        t.line = v->line[cell];
    if (v->kind[cell] != TETRAHEDRON)
        return is_flat_kind(v->kind[cell]) ? TL_OK : refuse_kind(v, cell);
    if (count != 4)
        return tl_mesh_fault(&t, "cell %zu, a tetrahedron, has %u points; the file is damaged", cell, count);
    for (int a = 0; a < 4; a++)
        if (corner[a] >= v->r->mesh->point_count)
            return tl_mesh_fault(&t, "cell %zu has the point %u: there are %u, counted from 0", cell, corner[a],
                                 v->r->mesh->point_count);
    return tl_mesh_add(v->r, corner, (uint32_t)cell, v->line[cell], v->group[cell]);
}

/* ---------------------------------------------------------------- the file --------------- */

static tl_status read_head(tl_vtk *v)
{
    tl_mesh_text *t = &v->r->text;
    char word[TL_MESH_WORD], version = '0';
    while (tl_mesh_word_here(t, word)) /* the version is the last word of the first line */
        version = word[0];
    v->offsets = version >= '5' && version <= '9';
    tl_mesh_next_line(t);
    tl_mesh_next_line(t); /* the title */
    if (!tl_mesh_word(t, word))
        return tl_mesh_truncated(t, "ASCII or BINARY");
    v->binary = tl_mesh_alike(word, "BINARY");
    if (!v->binary && !tl_mesh_alike(word, "ASCII"))
        return tl_mesh_fault(t, "ASCII or BINARY is expected, not '%.40s'; the file is damaged", word);
    if (!tl_mesh_word(t, word) || !tl_mesh_alike(word, "DATASET") || !tl_mesh_word_here(t, word))
        return tl_mesh_fault(t, "DATASET UNSTRUCTURED_GRID is expected; the file is damaged");
    if (!tl_mesh_alike(word, "UNSTRUCTURED_GRID"))
        return tl_mesh_fault(t, "the data are of the kind '%.40s': a mesh of tetrahedra is an UNSTRUCTURED_GRID", word);
    return TL_OK;
}

static tl_status read_section(tl_vtk *v, const char *word)
{
    if (tl_mesh_alike(word, "POINTS"))
        return read_points(v);
    if (tl_mesh_alike(word, "CELLS"))
        return read_cells(v);
    if (tl_mesh_alike(word, "CELL_TYPES"))
        return read_types(v);
    return tl_vtk_read_array(v, word);
}

tl_status tl_mesh_read_vtk(tl_mesh_reading *r)
{
    tl_vtk v = {.r = r};
    char word[TL_MESH_WORD];
    r->mesh->cell = "cell";
    tl_status status = read_head(&v);
    while (status == TL_OK && tl_mesh_word(&r->text, word))
        status = read_section(&v, word);
    if (status == TL_OK && !v.typed)
        status = tl_mesh_truncated(&r->text, !v.start ? "CELLS" : "CELL_TYPES");
    for (size_t k = 0; status == TL_OK && k < v.cells; k++)
        status = take_cell(&v, k);
    free(v.start);
    free(v.line);
    free(v.kind);
    free(v.group);
    free(v.corner);
    return status;
}
