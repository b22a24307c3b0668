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
 * The model's centre is the mean of the blocks' centroids weighted by volume.
 *
 * A section is POLYDATA of the polygons in which a plane cuts the blocks.
 *
 * Cell data   block_id  id of the block
 *             group     index into the field group_names
 *             body      id of its body
 *             hidden    1 when hidden
 *             displacement, displacement_in_plane     of the polygon's middle, m
 * Point data  displacement              m, since creation or the last reset
 *             displacement_in_plane     the same without its part normal to the plane
 *
 * A vertex on the plane counts as above it, so a face that lies in the plane is shown once: of the
 * block below. Points closer than TL_POLY_ON times the block's size are one. */
#include "io/vtk_blocks.h"

#include "base/error.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/vtk_file.h"
#include "model/fields.h"

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

/* ---------------------------------------------------------------- points ----------------- */

typedef unsigned char *(*point_fn)(const grid *g, uint32_t row, tl_vec3 local, unsigned char *to);

/* A vector of each vertex of rows. */
static inline void fill_vertices(const grid *g, size_t begin, size_t end, tl_piece *piece, point_fn of, size_t each)
{
    unsigned char *to = tl_piece_add(piece, (g->first[end] - g->first[begin]) * each);
    for (uint32_t row = (uint32_t)begin; to && row < end; row++) {
        const tl_poly *shape = g->blocks->shape[row];
        for (uint32_t v = 0; v < shape->vertex_count; v++)
            to = of(g, row, shape->vertex[v], to);
    }
}

static unsigned char *put_place(const grid *g, uint32_t row, tl_vec3 local, unsigned char *to)
{
    return tl_vtk_put_vec3(to, tl_model_point(g->model, g->blocks->body[row], local));
}

static unsigned char *put_displacement(const grid *g, uint32_t row, tl_vec3 local, unsigned char *to)
{
    return tl_vtk_put_float3(to, tl_block_point_displacement(g->model, row, local));
}

/* From the model's centre to the block's: the same for all its vertices. */
static unsigned char *put_explode(const grid *g, uint32_t row, tl_vec3 local, unsigned char *to)
{
    (void)local;
    return tl_vtk_put_float3(to, tl_v3_sub(tl_block_centroid(g->model, row), g->centre));
}

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, put_place, TL_VTK_VEC3_BYTES);
}

static void fill_displacements(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, put_displacement, TL_VTK_FLOAT3_BYTES);
}

static void fill_explode(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, put_explode, TL_VTK_FLOAT3_BYTES);
}

/* ---------------------------------------------------------------- cells ------------------ */

static void fill_cells(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const grid *g = user;
    for (size_t row = begin; row < end; row++) {
        const tl_poly *shape = g->blocks->shape[row];
        unsigned char *to = tl_piece_add(piece, stream_of(shape) * TL_VTK_INT_BYTES);
        if (!to)
            return;
        to = tl_vtk_put_int(to, (int32_t)stream_of(shape) - 1);
        to = tl_vtk_put_int(to, (int32_t)shape->face_count);
        for (uint32_t face = 0; face < shape->face_count; face++) {
            to = tl_vtk_put_int(to, (int32_t)tl_poly_face_size(shape, face));
            for (uint32_t i = shape->start[face]; i < shape->start[face + 1]; i++)
                to = tl_vtk_put_int(to, (int32_t)(g->first[row] + shape->loop[i]));
        }
    }
}

/* ---------------------------------------------------------------- cell data -------------- */

/* An array of the field, and the quantity of blocks that it shows. */
static const struct {
    const char *name, *quantity;
} arrays[] = {
    {"block_id", "id"},
    {"group", "group"},
    {"body", "body"},
    {"volume", "volume"},
    {"density", "density"},
    {"mass", "mass"},
    {"displacement", "displacement"},
    {"rotation", "rotation_vector"},
    {"unbalanced_force", "force"},
    {"fixed", "fixed"},
    {"hidden", "hidden"},
};

enum { ARRAYS = sizeof arrays / sizeof *arrays };

typedef struct array_job {
    const tl_model *model;
    const tl_field *of;
} array_job;

static size_t width_of(const tl_field *of)
{
    return of->kind == TL_FIELD_VEC3 ? 3 : 1;
}

static bool is_real(const tl_field *of)
{
    return of->kind == TL_FIELD_VEC3 || of->kind == TL_FIELD_SCALAR;
}

