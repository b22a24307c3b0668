/* vtk_blocks.c - the blocks of a frame: UNSTRUCTURED_GRID of polyhedra (cell type 42).
 *
 * A polyhedron is a face stream: number of faces, then for each face its number of vertices and
 * their indices, counter-clockwise from outside. Vertices are not shared between blocks, so that
 * blocks can be moved apart.
 *
 * Cell data   displacement_size  of its centroid since creation or the last reset, m: what ParaView colours by first
 *             velocity  of the block's centroid, m/s
 *             block_id  id of the block
 *             group     index into the field group_names
 *             body      id of its body
 *             volume    m3          density   kg/m3       mass      kg
 *             displacement      of its centroid since creation or the last reset, m
 *             rotation          of its body since creation, axis times angle, rad
 *             unbalanced_force  on its body in the last step, N
 *             fixed     1 when its body is held whole         hidden    1 when hidden
 * Point data  displacement  m, since creation or the last reset
 *             explode       from the model's centre to the block's centroid, m: ParaView's Warp By
 *                           Vector with it moves the blocks apart
 *
 * The model's centre is the mean of the blocks' centroids weighted by volume. */
#include "io/vtk_blocks.h"

#include "base/error.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/vtk_file.h"
#include "model/regroup.h"

#include <stdlib.h>

/* The model and what its rows need of each other. */
typedef struct grid {
    const tl_model *model;
    const tl_blocks *blocks;
    uint32_t *first; /* [rows + 1] index of the block's first vertex */
    tl_vec3 centre;  /* of the model */
} grid;

/* Integers of a block's face stream, with its leading length. */
static size_t stream_of(const tl_poly *shape)
{
    return 2u + shape->face_count + shape->start[shape->face_count];
}

static size_t vertices_of(const grid *g, size_t begin, size_t end)
{
    return g->first[end] - g->first[begin];
}

/* ---------------------------------------------------------------- points ----------------- */

typedef unsigned char *(*point_fn)(const grid *g, uint32_t row, tl_vec3 local, unsigned char *to);

/* A vector of each vertex of rows. */
static inline void fill_vertices(const grid *g, size_t begin, size_t end, tl_piece *piece,
                                 point_fn of, size_t each)
{
    size_t bytes = vertices_of(g, begin, end) * each;
    unsigned char *to = tl_piece_reserve(piece, bytes);
    if (!to)
        return;
    for (uint32_t row = (uint32_t)begin; row < end; row++) {
        const tl_poly *shape = g->blocks->shape[row];
        for (uint32_t v = 0; v < shape->vertex_count; v++)
            to = of(g, row, shape->vertex[v], to);
    }
    piece->length += bytes;
}

static unsigned char *put_place(const grid *g, uint32_t row, tl_vec3 local, unsigned char *to)
{
    return tl_vtk_put_vec3(to, tl_model_point(g->model, g->blocks->body[row], local));
}

static unsigned char *put_displacement(const grid *g, uint32_t row, tl_vec3 local,
                                       unsigned char *to)
{
    return tl_vtk_put_float3(to, tl_block_point_displacement(g->model, row, local));
}

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, put_place, TL_VTK_VEC3_BYTES);
}

static void fill_displacements(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, put_displacement, TL_VTK_FLOAT3_BYTES);
}

/* From the model's centre to the block's: the same for all its vertices. */
static void fill_explode(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const grid *g = user;
    size_t bytes = vertices_of(g, begin, end) * TL_VTK_FLOAT3_BYTES;
    unsigned char *to = tl_piece_reserve(piece, bytes);
    if (!to)
        return;
    for (uint32_t row = (uint32_t)begin; row < end; row++) {
        tl_vec3 away = tl_v3_sub(tl_block_centroid(g->model, row), g->centre);
        for (uint32_t v = g->first[row]; v < g->first[row + 1]; v++)
            to = tl_vtk_put_float3(to, away);
    }
    piece->length += bytes;
}

/* ---------------------------------------------------------------- cells ------------------ */

static void fill_cells(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const grid *g = user;
    for (size_t row = begin; row < end; row++) {
        const tl_poly *shape = g->blocks->shape[row];
        size_t bytes = stream_of(shape) * TL_VTK_INT_BYTES;
        unsigned char *to = tl_piece_reserve(piece, bytes);
        if (!to)
            return;
        to = tl_vtk_put_int(to, (int32_t)stream_of(shape) - 1);
        to = tl_vtk_put_int(to, (int32_t)shape->face_count);
        for (uint32_t face = 0; face < shape->face_count; face++) {
            to = tl_vtk_put_int(to, (int32_t)tl_poly_face_size(shape, face));
            for (uint32_t i = shape->start[face]; i < shape->start[face + 1]; i++)
                to = tl_vtk_put_int(to, (int32_t)(g->first[row] + shape->loop[i]));
        }
        piece->length += bytes;
    }
}

