/* vtk_zones.c - the zones of a frame, those that a section cuts, and the surfaces of deformable blocks.
 *
 * Zones are an UNSTRUCTURED_GRID of tetrahedra (cell type 10). Their points are the gridpoints where they are now.
 * Bodies share none.
 *
 * Cell data   mean      mean stress, Pa, tension positive: what ParaView colours by first
 *             block_id  id of the block that it is of
 *             group     of that block: index into the field group_names
 *             solid     index into the field solid_names
 *             cluster   number of the zones that share their change of volume
 *             stress    Pa, tension positive: xx yy zz xy yz zx
 *             principal Pa, the largest (tension) first
 *             deviator  sqrt(3 J2), Pa
 *             state     0 elastic, 1 shear, 2 tension, 3 joint; 4, 5, 6 the same of steps before
 *             plastic   1 when it has ever yielded
 *             and each state of the solids by its name, one called as an array above with solid_ in front; NaN where
 *             the zone's solid has no such state
 * Point data  displacement  m        velocity  m/s        force  unbalanced, N
 *             fixed     components that are held: 1 x, 2 y, 4 z, added up
 *
 * Real numbers are in single precision, but the points and what the program adds. */
#include "io/vtk_zones.h"

#include "base/columns.h"
#include "base/error.h"
#include "io/extra_fields.h"
#include "io/vtk_file.h"
#include "io/zone_list.h"
#include "query/zone_fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/zones.h>

#define CONTEXT "write_vtk: zone_fields"
/* Zones, or gridpoints, whose values are asked for at a time. */
#define ASKED 64
/* Numbers that a value has at the most. */
#define WIDEST 6

/* ---------------------------------------------------------------- columns ---------------- */

typedef enum source { BLOCK, GROUP, SOLID, CLUSTER, STATE, FIELD, ADDED } source;

/* An array: where it comes from. */
typedef struct column {
    const char *name, *field; /* in the file, and as it is asked for */
    const char *type;
    size_t width;
    source from;
    const double *values; /* that the program adds */
    bool of_points;
} column;

static const column zone_columns[] = {
    {"mean", "mean", TL_VTK_FLOAT, 1, FIELD, NULL, false},
    {"block_id", NULL, TL_VTK_INT, 1, BLOCK, NULL, false},
    {"group", NULL, TL_VTK_INT, 1, GROUP, NULL, false},
    {"solid", NULL, TL_VTK_INT, 1, SOLID, NULL, false},
    {"cluster", NULL, TL_VTK_INT, 1, CLUSTER, NULL, false},
    {"stress", "stress", TL_VTK_FLOAT, 6, FIELD, NULL, false},
    {"principal", "principal", TL_VTK_FLOAT, 3, FIELD, NULL, false},
    {"deviator", "deviator", TL_VTK_FLOAT, 1, FIELD, NULL, false},
    {"state", NULL, TL_VTK_INT, 1, STATE, NULL, false},
    {"plastic", "plastic", TL_VTK_INT, 1, FIELD, NULL, false},
};
static const column point_columns[] = {
    {"displacement", "displacement", TL_VTK_FLOAT, 3, FIELD, NULL, true},
    {"velocity", "velocity", TL_VTK_FLOAT, 3, FIELD, NULL, true},
    {"force", "force", TL_VTK_FLOAT, 3, FIELD, NULL, true},
    {"fixed", "fixed", TL_VTK_INT, 1, FIELD, NULL, true},
};

enum { ZONE_COLUMNS = sizeof zone_columns / sizeof *zone_columns };
enum { POINT_COLUMNS = sizeof point_columns / sizeof *point_columns };

typedef struct zones {
    tl_model *model;
    tl_zone_list list;
    const column *of;       /* that is being written */
    const uint32_t *picked; /* of a section: the number in the list of each row's zone; NULL: rows are the zones */
} zones;

static double whole_of(const zones *j, size_t i)
{
    const tl_model *m = j->model;
    const tl_parcel *parcel = &m->zones->parcels.of[j->list.parcel[i]];
    switch (j->of->from) {
    case BLOCK: return parcel->block;
    case GROUP: return m->blocks.group[tl_block_row_quiet(m, parcel->block)];
    case SOLID: return parcel->solid;
    case CLUSTER: return j->list.cluster[i];
    default: return tl_zone_state(m->zones->zones.flags[j->list.row[i]]);
    }
}

