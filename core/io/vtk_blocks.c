/* vtk_blocks.c - the blocks of a frame: UNSTRUCTURED_GRID of polyhedra (cell type 42).
 *
 * A polyhedron is a face stream: number of faces, then for each face its number of vertices and
 * their indices, counter-clockwise from outside. Vertices are not shared between blocks, so that
 * blocks can be moved apart.
 *
 * Cell data   block_id  id of the block
 *             velocity  of the block's centroid, m/s
 *             group     index into the field group_names
 *             body      id of its body
 *             volume    m3          density   kg/m3
 *             fixed     1 when its body is held whole         hidden    1 when hidden
 * Point data  displacement  m, since creation or the last reset
 *             explode       from the model's centre to the block's centroid, m: ParaView's Warp By
 *                           Vector with it moves the blocks apart
 *
 * The model's centre is the mean of the blocks' centroids weighted by volume. */
#include "io/vtk_data.h"
#include "io/vtk_file.h"

typedef struct counts {
    size_t points; /* vertices of all blocks */
    size_t stream; /* integers of all face streams, with the leading length of each */
} counts;

static counts count_all(const tl_blocks *b)
{
    counts total = {0, 0};
    for (size_t row = 0; row < b->table.rows; row++) {
        const tl_poly *shape = b->shape[row];
        total.points += shape->vertex_count;
        total.stream += 2 + shape->face_count + shape->start[shape->face_count];
    }
    return total;
}

static void put_points(const tl_model *m, size_t points, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    fprintf(file, "POINTS %zu double\n", points);
    for (size_t row = 0; row < b->table.rows; row++)
        for (uint32_t v = 0; v < b->shape[row]->vertex_count; v++)
            tl_vtk_vec3(file, tl_model_point(m, b->body[row], b->shape[row]->vertex[v]));
    tl_vtk_line(file);
}

static void put_cells(const tl_blocks *b, size_t stream, FILE *file)
{
    fprintf(file, "CELLS %zu %zu\n", b->table.rows, stream);
    uint32_t first = 0; /* index of the block's first vertex */
    for (size_t row = 0; row < b->table.rows; row++) {
        const tl_poly *shape = b->shape[row];
        tl_vtk_int(file, (int32_t)(1 + shape->face_count + shape->start[shape->face_count]));
        tl_vtk_int(file, (int32_t)shape->face_count);
        for (uint32_t face = 0; face < shape->face_count; face++) {
            tl_vtk_int(file, (int32_t)tl_poly_face_size(shape, face));
            for (uint32_t i = shape->start[face]; i < shape->start[face + 1]; i++)
                tl_vtk_int(file, (int32_t)(first + shape->loop[i]));
        }
        first += shape->vertex_count;
    }
    fprintf(file, "\nCELL_TYPES %zu\n", b->table.rows);
    for (size_t row = 0; row < b->table.rows; row++)
        tl_vtk_int(file, TL_VTK_POLYHEDRON);
    tl_vtk_line(file);
}

/* Of a block's centroid: its body's, and what the body's turning adds off the body's centroid. */
static tl_vec3 velocity_of(const tl_model *m, size_t row)
{
    const tl_bodies *bodies = &m->bodies;
    uint32_t body = m->blocks.body[row];
    tl_vec3 arm = tl_m3_mul(&bodies->pose[body].r, tl_block_local(m, (uint32_t)row));
    return tl_v3_add(bodies->v[body], tl_v3_cross(bodies->w[body], arm));
}

static void put_cell_data(const tl_model *m, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    size_t rows = b->table.rows;
    fprintf(file, "CELL_DATA %zu\nSCALARS block_id int 1\nLOOKUP_TABLE default\n", rows);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_int(file, (int32_t)b->id[row]);
    fprintf(file, "\nVECTORS velocity double\n");
    for (size_t row = 0; row < rows; row++)
        tl_vtk_vec3(file, velocity_of(m, row));
    tl_vtk_line(file);

    tl_vtk_field(file, "FieldData", 6);
    tl_vtk_array(file, "group", 1, rows, TL_VTK_INT);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_int(file, (int32_t)b->group[row]);
    tl_vtk_line(file);
    tl_vtk_array(file, "body", 1, rows, TL_VTK_INT);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_int(file, (int32_t)m->bodies.id[b->body[row]]);
    tl_vtk_line(file);
    tl_vtk_array(file, "volume", 1, rows, TL_VTK_DOUBLE);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_double(file, b->volume[row]);
    tl_vtk_line(file);
    tl_vtk_array(file, "density", 1, rows, TL_VTK_DOUBLE);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_double(file, b->density[row]);
    tl_vtk_line(file);
    tl_vtk_array(file, "fixed", 1, rows, TL_VTK_INT);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_int(file, m->bodies.fixed[b->body[row]] == TL_FIX_ALL);
    tl_vtk_line(file);
    tl_vtk_array(file, "hidden", 1, rows, TL_VTK_INT);
    for (size_t row = 0; row < rows; row++)
        tl_vtk_int(file, b->hidden[row] != 0);
    tl_vtk_line(file);
}

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

static void put_point_data(const tl_model *m, size_t points, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement double\n", points);
    for (uint32_t row = 0; row < b->table.rows; row++)
        for (uint32_t v = 0; v < b->shape[row]->vertex_count; v++)
            tl_vtk_vec3(file, tl_block_point_displacement(m, row, b->shape[row]->vertex[v]));
    tl_vtk_line(file);

    tl_vec3 centre = model_centre(m);
    tl_vtk_field(file, "FieldData", 1);
    tl_vtk_array(file, "explode", 3, points, TL_VTK_DOUBLE);
    for (uint32_t row = 0; row < b->table.rows; row++) {
        tl_vec3 away = tl_v3_sub(tl_block_centroid(m, row), centre);
        for (uint32_t v = 0; v < b->shape[row]->vertex_count; v++)
            tl_vtk_vec3(file, away);
    }
    tl_vtk_line(file);
}

tl_status tl_vtk_blocks(tl_model *m, FILE *file)
{
    counts total = count_all(&m->blocks);
    tl_status status = tl_vtk_countable(total.stream, "blocks", &m->error);
    if (status != TL_OK)
        return status;
    tl_vtk_header(file, m, "blocks", "UNSTRUCTURED_GRID");
    put_points(m, total.points, file);
    put_cells(&m->blocks, total.stream, file);
    put_cell_data(m, file);
    put_point_data(m, total.points, file);
    return TL_OK;
}