/* ---------------------------------------------------------------- cell data -------------- */

/* A number or a vector of each block. */
typedef struct cell_array {
    const char *name;
    int32_t (*whole)(const tl_model *m, uint32_t row);
    double (*real)(const tl_model *m, uint32_t row);
    tl_vec3 (*vector)(const tl_model *m, uint32_t row);
} cell_array;

typedef struct cell_job {
    const tl_model *model;
    const cell_array *array;
} cell_job;

static size_t bytes_of(const cell_array *a)
{
    return a->whole ? TL_VTK_INT_BYTES : a->real ? sizeof(double) : TL_VTK_VEC3_BYTES;
}

static void fill_array(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const cell_job *job = user;
    const cell_array *a = job->array;
    size_t bytes = (end - begin) * bytes_of(a);
    unsigned char *to = tl_piece_reserve(piece, bytes);
    if (!to)
        return;
    for (uint32_t row = (uint32_t)begin; row < end; row++) {
        if (a->whole)
            to = tl_vtk_put_int(to, a->whole(job->model, row));
        else if (a->real)
            to = tl_vtk_put_double(to, a->real(job->model, row));
        else
            to = tl_vtk_put_vec3(to, a->vector(job->model, row));
    }
    piece->length += bytes;
}

static int32_t cell_type(const tl_model *m, uint32_t row)
{
    (void)m, (void)row;
    return TL_VTK_POLYHEDRON;
}

static int32_t id_of(const tl_model *m, uint32_t row)
{
    return (int32_t)m->blocks.id[row];
}

static int32_t group_of(const tl_model *m, uint32_t row)
{
    return (int32_t)m->blocks.group[row];
}

static int32_t body_of(const tl_model *m, uint32_t row)
{
    return (int32_t)m->bodies.id[m->blocks.body[row]];
}

static int32_t is_fixed(const tl_model *m, uint32_t row)
{
    return m->bodies.fixed[m->blocks.body[row]] == TL_FIX_ALL;
}

static int32_t is_hidden(const tl_model *m, uint32_t row)
{
    return m->blocks.hidden[row] != 0;
}

static double volume_of(const tl_model *m, uint32_t row)
{
    return m->blocks.volume[row];
}

static double density_of(const tl_model *m, uint32_t row)
{
    return m->blocks.density[row];
}

static double mass_of(const tl_model *m, uint32_t row)
{
    return m->blocks.density[row] * m->blocks.volume[row];
}

static tl_vec3 rotation_of(const tl_model *m, uint32_t row)
{
    return tl_q_vector(m->bodies.q[m->blocks.body[row]]);
}

static tl_vec3 unbalanced_of(const tl_model *m, uint32_t row)
{
    return m->bodies.force[m->blocks.body[row]];
}

static double displacement_size(const tl_model *m, uint32_t row)
{
    return tl_v3_norm(tl_block_displacement(m, row));
}

static const cell_array types = {.whole = cell_type}, sizes = {.real = displacement_size},
                        velocities = {.vector = tl_block_velocity};
static const cell_array fields[] = {
    {"block_id", .whole = id_of},
    {"group", .whole = group_of},
    {"body", .whole = body_of},
    {"volume", .real = volume_of},
    {"density", .real = density_of},
    {"mass", .real = mass_of},
    {"displacement", .vector = tl_block_displacement},
    {"rotation", .vector = rotation_of},
    {"unbalanced_force", .vector = unbalanced_of},
    {"fixed", .whole = is_fixed},
    {"hidden", .whole = is_hidden},
};

enum { FIELDS = sizeof fields / sizeof *fields };

static tl_status put_array(tl_model *m, tl_pieces *out, const cell_array *a)
{
    const cell_job job = {m, a};
    tl_status status = tl_pieces_write(out, m->blocks.table.rows, bytes_of(a), fill_array, &job);
    tl_vtk_line(out->output->file);
    return status;
}

/* A field that the program adds. */
static void fill_field(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const tl_extra_field *field = user;
    size_t bytes = (end - begin) * sizeof(double);
    unsigned char *to = tl_piece_reserve(piece, bytes);
    for (size_t row = begin; to && row < end; row++)
        to = tl_vtk_put_double(to, field->values[row]);
    piece->length += to ? bytes : 0;
}

static tl_status put_field(tl_model *m, tl_pieces *out, const tl_extra_field *field)
{
    size_t rows = m->blocks.table.rows;
    tl_vtk_array(out->output->file, field->name, 1, rows, TL_VTK_DOUBLE);
    tl_status status = tl_pieces_write(out, rows, sizeof(double), fill_field, field);
    tl_vtk_line(out->output->file);
    return status;
}

