/* block_model.c - writes the blocks of a model into a JSON file; docs/block_model.md describes it. Numbers
 * are written with the digits that give back the same double. Names of other endings ask for surfaces (surfaces.c). */
#include "base/output_file.h"
#include "io/json.h"
#include "io/pieces.h"
#include "io/surfaces.h"
#include "model/rows.h"

#include <string.h>

/* Bytes of a block's text, about. */
#define BLOCK_TEXT 1000

/* ---------------------------------------------------------------- blocks ----------------- */

static void put_faces(tl_piece *to, const tl_model *m, const tl_poly *shape)
{
    for (uint32_t f = 0; f < shape->face_count; f++) {
        tl_json_put(to, f ? ",\n      {\"vertices\": [" : "\n      {\"vertices\": [");
        for (uint32_t i = shape->start[f]; i < shape->start[f + 1]; i++)
            tl_json_print(to, i > shape->start[f] ? ", %u" : "%u", (uint32_t)shape->loop[i]);
        tl_json_put(to, "]");
        if (shape->tag[f].joint)
            tl_json_print(to, ", \"joint\": %s, \"plane\": %u", m->joints[shape->tag[f].joint - 1].name,
                          shape->tag[f].plane);
        tl_json_put(to, "}");
    }
}

static void put_fixed(tl_piece *to, unsigned fixed)
{
    static const char *const names[] = {"x", "y", "z", "rotation"};
    const char *between = "";
    for (unsigned i = 0; i < 4; i++)
        if (fixed & 1u << i) {
            tl_json_print(to, "%r%s", between, names[i]);
            between = ", ";
        }
}

static void put_block(tl_piece *to, const tl_model *m, uint32_t row)
{
    const uint32_t body = m->blocks.body[row];
    const tl_poly *shape = m->blocks.shape[row];
    tl_json_print(to, "%r\n    {\"id\": %u, \"group\": %s, \"density\": %g, \"body\": %u, \"fixed\": [", row ? "," : "",
                  m->blocks.id[row], m->groups[m->blocks.group[row]], m->blocks.density[row], m->bodies.id[body]);
    put_fixed(to, m->bodies.fixed[body]);
    tl_json_print(to, "], \"hidden\": %r,\n     \"vertices\": [", m->blocks.hidden[row] ? "true" : "false");
    for (uint32_t i = 0; i < shape->vertex_count; i++)
        tl_json_print(to, i ? ", %v" : "%v", tl_model_point(m, body, shape->vertex[i]));
    tl_json_put(to, "],\n     \"faces\": [");
    put_faces(to, m, shape);
    tl_json_put(to, "]}");
}

static void fill_blocks(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    for (size_t row = begin; row < end; row++)
        put_block(piece, user, (uint32_t)row);
}

/* ---------------------------------------------------------------- the file --------------- */

static void fill_joints(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const tl_model *m = user;
    for (size_t i = begin; i < end; i++)
        tl_json_print(piece, "%r\n    {\"name\": %s, \"planes\": %u}", i ? "," : "", m->joints[i].name,
                      m->joints[i].planes);
}

static tl_status write_model(tl_output *output, void *user)
{
    tl_model *m = user;
    FILE *file = output->file;
    tl_pieces pieces = {.model = m, .output = output};
    fputs("{\"format\": \"talus block model\", \"version\": 1,\n  \"joints\": [", file);
    tl_status status = tl_pieces_write(&pieces, m->joint_count, BLOCK_TEXT, fill_joints, m);
    fputs("],\n  \"blocks\": [", file);
    if (status == TL_OK)
        status = tl_pieces_write(&pieces, m->blocks.table.rows, BLOCK_TEXT, fill_blocks, m);
    fputs("]}\n", file);
    tl_pieces_free(&pieces);
    return status;
}

typedef struct surfaces_args {
    tl_model *model;
    tl_surface_format format;
} surfaces_args;

static tl_status write_surfaces(tl_output *output, void *user)
{
    const surfaces_args *args = user;
    return tl_surfaces_write(output, args->model, args->format);
}

tl_status tl_write_blocks(tl_model *m, const char *path)
{
    tl_rows_tidy(m);
    atomic_store(&m->interrupted, false);
    surfaces_args args = {m, tl_surface_format_of(path)};
    tl_status status = args.format == TL_SURFACES_NONE ? tl_output_whole(path, write_model, m, &m->error)
                                                       : tl_output_whole(path, write_surfaces, &args, &m->error);
    if (status != TL_OK && status != TL_E_MEMORY)
        tl_error_prefix(&m->error, "write_blocks: ");
    return status;
}
