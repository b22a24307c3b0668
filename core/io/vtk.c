/* vtk.c - a frame for ParaView: blocks, contacts, joint faces and zones, or some of these, or a section, and the index
 * of each series. Files of one number are of one frame; a part that is left out of a frame has no file of that number.
 *
 * The files of a frame are all written under temporary names before the first is renamed. So a full disk or a folder
 * without permission leaves the series as it was. */

#include "base/columns.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/signals.h"
#include "element/elements.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/vtk_contacts.h"
#include "io/vtk_elements.h"
#include "io/vtk_file.h"
#include "io/vtk_section.h"
#include "io/vtk_series.h"
#include "io/vtk_zones.h"
#include "model/options.h"
#include "model/rows.h"
#include "query/block_fields.h"
#include "state/outputs.h"
#include "zone/zones.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/text.h>

/* ---------------------------------------------------------------- blocks -----------------
 *
 * The blocks of a frame: UNSTRUCTURED_GRID of polyhedra (cell type 42).
 *
 * A polyhedron is a face stream: number of faces, then for each face its number of vertices and
 * their indices, counter-clockwise from outside. Vertices are not shared between blocks, so that
 * blocks can be moved apart. A deformable block has the triangles of its surface for faces, as they are now.
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

/* The model and what its rows need of each other. */
typedef struct grid {
    const tl_model *model;
    const tl_blocks *blocks;
    uint32_t *first; /* [rows + 1] index of the block's first vertex */
    tl_vec3 centre;  /* of the model */
    bool deforms;    /* some blocks are deformable */
    tl_block_surfaces surfaces;
} grid;

static bool has_zones(const grid *g, size_t row)
{
    return g->deforms && tl_surface_triangles(&g->surfaces, row) > 0;
}

static uint32_t vertices_of(const grid *g, size_t row)
{
    return has_zones(g, row) ? tl_surface_vertices(&g->surfaces, row) : g->blocks->shape[row]->vertex_count;
}

/* Integers of a block's face stream, with its leading length. */
static size_t stream_of(const grid *g, size_t row)
{
    const tl_poly *shape = g->blocks->shape[row];
    return has_zones(g, row) ? 2u + 4u * (size_t)tl_surface_triangles(&g->surfaces, row)
                             : 2u + shape->face_count + shape->start[shape->face_count];
}

/* ---------------------------------------------------------------- points ----------------- */

/* Puts a vector of a gridpoint: where it is, or how far it has moved. */
typedef unsigned char *(*gridpoint_fn)(const tl_model *m, uint32_t gridpoint, unsigned char *to);

static unsigned char *put_gridpoint_place(const tl_model *m, uint32_t gridpoint, unsigned char *to)
{
    return tl_vtk_put_vec3(to, tl_v3_add(m->origin, tl_gridpoint_place(&m->zones->points, gridpoint)));
}

static unsigned char *put_gridpoint_moved(const tl_model *m, uint32_t gridpoint, unsigned char *to)
{
    return tl_vtk_put_float3(to, tl_columns_get(m->zones->points.u, gridpoint));
}

/* A vector of each vertex of rows. */
static inline void fill_vertices(const grid *g, size_t begin, size_t end, tl_piece *piece, tl_vtk_point_fn of,
                                 gridpoint_fn of_gridpoint, size_t each)
{
    unsigned char *to = tl_piece_add(piece, (g->first[end] - g->first[begin]) * each);
    for (uint32_t row = (uint32_t)begin; to && row < end; row++) {
        const tl_poly *shape = g->blocks->shape[row];
        for (uint32_t v = 0; v < vertices_of(g, row); v++)
            to = has_zones(g, row) ? of_gridpoint(g->model, g->surfaces.vertex[g->surfaces.vertex_start[row] + v], to)
                                   : of(g->model, row, shape->vertex[v], to);
    }
}

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, tl_vtk_put_place, put_gridpoint_place, TL_VTK_VEC3_BYTES);
}

static void fill_displacements(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_vertices(user, begin, end, piece, tl_vtk_put_moved, put_gridpoint_moved, TL_VTK_FLOAT3_BYTES);
}

/* From the model's centre to the block's: the same for all its vertices. */
static void fill_explode(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const grid *g = user;
    unsigned char *to = tl_piece_add(piece, (g->first[end] - g->first[begin]) * TL_VTK_FLOAT3_BYTES);
    for (uint32_t row = (uint32_t)begin; to && row < end; row++)
        for (uint32_t v = g->first[row]; v < g->first[row + 1]; v++)
            to = tl_vtk_put_float3(to, tl_v3_sub(tl_block_centroid(g->model, row), g->centre));
}