static tl_status put_cell_data(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t rows = m->blocks.table.rows;
    fprintf(file, "CELL_DATA %zu\nSCALARS displacement_size double 1\nLOOKUP_TABLE default\n",
            rows);
    tl_status status = put_array(m, out, &sizes);
    fprintf(file, "VECTORS velocity double\n");
    if (status == TL_OK)
        status = put_array(m, out, &velocities);
    tl_vtk_field(file, "FieldData", FIELDS + parts->block_field_count);
    for (size_t i = 0; i < FIELDS && status == TL_OK; i++) {
        tl_vtk_array(file, fields[i].name, fields[i].vector ? 3 : 1, rows,
                     fields[i].whole ? TL_VTK_INT : TL_VTK_DOUBLE);
        status = put_array(m, out, &fields[i]);
    }
    for (size_t i = 0; i < parts->block_field_count && status == TL_OK; i++)
        status = put_field(m, out, &parts->block_fields[i]);
    return status;
}

/* ---------------------------------------------------------------- the file --------------- */

static tl_vec3 model_centre(const tl_model *m)
{
    const tl_blocks *b = &m->blocks;
    tl_vec3 sum = {0, 0, 0};
    double volume = 0;
    for (uint32_t row = 0; row < b->table.rows; row++) {
        /* From the model's origin, so that a model far away keeps its digits. */
        tl_vec3 arm = tl_v3_sub(tl_block_centroid(m, row), m->origin);
        sum = tl_v3_madd(sum, b->volume[row], arm);
        volume += b->volume[row];
    }
    return volume > 0 ? tl_v3_madd(m->origin, 1 / volume, sum) : m->origin;
}

/* A list that is made of the blocks, `bytes` in all. */
static tl_status put_list(const grid *g, tl_pieces *out, size_t bytes, tl_piece_fn fn)
{
    size_t rows = g->blocks->table.rows;
    tl_status status = tl_pieces_write(out, rows, 1 + bytes / (rows + 1), fn, g);
    tl_vtk_line(out->output->file);
    return status;
}

static tl_status put_grid(tl_model *m, const grid *g, size_t stream, const tl_vtk_parts *parts,
                          tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t rows = m->blocks.table.rows, points = g->first[rows];
    tl_vtk_header(file, m, "blocks", "UNSTRUCTURED_GRID");
    fprintf(file, "POINTS %zu double\n", points);
    tl_status status = put_list(g, out, points * TL_VTK_VEC3_BYTES, fill_places);
    fprintf(file, "CELLS %zu %zu\n", rows, stream);
    if (status == TL_OK)
        status = put_list(g, out, stream * TL_VTK_INT_BYTES, fill_cells);
    fprintf(file, "CELL_TYPES %zu\n", rows);
    if (status == TL_OK)
        status = put_array(m, out, &types);
    if (status == TL_OK)
        status = put_cell_data(m, parts, out);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement float\n", points);
    if (status == TL_OK)
        status = put_list(g, out, points * TL_VTK_FLOAT3_BYTES, fill_displacements);
    tl_vtk_field(file, "FieldData", 1);
    tl_vtk_array(file, "explode", 3, points, TL_VTK_FLOAT);
    return status == TL_OK ? put_list(g, out, points * TL_VTK_FLOAT3_BYTES, fill_explode) : status;
}

static tl_status check_fields(tl_model *m, const tl_vtk_parts *parts)
{
    static const char context[] = "write_vtk: block_fields";
    tl_status status = tl_extra_fields_check(context, parts->block_fields, parts->block_field_count,
                                             m->blocks.table.rows, "blocks", &m->error);
    if (status == TL_OK)
        status = tl_extra_fields_differ(context, parts->block_fields, parts->block_field_count,
                                        "block_id", &m->error);
    for (size_t i = 0; status == TL_OK && i < FIELDS; i++)
        status = tl_extra_fields_differ(context, parts->block_fields, parts->block_field_count,
                                        fields[i].name, &m->error);
    return status;
}

tl_status tl_vtk_blocks(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    const tl_blocks *b = &m->blocks;
    size_t stream = 0;
    for (size_t row = 0; row < b->table.rows; row++)
        stream += stream_of(b->shape[row]);
    tl_status status = tl_vtk_countable(stream, "blocks", &m->error);
    if (status == TL_OK)
        status = check_fields(m, parts);
    if (status != TL_OK)
        return status;
    grid g = {.model = m, .blocks = b, .centre = model_centre(m)};
    g.first = malloc((b->table.rows + 1) * sizeof *g.first);
    if (!g.first)
        return tl_fail_memory(&m->error);
    g.first[0] = 0;
    for (size_t row = 0; row < b->table.rows; row++)
        g.first[row + 1] = g.first[row] + b->shape[row]->vertex_count;
    status = put_grid(m, &g, stream, parts, out);
    free(g.first);
    return status;
}