/* Values of zones, or gridpoints, begin to end, at most ASKED. There is such a field, and they all are there. */
static void ask_listed(const zones *j, size_t begin, size_t end, double *values)
{
    const column *of = j->of;
    size_t width = 1;
    if (of->from == ADDED)
        memcpy(values, of->values + begin, (end - begin) * sizeof *values);
    else if (of->from != FIELD)
        for (size_t i = begin; i < end; i++)
            values[i - begin] = whole_of(j, i);
    else if (of->of_points)
        tl_gridpoints_values(j->model, j->list.point_name + begin, end - begin, of->field, values, &width);
    else
        tl_zones_values(j->model, j->list.zone_name + begin, end - begin, of->field, values, &width);
}

/* Those of rows. A row without a zone has NaN, or -1 among whole numbers. */
static void ask(const zones *j, size_t begin, size_t end, double *values)
{
    const column *of = j->of;
    if (!j->picked) {
        ask_listed(j, begin, end, values);
        return;
    }
    for (size_t i = begin; i < end; i++, values += of->width) {
        const uint32_t zone = j->picked[i];
        if (zone != TL_NO_ROW)
            ask_listed(j, zone, (size_t)zone + 1, values);
        for (size_t w = 0; zone == TL_NO_ROW && w < of->width; w++)
            values[w] = of->type[0] == 'i' ? -1 : NAN;
    }
}

static size_t number_bytes(const column *of)
{
    return of->type[0] == 'd' ? sizeof(double) : sizeof(float);
}

static void fill_column(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const zones *j = user;
    const column *of = j->of;
    double values[ASKED * WIDEST];
    unsigned char *to = tl_piece_add(piece, (end - begin) * of->width * number_bytes(of));
    for (size_t next; to && begin < end; begin = next) {
        next = end - begin < ASKED ? end : begin + ASKED;
        ask(j, begin, next, values);
        for (size_t k = 0; k < (next - begin) * of->width; k++)
            to = of->type[0] == 'd'   ? tl_vtk_put_double(to, values[k])
                 : of->type[0] == 'f' ? tl_vtk_put_float(to, values[k])
                                      : tl_vtk_put_int(to, (int32_t)(int64_t)values[k]);
    }
}

static tl_status put_column(zones *j, const column *of, size_t rows, tl_pieces *out)
{
    j->of = of;
    return tl_vtk_list(out, rows, rows * of->width * number_bytes(of), fill_column, j);
}

/* ---------------------------------------------------------------- states and extras ------ */

/* What follows the columns of all zones: states of the solids, and what the program adds. */
typedef struct more {
    column *list;
    char (*name)[80];
    size_t count;
} more;

static bool is_column(const char *name)
{
    bool found = false;
    for (size_t k = 0; k < ZONE_COLUMNS && !found; k++)
        found = strcmp(zone_columns[k].name, name) == 0;
    return found;
}

static tl_status list_more(tl_model *m, const tl_vtk_parts *parts, size_t zone_count, more *of)
{
    const tl_state *states[TL_ZONE_STATES];
    const size_t count = tl_zone_states(m, states), added = parts->zone_field_count;
    tl_status status = tl_extra_fields_check(CONTEXT, parts->zone_fields, added, zone_count, "zones", &m->error);
    of->list = malloc((count + added + 1) * sizeof *of->list);
    of->name = malloc((count + 1) * sizeof *of->name);
    if (status == TL_OK && (!of->list || !of->name))
        status = tl_fail_memory(&m->error);
    for (size_t k = 0; status == TL_OK && k < ZONE_COLUMNS; k++)
        status = tl_extra_fields_differ(CONTEXT, parts->zone_fields, added, zone_columns[k].name, &m->error);
    for (size_t k = 0; status == TL_OK && k < count; k++) {
        snprintf(of->name[k], sizeof of->name[k], "%s%.64s", is_column(states[k]->name) ? "solid_" : "",
                 states[k]->name);
        of->list[of->count++] = (column){.name = of->name[k],
                                         .field = states[k]->name,
                                         .type = TL_VTK_FLOAT,
                                         .width = tl_state_width(states[k]->kind),
                                         .from = FIELD};
        status = tl_extra_fields_differ(CONTEXT, parts->zone_fields, added, of->name[k], &m->error);
    }
    for (size_t k = 0; status == TL_OK && k < added; k++)
        of->list[of->count++] = (column){.name = parts->zone_fields[k].name,
                                         .type = TL_VTK_DOUBLE,
                                         .width = 1,
                                         .from = ADDED,
                                         .values = parts->zone_fields[k].values};
    return status;
}