/* ---------------------------------------------------------------- cells ------------------ */

/* The faces of a rigid block. */
static unsigned char *put_faces(const grid *g, uint32_t row, unsigned char *to)
{
    const tl_poly *shape = g->blocks->shape[row];
    to = tl_vtk_put_int(to, (int32_t)shape->face_count);
    for (uint32_t face = 0; face < shape->face_count; face++) {
        to = tl_vtk_put_int(to, (int32_t)tl_poly_face_size(shape, face));
        for (uint32_t i = shape->start[face]; i < shape->start[face + 1]; i++)
            to = tl_vtk_put_int(to, (int32_t)(g->first[row] + shape->loop[i]));
    }
    return to;
}

/* Those of a deformable one. */
static unsigned char *put_triangles(const grid *g, uint32_t row, unsigned char *to)
{
    to = tl_vtk_put_int(to, (int32_t)tl_surface_triangles(&g->surfaces, row));
    for (uint32_t k = g->surfaces.triangle_start[row]; k < g->surfaces.triangle_start[row + 1]; k++) {
        to = tl_vtk_put_int(to, 3);
        for (int c = 0; c < 3; c++)
            to = tl_vtk_put_int(to, (int32_t)(g->first[row] + g->surfaces.triangle[k][c]));
    }
    return to;
}

static void fill_cells(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const grid *g = user;
    for (uint32_t row = (uint32_t)begin; row < end; row++) {
        unsigned char *to = tl_piece_add(piece, stream_of(g, row) * TL_VTK_INT_BYTES);
        if (!to)
            return;
        to = tl_vtk_put_int(to, (int32_t)stream_of(g, row) - 1);
        if (has_zones(g, row))
            put_triangles(g, row, to);
        else
            put_faces(g, row, to);
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
    tl_vtk_header(file, m, "blocks", "UNSTRUCTURED_GRID", false);
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

static void free_grid(grid *g)
{
    tl_block_surfaces_free(&g->surfaces);
    free(g->first);
}

static tl_status put_blocks(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    const tl_blocks *b = &m->blocks;
    grid g = {.model = m, .blocks = b, .centre = model_centre(m), .deforms = tl_model_deforms(m)};
    g.first = calloc(b->table.rows + 1, sizeof *g.first);
    tl_status status = g.first ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK && g.deforms)
        status = tl_block_surfaces_find(m, &g.surfaces);
    size_t stream = 0;
    for (size_t row = 0; status == TL_OK && row < b->table.rows; row++) {
        stream += stream_of(&g, row);
        g.first[row + 1] = g.first[row] + vertices_of(&g, row);
    }
    if (status == TL_OK)
        status = tl_vtk_countable(stream, "blocks", &m->error);
    if (status == TL_OK)
        status = check_fields(m, parts);
    if (status == TL_OK)
        status = put_grid(m, &g, stream, parts, out);
    free_grid(&g);
    return status;
}

/* ---------------------------------------------------------------- frames ------------------ */

typedef struct part {
    const char *content; /* in the file's name */
    tl_status (*write)(tl_model *m, const tl_vtk_parts *fields, tl_pieces *out);
} part;

/* What is written: the parts of a kind of frame whose bits are set. */
typedef struct frame {
    const char *function; /* of the user's */
    const part *parts;
    size_t count;
    unsigned wanted;
    const tl_plane *section;    /* of a section */
    const tl_vtk_parts *fields; /* of a whole frame: what is added to its arrays */
} frame;

enum { BLOCKS, CONTACTS, JOINTS, ZONES, ELEMENTS, PART_COUNT };

static const part frame_parts[PART_COUNT] = {
    [BLOCKS] = {"blocks", put_blocks}, [CONTACTS] = {"contacts", tl_vtk_contacts}, [JOINTS] = {"joints", tl_vtk_joints},
    [ZONES] = {"zones", tl_vtk_zones}, [ELEMENTS] = {"elements", tl_vtk_elements},
};

static const part section_part = {"section", NULL};

static_assert(PART_COUNT <= TL_VTK_PARTS, "a series has an index for each file of a frame");

static bool wants(const frame *f, size_t i)
{
    return f->wanted >> i & 1;
}

static tl_status write_part(tl_model *m, const tl_vtk_series *series, const frame *f, size_t i, tl_pieces *pieces,
                            tl_output *output)
{
    const part *p = &f->parts[i];
    char *name = tl_vtk_frame_name(series, p->content, series->count);
    tl_status status = name ? tl_output_open(output, name, &m->error) : tl_fail_memory(&m->error);
    free(name);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    pieces->output = output;
    if (status == TL_OK)
        status = f->section ? tl_vtk_section(m, *f->section, pieces) : p->write(m, f->fields, pieces);
    return status == TL_OK ? tl_output_finish(output, &m->error) : status;
}

static tl_status check_prefix(const char *function, const char *prefix, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT, "%s: prefix = '%s' must end in a name for the files, as in 'out/run'",
                       function, prefix);
    const char *slash = strrchr(prefix, '/');
    if (!tl_text_is_utf8(slash ? slash + 1 : prefix))
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: prefix = '%s' must end in a name in UTF-8, as the list of the frames has it, which is JSON",
                       function, prefix);
    return TL_OK;
}

