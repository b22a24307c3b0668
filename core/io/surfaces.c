/* surfaces.c - writes blocks as Wavefront OBJ, as text of STL and PLY, or as polygons of a VTK legacy file.
 *
 * Numbers have the digits that give back the same double. Of OBJ each block is an object block_ID with the group of the
 * block. Of STL it is a solid with the name of the group, its faces divided into fans of triangles. PLY and VTK have
 * vertices and faces; a block is what hangs together. */
#include "io/surfaces.h"

#include "io/json.h"
#include "io/pieces.h"

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

static void put_triangles(const writer *w, uint32_t row, tl_piece *to)
{
    const tl_poly *shape = w->m->blocks.shape[row];
    const uint32_t body = w->m->blocks.body[row];
    for (uint32_t f = 0; f < shape->face_count; f++)
        for (uint32_t i = shape->start[f] + 1; i + 1 < shape->start[f + 1]; i++) {
            put_point(to, "facet normal ", tl_v3(0, 0, 0)); /* readers take it from the corners */
            tl_json_put(to, "outer loop\n");
            put_point(to, "vertex ", tl_model_point(w->m, body, shape->vertex[shape->loop[shape->start[f]]]));
            put_point(to, "vertex ", tl_model_point(w->m, body, shape->vertex[shape->loop[i]]));
            put_point(to, "vertex ", tl_model_point(w->m, body, shape->vertex[shape->loop[i + 1]]));
            tl_json_put(to, "endloop\nendfacet\n");
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