static size_t bytes_of(const tl_field *of)
{
    return width_of(of) * (is_real(of) ? sizeof(double) : TL_VTK_INT_BYTES);
}

static void fill_array(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const array_job *job = user;
    const size_t width = width_of(job->of), bytes = (end - begin) * bytes_of(job->of);
    const bool real = is_real(job->of);
    unsigned char *to = tl_piece_add(piece, bytes);
    for (uint32_t row = (uint32_t)begin; to && row < end; row++) {
        double value[6];
        tl_block_numbers(job->model, row, job->of, value);
        for (size_t w = 0; w < width; w++)
            to = real ? tl_vtk_put_double(to, value[w]) : tl_vtk_put_int(to, (int32_t)(uint32_t)value[w]);
    }
}

static tl_status put_array(tl_model *m, tl_pieces *out, const tl_field *of)
{
    const array_job job = {m, of};
    const size_t rows = m->blocks.table.rows;
    return tl_vtk_list(out, rows, rows * bytes_of(of), fill_array, &job);
}

static void fill_types(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    (void)user;
    unsigned char *to = tl_piece_add(piece, (end - begin) * TL_VTK_INT_BYTES);
    for (size_t row = begin; to && row < end; row++)
        to = tl_vtk_put_int(to, TL_VTK_POLYHEDRON);
}

/* A field that the program adds. */
static void fill_field(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const tl_extra_field *field = user;
    unsigned char *to = tl_piece_add(piece, (end - begin) * sizeof(double));
    for (size_t row = begin; to && row < end; row++)
        to = tl_vtk_put_double(to, field->values[row]);
}

static tl_status put_field(tl_model *m, tl_pieces *out, const tl_extra_field *field)
{
    size_t rows = m->blocks.table.rows;
    tl_vtk_array(out->output->file, field->name, 1, rows, TL_VTK_DOUBLE);
    return tl_vtk_list(out, rows, rows * sizeof(double), fill_field, field);
}