/* ---------------------------------------------------------------- the file --------------- */

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const zones *j = user;
    const tl_zone_list *l = &j->list;
    unsigned char *to = tl_piece_add(piece, (end - begin) * TL_VTK_VEC3_BYTES);
    size_t mesh = 0;
    for (size_t i = begin; to && i < end; i++) {
        while (i >= l->point_start[mesh + 1])
            mesh++;
        const size_t row = l->of->mesh[l->mesh[mesh]].point_begin + i - l->point_start[mesh];
        to = tl_vtk_put_vec3(to, tl_v3_add(j->model->origin, tl_gridpoint_place(&l->of->points, row)));
    }
}

static void fill_cells(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const zones *j = user;
    const tl_zone_list *l = &j->list;
    unsigned char *to = tl_piece_add(piece, 5 * (end - begin) * TL_VTK_INT_BYTES);
    size_t mesh = 0;
    for (size_t i = begin; to && i < end; i++) {
        while (i >= l->zone_start[mesh + 1])
            mesh++;
        to = tl_vtk_put_int(to, 4);
        for (int a = 0; a < 4; a++)
            to = tl_vtk_put_int(to, (int32_t)tl_zone_list_point(l, mesh, tl_zone_list_corner(l, i, a)));
    }
}

static void fill_types(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    (void)user;
    unsigned char *to = tl_piece_add(piece, (end - begin) * TL_VTK_INT_BYTES);
    for (size_t row = begin; to && row < end; row++)
        to = tl_vtk_put_int(to, TL_VTK_TETRA);
}

static tl_status put_columns(zones *j, const column *list, size_t count, size_t rows, tl_pieces *out)
{
    tl_status status = TL_OK;
    for (size_t k = 0; k < count && status == TL_OK; k++) {
        tl_vtk_array(out->output->file, list[k].name, list[k].width, rows, list[k].type);
        status = put_column(j, &list[k], rows, out);
    }
    return status;
}

static tl_status put_grid(zones *j, const more *m, tl_pieces *out)
{
    FILE *file = out->output->file;
    const size_t cells = j->list.zones, points = j->list.points;
    tl_vtk_header(file, j->model, "zones", "UNSTRUCTURED_GRID", false);
    fprintf(file, "POINTS %zu double\n", points);
    tl_status status = tl_vtk_list(out, points, points * TL_VTK_VEC3_BYTES, fill_places, j);
    fprintf(file, "CELLS %zu %zu\n", cells, 5 * cells);
    if (status == TL_OK)
        status = tl_vtk_list(out, cells, 5 * cells * TL_VTK_INT_BYTES, fill_cells, j);
    fprintf(file, "CELL_TYPES %zu\n", cells);
    if (status == TL_OK)
        status = tl_vtk_list(out, cells, cells * TL_VTK_INT_BYTES, fill_types, j);
    fprintf(file, "CELL_DATA %zu\nSCALARS mean float 1\nLOOKUP_TABLE default\n", cells);
    if (status == TL_OK)
        status = put_column(j, &zone_columns[0], cells, out);
    tl_vtk_field(file, "FieldData", ZONE_COLUMNS - 1 + m->count);
    if (status == TL_OK)
        status = put_columns(j, zone_columns + 1, ZONE_COLUMNS - 1, cells, out);
    if (status == TL_OK)
        status = put_columns(j, m->list, m->count, cells, out);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement float\n", points);
    if (status == TL_OK)
        status = put_column(j, &point_columns[0], points, out);
    tl_vtk_field(file, "FieldData", POINT_COLUMNS - 1);
    return status == TL_OK ? put_columns(j, point_columns + 1, POINT_COLUMNS - 1, points, out) : status;
}

tl_status tl_vtk_zones(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    zones j = {.model = m};
    more added = {0};
    tl_status status = tl_zone_list_make(m, &j.list);
    if (status == TL_OK)
        status = tl_vtk_countable(5 * j.list.zones, "zones", &m->error);
    if (status == TL_OK)
        status = list_more(m, parts, j.list.zones, &added);
    if (status == TL_OK)
        status = put_grid(&j, &added, out);
    free(added.list);
    free(added.name);
    tl_zone_list_free(&j.list);
    return status;
}

/* ---------------------------------------------------------------- sections --------------- */

/* Columns after the first that sections have of all blocks. */
enum { OF_BLOCKS = 2 };

