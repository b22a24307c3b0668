/* surfaces.c - writes blocks as Wavefront OBJ, as text of STL and PLY, or as polygons of a VTK legacy file.
 *
 * Numbers have the digits that give back the same double. Of OBJ each block is an object block_ID with the group of the
 * block. Of STL it is a solid with the name of the group, its faces divided into triangles. PLY and VTK have
 * vertices and faces; a block is what hangs together. */
#include "io/surfaces.h"

#include "io/json.h"
#include "io/pieces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a block's text, about. */
#define BLOCK_TEXT 1200

typedef struct writer {
    const tl_model *m;
    tl_surface_format format;
    const uint32_t *first; /* [blocks + 1] vertices of the blocks before, where all are numbered through */
} writer;

static bool ends_in(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    if (length < tail)
        return false;
    for (size_t i = 0; i < tail; i++) {
        char letter = path[length - tail + i];
        if ((letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter) != ending[i])
            return false;
    }
    return true;
}

tl_surface_format tl_surface_format_of(const char *path)
{
    static const char *const endings[] = {".obj", ".stl", ".ply", ".vtk"};
    for (int i = 0; path && i < 4; i++)
        if (ends_in(path, endings[i]))
            return (tl_surface_format)(TL_SURFACES_OBJ + i);
    return TL_SURFACES_NONE;
}

/* A name in a line of its own: control characters become spaces. */
static void put_name(tl_piece *to, const char *name)
{
    for (; *name; name++)
        tl_piece_put(to, (unsigned char)*name < ' ' ? " " : name, 1);
}

static void put_point(tl_piece *to, const char *before, tl_vec3 at)
{
    tl_json_print(to, "%r%g %g %g\n", before, at.x, at.y, at.z);
}

static void put_vertices(const writer *w, uint32_t row, const char *before, tl_piece *to)
{
    const tl_poly *shape = w->m->blocks.shape[row];
    for (uint32_t i = 0; i < shape->vertex_count; i++)
        put_point(to, before, tl_model_point(w->m, w->m->blocks.body[row], shape->vertex[i]));
}

/* A line for each face: `before` or its number of corners, and its vertices counted from `base`. */
static void put_faces(const writer *w, uint32_t row, const char *before, uint32_t base, tl_piece *to)
{
    const tl_poly *shape = w->m->blocks.shape[row];
    for (uint32_t f = 0; f < shape->face_count; f++) {
        if (before)
            tl_json_put(to, before);
        else
            tl_json_print(to, "%u", (uint32_t)(shape->start[f + 1] - shape->start[f]));
        for (uint32_t i = shape->start[f]; i < shape->start[f + 1]; i++)
            tl_json_print(to, " %u", base + w->first[row] + shape->loop[i]);
        tl_json_put(to, "\n");
    }
}

/* How far the corners of a face that are left reach above the triangle of corner i and its neighbours; INFINITY: it has
 * no area. */
static double reach_above(const tl_poly *shape, const uint16_t *left, uint32_t count, uint32_t i)
{
    const tl_vec3 a = shape->vertex[left[(i + count - 1) % count]], b = shape->vertex[left[i]];
    const tl_vec3 normal = tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(shape->vertex[left[(i + 1) % count]], a));
    const double length = tl_v3_norm(normal);
    double above = 0;
    for (uint32_t k = 0; k < count; k++)
        above = fmax(above, tl_v3_dot(normal, tl_v3_sub(shape->vertex[left[k]], a)));
    return length > 0 ? above / length : (double)INFINITY;
}

/* The corner that is cut off a face next: the first whose triangle leaves the others below its plane. The triangles of
 * a face that is bent then bend outward, as its block does. Those of a plane face are a fan. */
static uint32_t next_ear(const tl_poly *shape, const uint16_t *left, uint32_t count)
{
    uint32_t best = 1;
    double least = INFINITY;
    for (uint32_t i = 1; i <= count && least > TL_POLY_ON * shape->size; i++) {
        const double above = reach_above(shape, left, count, i % count);
        if (above < least) {
            least = above;
            best = i % count;
        }
    }
    return best;
}

static void put_triangle(const writer *w, uint32_t row, const uint16_t *corner[3], tl_piece *to)
{
    put_point(to, "facet normal ", tl_v3(0, 0, 0)); /* readers take it from the corners */
    tl_json_put(to, "outer loop\n");
    for (int k = 0; k < 3; k++)
        put_point(to, "vertex ",
                  tl_model_point(w->m, w->m->blocks.body[row], w->m->blocks.shape[row]->vertex[*corner[k]]));
    tl_json_put(to, "endloop\nendfacet\n");
}