static tl_status put_cell_data(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t rows = m->blocks.table.rows;
    fprintf(file, "CELL_DATA %zu\nSCALARS displacement_size double 1\nLOOKUP_TABLE default\n", rows);
    tl_status status = put_array(m, out, tl_block_quantity("displacement_size"));
    fprintf(file, "VECTORS velocity double\n");
    if (status == TL_OK)
        status = put_array(m, out, tl_block_quantity("velocity"));
    tl_vtk_field(file, "FieldData", ARRAYS + parts->block_field_count);
    for (size_t i = 0; i < ARRAYS && status == TL_OK; i++) {
        const tl_field *of = tl_block_quantity(arrays[i].quantity);
        tl_vtk_array(file, arrays[i].name, width_of(of), rows, is_real(of) ? TL_VTK_DOUBLE : TL_VTK_INT);
        status = put_array(m, out, of);
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

static tl_status put_grid(tl_model *m, const grid *g, size_t stream, const tl_vtk_parts *parts, tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t rows = m->blocks.table.rows, points = g->first[rows];
    tl_vtk_header(file, m, "blocks", "UNSTRUCTURED_GRID");
    fprintf(file, "POINTS %zu double\n", points);
    tl_status status = tl_vtk_list(out, rows, points * TL_VTK_VEC3_BYTES, fill_places, g);
    fprintf(file, "CELLS %zu %zu\n", rows, stream);
    if (status == TL_OK)
        status = tl_vtk_list(out, rows, stream * TL_VTK_INT_BYTES, fill_cells, g);
    fprintf(file, "CELL_TYPES %zu\n", rows);
    if (status == TL_OK)
        status = tl_vtk_list(out, rows, rows * TL_VTK_INT_BYTES, fill_types, g);
    if (status == TL_OK)
        status = put_cell_data(m, parts, out);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement float\n", points);
    if (status == TL_OK)
        status = tl_vtk_list(out, rows, points * TL_VTK_FLOAT3_BYTES, fill_displacements, g);
    tl_vtk_field(file, "FieldData", 1);
    tl_vtk_array(file, "explode", 3, points, TL_VTK_FLOAT);
    return status == TL_OK ? tl_vtk_list(out, rows, points * TL_VTK_FLOAT3_BYTES, fill_explode, g) : status;
}

static tl_status check_fields(tl_model *m, const tl_vtk_parts *parts)
{
    static const char context[] = "write_vtk: block_fields";
    tl_status status = tl_extra_fields_check(context, parts->block_fields, parts->block_field_count,
                                             m->blocks.table.rows, "blocks", &m->error);
    for (size_t i = 0; status == TL_OK && i < ARRAYS; i++)
        status =
            tl_extra_fields_differ(context, parts->block_fields, parts->block_field_count, arrays[i].name, &m->error);
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

/* ---------------------------------------------------------------- section ---------------- */

typedef struct corner {
    tl_vec3 at; /* in the body's frame */
    double angle;
} corner;

/* The polygons of a section, one after the other. */
typedef struct section {
    tl_vec3 normal;
    corner *corners;
    uint32_t *row, *end; /* [polygons] block row; end of its corners */
    size_t points, point_capacity, polygons, row_capacity, end_capacity;
} section;

static bool reserve_corners(section *s, size_t corners)
{
    return tl_grow(&s->corners, &s->point_capacity, s->points + corners, sizeof *s->corners) &&
           tl_grow(&s->row, &s->row_capacity, s->polygons + 1, sizeof *s->row) &&
           tl_grow(&s->end, &s->end_capacity, s->polygons + 1, sizeof *s->end);
}

static int by_angle(const void *a, const void *b)
{
    double x = ((const corner *)a)->angle, y = ((const corner *)b)->angle;
    return (x > y) - (x < y);
}

/* Where the edges of a shape pass from below the plane to above. */
static size_t find_corners(const tl_poly *p, tl_plane plane, corner *list)
{
    double on = TL_POLY_ON * p->size;
    size_t count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_vec3 a = p->vertex[p->edge[e].a], b = p->vertex[p->edge[e].b];
        double da = tl_v3_dot(plane.normal, a) - plane.offset;
        double db = tl_v3_dot(plane.normal, b) - plane.offset;
        if ((da < -on) == (db < -on))
            continue;
        double t = fmin(1, fmax(0, da / (da - db)));
        list[count++].at = tl_v3_madd(a, t, tl_v3_sub(b, a));
    }
    return count;
}

/* Brings the corners of a convex polygon into order, counter-clockwise as seen from above the plane,
 * each once; returns how many are left. */
static size_t order_corners(tl_vec3 normal, double on, corner *list, size_t count)
{
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        sum = tl_v3_add(sum, tl_v3_sub(list[i].at, list[0].at));
    tl_vec3 middle = tl_v3_madd(list[0].at, 1.0 / (double)count, sum);
    tl_vec3 t1 = tl_v3_perpendicular(normal), t2 = tl_v3_cross(normal, t1);
    for (size_t i = 0; i < count; i++) {
        tl_vec3 arm = tl_v3_sub(list[i].at, middle);
        list[i].angle = tl_atan2(tl_v3_dot(arm, t2), tl_v3_dot(arm, t1));
    }
    qsort(list, count, sizeof *list, by_angle);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || tl_v3_norm(tl_v3_sub(list[i].at, list[kept - 1].at)) > on)
            list[kept++] = list[i];
    while (kept > 1 && tl_v3_norm(tl_v3_sub(list[kept - 1].at, list[0].at)) <= on)
        kept--;
    return kept;
}

static bool cut_blocks(const tl_model *m, tl_plane plane, section *s)
{
    const tl_blocks *b = &m->blocks;
    for (uint32_t row = 0; row < b->table.rows; row++) {
        uint32_t body = b->body[row];
        const tl_poly *shape = b->shape[row];
        tl_plane local = {tl_m3_tmul(&m->bodies.pose[body].r, plane.normal),
                          plane.offset - tl_v3_dot(plane.normal, tl_body_place(&m->bodies, body))};
        if (!reserve_corners(s, shape->edge_count))
            return false;
        corner *list = s->corners + s->points;
        size_t count = find_corners(shape, local, list);
        if (count < 3 || (count = order_corners(local.normal, TL_POLY_ON * shape->size, list, count)) < 3)
            continue;
        s->points += count;
        s->row[s->polygons] = row;
        s->end[s->polygons++] = (uint32_t)s->points;
    }
    return true;
}

static void write_int(FILE *file, int32_t value)
{
    unsigned char bytes[TL_VTK_INT_BYTES];
    tl_vtk_put_int(bytes, value);
    fwrite(bytes, 1, sizeof bytes, file);
}

static void write_vec3(FILE *file, tl_vec3 value)
{
    unsigned char bytes[TL_VTK_VEC3_BYTES];
    tl_vtk_put_vec3(bytes, value);
    fwrite(bytes, 1, sizeof bytes, file);
}

static void put_polygons(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "POINTS %zu double\n", s->points);
    size_t at = 0;
    for (size_t i = 0; i < s->polygons; i++)
        for (; at < s->end[i]; at++)
            write_vec3(file, tl_model_point(m, m->blocks.body[s->row[i]], s->corners[at].at));
    fprintf(file, "\nPOLYGONS %zu %zu\n", s->polygons, s->polygons + s->points);
    int32_t next = 0;
    for (size_t i = 0; i < s->polygons; i++) {
        write_int(file, (int32_t)s->end[i] - next);
        while (next < (int32_t)s->end[i])
            write_int(file, next++);
    }
    tl_vtk_line(file);
}