tl_status tl_vtk_picked_zones(tl_model *m, const tl_zone_list *list, const uint32_t *picked, size_t count,
                              tl_pieces *out)
{
    const tl_vtk_parts none = tl_vtk_parts_default();
    zones j = {.model = m, .list = *list, .picked = picked};
    more states = {0};
    tl_status status = list_more(m, &none, list->zones, &states);
    if (status == TL_OK) {
        tl_vtk_field(out->output->file, "ZoneData", ZONE_COLUMNS - OF_BLOCKS + states.count);
        status = put_columns(&j, zone_columns, 1, count, out);
    }
    if (status == TL_OK)
        status = put_columns(&j, zone_columns + 1 + OF_BLOCKS, ZONE_COLUMNS - 1 - OF_BLOCKS, count, out);
    if (status == TL_OK)
        status = put_columns(&j, states.list, states.count, count, out);
    free(states.list);
    free(states.name);
    return status;
}

/* ---------------------------------------------------------------- surfaces --------------- */

static int by_row(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* The number of a row in an ascending list that has it. */
static uint32_t number_in(const uint32_t *list, size_t count, uint32_t row)
{
    const uint32_t *found = bsearch(&row, list, count, sizeof *list, by_row);
    return (uint32_t)(found - list);
}

/* Sorts rows of gridpoints and leaves out repetitions. Gives how many are left. */
static uint32_t sort_rows(uint32_t *list, size_t count)
{
    size_t kept = 0;
    qsort(list, count, sizeof *list, by_row);
    for (size_t k = 0; k < count; k++)
        if (kept == 0 || list[kept - 1] != list[k])
            list[kept++] = list[k];
    return (uint32_t)kept;
}

/* Triangles of a block that lie one after the other in the list of parts, from `part` on. */
static uint32_t take_block(tl_block_surfaces *s, uint32_t row, const tl_surface_part *part, const tl_surface_part *end)
{
    uint32_t *vertex = s->vertex + s->vertex_start[row], count = 0;
    for (; part + count < end && part[count].block == part->block; count++)
        for (int c = 0; c < 3; c++)
            vertex[3 * count + (uint32_t)c] = part[count].corner[c];
    const uint32_t vertices = sort_rows(vertex, 3 * (size_t)count);
    for (uint32_t k = 0; k < count; k++)
        for (int c = 0; c < 3; c++)
            s->triangle[s->triangle_start[row] + k][c] = number_in(vertex, vertices, part[k].corner[c]);
    s->vertex_start[row + 1] = s->vertex_start[row] + vertices;
    s->triangle_start[row + 1] = s->triangle_start[row] + count;
    return count;
}

/* The first triangle of a block, or NULL. */
static const tl_surface_part *first_part(const tl_model *m, uint32_t row, const tl_surface_part **end)
{
    const struct tl_zones *z = m->zones;
    const uint32_t mesh = m->bodies.mesh[m->blocks.body[row]];
    if (mesh == 0)
        return NULL;
    const tl_surface_part *at = z->part + z->mesh[mesh - 1].part_begin;
    *end = z->part + z->mesh[mesh - 1].part_end;
    while (at < *end && at->block != m->blocks.id[row])
        at++;
    return at < *end ? at : NULL;
}

tl_status tl_block_surfaces_find(tl_model *m, tl_block_surfaces *s)
{
    const size_t rows = m->blocks.table.rows, parts = m->zones ? m->zones->part_count : 0;
    *s = (tl_block_surfaces){.vertex_start = calloc(rows + 1, sizeof *s->vertex_start),
                             .triangle_start = calloc(rows + 1, sizeof *s->triangle_start),
                             .vertex = malloc((3 * parts + 1) * sizeof *s->vertex),
                             .triangle = malloc((parts + 1) * sizeof *s->triangle)};
    if (!s->vertex_start || !s->triangle_start || !s->vertex || !s->triangle)
        return tl_fail_memory(&m->error);
    for (uint32_t row = 0; row < rows; row++) {
        const tl_surface_part *end = NULL, *part = first_part(m, row, &end);
        s->vertex_start[row + 1] = s->vertex_start[row];
        s->triangle_start[row + 1] = s->triangle_start[row];
        if (part)
            take_block(s, row, part, end);
    }
    return TL_OK;
}

void tl_block_surfaces_free(tl_block_surfaces *s)
{
    free(s->vertex_start);
    free(s->triangle_start);
    free(s->vertex);
    free(s->triangle);
    *s = (tl_block_surfaces){0};
}
