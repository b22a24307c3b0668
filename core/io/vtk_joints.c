/* vtk_joints.c - the joint faces of a frame: POLYDATA of polygons, one for each block face that a
 * joint made (so two for each place where two blocks still touch).
 *
 * Cell data  joint     index into the field joint_names
 *            plane     number of the plane within its joint set
 *            block_id  id of the block the face belongs to
 * Point data displacement  m, as in the file of the blocks */
#include "base/error.h"
#include "io/vtk_data.h"
#include "io/vtk_file.h"

#include <stdlib.h>

/* Of which blocks the polygons are. */
typedef struct faces {
    const tl_model *model;
    const tl_blocks *blocks;
    uint32_t *polygon, *point; /* [rows + 1] index of the block's first */
} faces;

static size_t polygons_of(const faces *f, size_t begin, size_t end)
{
    return f->polygon[end] - f->polygon[begin];
}

static size_t points_of(const faces *f, size_t begin, size_t end)
{
    return f->point[end] - f->point[begin];
}

/* ---------------------------------------------------------------- points ----------------- */

typedef tl_vec3 (*point_fn)(const faces *f, uint32_t row, tl_vec3 local);

/* A vector of each corner of rows. */
static inline void fill_corners(const faces *f, size_t begin, size_t end, tl_piece *piece,
                                point_fn of)
{
    size_t bytes = points_of(f, begin, end) * TL_VTK_VEC3_BYTES;
    unsigned char *to = tl_piece_room(piece, bytes);
    if (!to)
        return;
    for (uint32_t row = (uint32_t)begin; row < end; row++) {
        const tl_poly *shape = f->blocks->shape[row];
        for (uint32_t face = 0; face < shape->face_count; face++) {
            if (shape->tag[face].joint == 0)
                continue;
            for (uint32_t i = shape->start[face]; i < shape->start[face + 1]; i++)
                to = tl_vtk_put_vec3(to, of(f, row, shape->vertex[shape->loop[i]]));
        }
    }
    piece->length += bytes;
}

static tl_vec3 place_of(const faces *f, uint32_t row, tl_vec3 local)
{
    return tl_model_point(f->model, f->blocks->body[row], local);
}

static tl_vec3 displacement_of(const faces *f, uint32_t row, tl_vec3 local)
{
    return tl_block_point_displacement(f->model, row, local);
}

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_corners(user, begin, end, piece, place_of);
}

static void fill_displacements(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_corners(user, begin, end, piece, displacement_of);
}

/* ---------------------------------------------------------------- polygons --------------- */

static void fill_polygons(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const faces *f = user;
    size_t numbers = polygons_of(f, begin, end) + points_of(f, begin, end);
    unsigned char *to = tl_piece_room(piece, numbers * TL_VTK_INT_BYTES);
    if (!to)
        return;
    int32_t next = (int32_t)f->point[begin];
    for (size_t row = begin; row < end; row++) {
        const tl_poly *shape = f->blocks->shape[row];
        for (uint32_t face = 0; face < shape->face_count; face++) {
            if (shape->tag[face].joint == 0)
                continue;
            int32_t size = (int32_t)tl_poly_face_size(shape, face);
            to = tl_vtk_put_int(to, size);
            for (int32_t i = 0; i < size; i++)
                to = tl_vtk_put_int(to, next++);
        }
    }
    piece->length += numbers * TL_VTK_INT_BYTES;
}

typedef int32_t (*polygon_fn)(const faces *f, size_t row, uint32_t face);

/* A number of each polygon of rows. */
static inline void fill_numbers(const faces *f, size_t begin, size_t end, tl_piece *piece,
                                polygon_fn of)
{
    size_t bytes = polygons_of(f, begin, end) * TL_VTK_INT_BYTES;
    unsigned char *to = tl_piece_room(piece, bytes);
    if (!to)
        return;
    for (size_t row = begin; row < end; row++) {
        const tl_poly *shape = f->blocks->shape[row];
        for (uint32_t face = 0; face < shape->face_count; face++)
            if (shape->tag[face].joint != 0)
                to = tl_vtk_put_int(to, of(f, row, face));
    }
    piece->length += bytes;
}