/* The data first, then the indices, so that no index ever names a file that is not there. */
static tl_status write_files(tl_model *m, tl_vtk_series *series, const frame *f, double time)
{
    tl_output data[PART_COUNT] = {{0}};
    tl_vtk_index_change indices[PART_COUNT] = {{.file = 0}};
    tl_pieces pieces = {.model = m};
    tl_status status = TL_OK;
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = write_part(m, series, f, i, &pieces, &data[i]);
    tl_pieces_free(&pieces);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = tl_vtk_index_open(&indices[i], series, i, f->parts[i].content, time, &m->error);
    if (status == TL_OK)
        status = tl_model_go_on(m);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = tl_output_commit(&data[i], &m->error);
    for (size_t i = 0; status == TL_OK && i < f->count; i++)
        if (wants(f, i))
            status = tl_vtk_index_commit(&indices[i], &m->error);
    for (size_t i = 0; i < f->count; i++) {
        tl_output_drop(&data[i]);
        tl_vtk_index_drop(&indices[i]);
    }
    return status;
}

/* Writes the next frame of the series of that prefix and kind. */
static tl_status write_frame(tl_model *m, const char *prefix, const frame *f)
{
    tl_status status = check_prefix(f->function, prefix, &m->error);
    if (status != TL_OK)
        return status;
    char *own = tl_output_prefix(prefix, ".vtk");
    tl_vtk_series *series = own ? tl_vtk_series_of(m, own, f->parts[0].content) : NULL;
    free(own);
    if (!series)
        return tl_fail_memory(&m->error);

    sigset_t before;
    tl_signals_hold(&before, false);
    atomic_store(&m->interrupted, false);
    double time = tl_vtk_series_time(series, m->time);
    status = write_files(m, series, f, time);
    tl_signals_release(&before);
    if (status == TL_OK)
        tl_vtk_series_add(series, time, f->wanted);
    else if (status == TL_E_IO)
        tl_error_prefix(&m->error, "%s: ", f->function);
    return status;
}

tl_status tl_write_vtk(tl_model *m, const char *prefix, const tl_vtk_parts *parts)
{
    tl_vtk_parts of;
    tl_status status = TL_OPTIONS_READ(tl_vtk_parts, parts, &of, &m->error);
    if (status != TL_OK)
        return status;
    frame f = {.function = "write_vtk", .parts = frame_parts, .count = PART_COUNT, .fields = &of};
    f.wanted = (unsigned)(of.blocks != 0) << BLOCKS | (unsigned)(of.contacts != 0) << CONTACTS |
               (unsigned)(of.joints != 0) << JOINTS;
    tl_rows_tidy(m);
    if (of.zones != 0 && tl_model_deforms(m))
        f.wanted |= 1u << ZONES;
    if (of.elements != 0 && tl_model_has_elements(m))
        f.wanted |= 1u << ELEMENTS;
    if (f.wanted == 0)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "write_vtk: blocks, contacts and joints are all false, %s, so there is nothing "
                       "to write; leave out what is to be written",
                       of.zones ? "and no block is deformable" : "zones as well");
    return write_frame(m, prefix, &f);
}

tl_status tl_write_section(tl_model *m, const char *prefix, const tl_halfspace *plane)
{
    tl_rows_tidy(m);
    if (!(plane->dip >= 0 && plane->dip <= 90) || !isfinite(plane->dip_direction) || !tl_v3_finite(plane->origin))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "write_section: dip = %g must be in [0, 90], dip_direction and origin finite", plane->dip);
    tl_vec3 normal = tl_plane_normal(plane->dip, plane->dip_direction);
    tl_plane cut = {normal, tl_v3_dot(normal, tl_v3_sub(plane->origin, m->origin))};
    const frame f = {"write_section", &section_part, 1, 1, &cut, NULL};
    return write_frame(m, prefix, &f);
}