static void put_triangles(const writer *w, uint32_t row, tl_piece *to)
{
    const tl_poly *shape = w->m->blocks.shape[row];
    for (uint32_t f = 0; f < shape->face_count; f++) {
        uint16_t left[TL_POLY_MAX_VERTICES];
        uint32_t count = tl_poly_face_size(shape, f);
        memcpy(left, shape->loop + shape->start[f], count * sizeof *left);
        for (; count >= 3; count--) {
            const uint32_t i = next_ear(shape, left, count);
            const uint16_t *corner[3] = {&left[(i + count - 1) % count], &left[i], &left[(i + 1) % count]};
            put_triangle(w, row, corner, to);
            memmove(left + i, left + i + 1, (count - i - 1) * sizeof *left);
        }
    }
}

/* Blocks whose vertices and faces stand together. */
static void fill_blocks(const void *user, size_t begin, size_t end, tl_piece *to)
{
    const writer *w = user;
    for (uint32_t row = (uint32_t)begin; row < end; row++) {
        const char *group = w->m->groups[w->m->blocks.group[row]];
        if (w->format == TL_SURFACES_OBJ) {
            tl_json_print(to, "o block_%u\ng ", w->m->blocks.id[row]);
            put_name(to, group);
            tl_json_put(to, "\n");
            put_vertices(w, row, "v ", to);
            put_faces(w, row, "f", 1, to);
        } else {
            tl_json_put(to, "solid ");
            put_name(to, group);
            tl_json_put(to, "\n");
            put_triangles(w, row, to);
            tl_json_put(to, "endsolid\n");
        }
    }
}

static void fill_vertices(const void *user, size_t begin, size_t end, tl_piece *to)
{
    for (uint32_t row = (uint32_t)begin; row < end; row++)
        put_vertices(user, row, "", to);
}

static void fill_faces(const void *user, size_t begin, size_t end, tl_piece *to)
{
    for (uint32_t row = (uint32_t)begin; row < end; row++)
        put_faces(user, row, NULL, 0, to);
}

/* Heads of PLY and VTK, all vertices, and all faces. */
static tl_status write_lists(tl_pieces *pieces, const writer *w)
{
    const tl_model *m = w->m;
    const size_t rows = m->blocks.table.rows;
    FILE *file = pieces->output->file;
    uint32_t faces = 0, corners = 0;
    for (size_t row = 0; row < rows; row++) {
        faces += m->blocks.shape[row]->face_count;
        corners += m->blocks.shape[row]->start[m->blocks.shape[row]->face_count];
    }
    if (w->format == TL_SURFACES_PLY)
        fprintf(
            file,
            "ply\nformat ascii 1.0\ncomment blocks of Talus\nelement vertex %u\nproperty double x\nproperty double y\n"
            "property double z\nelement face %u\nproperty list ushort uint vertex_indices\nend_header\n",
            w->first[rows], faces);
    else
        fprintf(file, "# vtk DataFile Version 3.0\nblocks of Talus\nASCII\nDATASET POLYDATA\nPOINTS %u double\n",
                w->first[rows]);
    tl_status status = tl_pieces_write(pieces, rows, BLOCK_TEXT / 2, fill_vertices, w);
    if (w->format == TL_SURFACES_VTK)
        fprintf(file, "POLYGONS %u %u\n", faces, faces + corners);
    return status == TL_OK ? tl_pieces_write(pieces, rows, BLOCK_TEXT / 2, fill_faces, w) : status;
}

tl_status tl_surfaces_write(tl_output *output, tl_model *m, tl_surface_format format)
{
    const size_t rows = m->blocks.table.rows;
    uint32_t *first = calloc(rows + 1, sizeof *first);
    if (!first)
        return tl_fail_memory(&m->error);
    for (size_t row = 0; row < rows; row++)
        first[row + 1] = first[row] + m->blocks.shape[row]->vertex_count;
    const writer w = {m, format, first};
    tl_pieces pieces = {.model = m, .output = output};
    tl_status status = format == TL_SURFACES_OBJ || format == TL_SURFACES_STL
                           ? tl_pieces_write(&pieces, rows, BLOCK_TEXT, fill_blocks, &w)
                           : write_lists(&pieces, &w);
    tl_pieces_free(&pieces);
    free(first);
    return status;
}