static int32_t joint_of(const faces *f, size_t row, uint32_t face)
{
    return (int32_t)f->blocks->shape[row]->tag[face].joint;
}

static int32_t plane_of(const faces *f, size_t row, uint32_t face)
{
    return (int32_t)f->blocks->shape[row]->tag[face].plane;
}

static int32_t block_of(const faces *f, size_t row, uint32_t face)
{
    (void)face;
    return (int32_t)f->blocks->id[row];
}

static void fill_joints(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_numbers(user, begin, end, piece, joint_of);
}

static void fill_planes(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_numbers(user, begin, end, piece, plane_of);
}

static void fill_ids(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_numbers(user, begin, end, piece, block_of);
}

/* ---------------------------------------------------------------- the file --------------- */

/* A list that is made of the blocks, `bytes` in all. */
static tl_status put_list(const faces *f, tl_pieces *out, size_t bytes, tl_piece_fn fn)
{
    size_t rows = f->blocks->table.rows;
    tl_status status = tl_pieces_write(out, rows, 1 + bytes / (rows + 1), fn, f);
    tl_vtk_line(out->output->file);
    return status;
}

static tl_status put_faces(tl_model *m, const faces *f, tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t rows = m->blocks.table.rows, polygons = f->polygon[rows], points = f->point[rows];
    size_t numbers = polygons * TL_VTK_INT_BYTES, vectors = points * TL_VTK_VEC3_BYTES;
    tl_vtk_header(file, m, "joint faces", "POLYDATA");
    fprintf(file, "POINTS %zu double\n", points);
    tl_status status = put_list(f, out, vectors, fill_places);
    fprintf(file, "POLYGONS %zu %zu\n", polygons, polygons + points);
    if (status == TL_OK)
        status = put_list(f, out, numbers + points * TL_VTK_INT_BYTES, fill_polygons);
    fprintf(file, "CELL_DATA %zu\nSCALARS joint int 1\nLOOKUP_TABLE default\n", polygons);
    if (status == TL_OK)
        status = put_list(f, out, numbers, fill_joints);
    tl_vtk_field(file, "FieldData", 2);
    tl_vtk_array(file, "plane", 1, polygons, TL_VTK_INT);
    if (status == TL_OK)
        status = put_list(f, out, numbers, fill_planes);
    tl_vtk_array(file, "block_id", 1, polygons, TL_VTK_INT);
    if (status == TL_OK)
        status = put_list(f, out, numbers, fill_ids);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement double\n", points);
    return status == TL_OK ? put_list(f, out, vectors, fill_displacements) : status;
}

/* Counts each block's polygons and points; gives the numbers that a file of them has. */
static size_t count_faces(const faces *f)
{
    size_t polygons = 0, points = 0;
    for (size_t row = 0; row < f->blocks->table.rows; row++) {
        const tl_poly *shape = f->blocks->shape[row];
        f->polygon[row] = (uint32_t)polygons;
        f->point[row] = (uint32_t)points;
        for (uint32_t face = 0; face < shape->face_count; face++) {
            if (shape->tag[face].joint == 0)
                continue;
            polygons++;
            points += tl_poly_face_size(shape, face);
        }
    }
    f->polygon[f->blocks->table.rows] = (uint32_t)polygons;
    f->point[f->blocks->table.rows] = (uint32_t)points;
    return polygons + points;
}

tl_status tl_vtk_joints(tl_model *m, tl_pieces *out)
{
    size_t rows = m->blocks.table.rows;
    faces f = {.model = m, .blocks = &m->blocks};
    f.polygon = malloc((rows + 1) * sizeof *f.polygon);
    f.point = malloc((rows + 1) * sizeof *f.point);
    tl_status status = f.polygon && f.point ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = tl_vtk_countable(count_faces(&f), "joint faces", &m->error);
    if (status == TL_OK)
        status = put_faces(m, &f, out);
    free(f.polygon);
    free(f.point);
    return status;
}