static tl_vec3 in_plane(tl_vec3 normal, tl_vec3 v)
{
    return tl_v3_madd(v, -tl_v3_dot(v, normal), normal);
}

static tl_vec3 middle_displacement(const tl_model *m, const section *s, size_t polygon)
{
    size_t begin = polygon ? s->end[polygon - 1] : 0, end = s->end[polygon];
    tl_vec3 sum = {0, 0, 0};
    for (size_t at = begin; at < end; at++)
        sum = tl_v3_add(sum, tl_v3_sub(s->corners[at].at, s->corners[begin].at));
    tl_vec3 middle = tl_v3_madd(s->corners[begin].at, 1.0 / (double)(end - begin), sum);
    return tl_block_point_displacement(m, s->row[polygon], middle);
}

/* A quantity of the blocks that is a whole number. */
static void put_whole(const tl_model *m, const section *s, const char *name, FILE *file)
{
    for (size_t i = 0; i < s->polygons; i++) {
        double value[6];
        tl_block_numbers(m, s->row[i], tl_block_quantity(name), value);
        write_int(file, (int32_t)(uint32_t)value[0]);
    }
    tl_vtk_line(file);
}

static void put_section_cells(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "CELL_DATA %zu\nSCALARS block_id int 1\nLOOKUP_TABLE default\n", s->polygons);
    put_whole(m, s, "id", file);
    fprintf(file, "VECTORS displacement double\n");
    for (size_t i = 0; i < s->polygons; i++)
        write_vec3(file, middle_displacement(m, s, i));
    tl_vtk_line(file);
    tl_vtk_field(file, "FieldData", 4);
    static const char *const names[] = {"group", "body", "hidden"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        tl_vtk_array(file, names[k], 1, s->polygons, TL_VTK_INT);
        put_whole(m, s, names[k], file);
    }
    tl_vtk_array(file, "displacement_in_plane", 3, s->polygons, TL_VTK_DOUBLE);
    for (size_t i = 0; i < s->polygons; i++)
        write_vec3(file, in_plane(s->normal, middle_displacement(m, s, i)));
    tl_vtk_line(file);
}

/* Displacements of the points, or what they are in the plane. */
static void put_displacements(const tl_model *m, const section *s, bool all, FILE *file)
{
    for (size_t i = 0, at = 0; i < s->polygons; i++)
        for (; at < s->end[i]; at++) {
            tl_vec3 moved = tl_block_point_displacement(m, s->row[i], s->corners[at].at);
            write_vec3(file, all ? moved : in_plane(s->normal, moved));
        }
    tl_vtk_line(file);
}

static void put_point_data(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement double\n", s->points);
    put_displacements(m, s, true, file);
    tl_vtk_field(file, "FieldData", 1);
    tl_vtk_array(file, "displacement_in_plane", 3, s->points, TL_VTK_DOUBLE);
    put_displacements(m, s, false, file);
}

tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out)
{
    FILE *file = out->output->file;
    section s = {.normal = plane.normal};
    tl_status status = cut_blocks(m, plane, &s) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = tl_vtk_countable(s.polygons + s.points, "section", &m->error);
    if (status == TL_OK) {
        tl_vtk_header(file, m, "section", "POLYDATA");
        put_polygons(m, &s, file);
        put_section_cells(m, &s, file);
        put_point_data(m, &s, file);
    }
    free(s.corners);
    free(s.row);
    free(s.end);
    return status;
}
