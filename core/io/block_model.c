/* block_model.c - writes the blocks of a model into a JSON file; docs/block_model.md describes it. Numbers
 * are written with the digits that give back the same double. */
#include "base/number.h"
#include "base/signals.h"
#include "io/pieces.h"

#include <string.h>

/* Bytes of a block's text, about. */
#define BLOCK_TEXT 1000

/* ---------------------------------------------------------------- text ------------------- */

static void put_bytes(tl_piece *to, const char *text, size_t length)
{
    unsigned char *at = tl_piece_reserve(to, length);
    if (!at)
        return;
    memcpy(at, text, length);
    to->length += length;
}

static void put(tl_piece *to, const char *text)
{
    put_bytes(to, text, strlen(text));
}

static void put_number(tl_piece *to, double value)
{
    unsigned char *at = tl_piece_reserve(to, TL_NUMBER_TEXT);
    if (at)
        to->length += tl_number_text(value, (char *)at);
}

static void put_whole(tl_piece *to, uint32_t value)
{
    char digits[10];
    size_t at = sizeof digits;
    do
        digits[--at] = (char)('0' + value % 10);
    while ((value /= 10) > 0);
    put_bytes(to, digits + at, sizeof digits - at);
}

/* A text in quotes, escaped as JSON wants it. */
static void put_text(tl_piece *to, const char *text)
{
    put(to, "\"");
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        char escaped[8] = {(char)*c, '\0'};
        if (*c == '"' || *c == '\\')
            snprintf(escaped, sizeof escaped, "\\%c", *c);
        else if (*c < ' ')
            snprintf(escaped, sizeof escaped, "\\u%04x", *c);
        put(to, escaped);
    }
    put(to, "\"");
}

/* ---------------------------------------------------------------- blocks ----------------- */

static void put_vertices(tl_piece *to, const tl_model *m, uint32_t row)
{
    const tl_poly *shape = m->blocks.shape[row];
    put(to, "\"vertices\": [");
    for (uint32_t i = 0; i < shape->vertex_count; i++) {
        tl_vec3 at = tl_model_point(m, m->blocks.body[row], shape->vertex[i]);
        put(to, i ? ", [" : "[");
        put_number(to, at.x);
        put(to, ", ");
        put_number(to, at.y);
        put(to, ", ");
        put_number(to, at.z);
        put(to, "]");
    }
    put(to, "]");
}

static void put_faces(tl_piece *to, const tl_model *m, const tl_poly *shape)
{
    put(to, "\"faces\": [");
    for (uint32_t f = 0; f < shape->face_count; f++) {
        put(to, f ? ",\n      {\"vertices\": [" : "\n      {\"vertices\": [");
        for (uint32_t i = shape->start[f]; i < shape->start[f + 1]; i++) {
            if (i > shape->start[f])
                put(to, ", ");
            put_whole(to, shape->loop[i]);
        }
        put(to, "]");
        if (shape->tag[f].joint) {
            put(to, ", \"joint\": ");
            put_text(to, m->joints[shape->tag[f].joint - 1].name);
            put(to, ", \"plane\": ");
            put_whole(to, shape->tag[f].plane);
        }
        put(to, "}");
    }
    put(to, "]");
}

static void put_fixed(tl_piece *to, unsigned fixed)
{
    static const char *const names[] = {"\"x\"", "\"y\"", "\"z\"", "\"rotation\""};
    put(to, "\"fixed\": [");
    bool first = true;
    for (unsigned i = 0; i < 4; i++) {
        if (!(fixed & 1u << i))
            continue;
        put(to, first ? "" : ", ");
        put(to, names[i]);
        first = false;
    }
    put(to, "]");
}

static void put_block(tl_piece *to, const tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    put(to, row ? ",\n    {\"id\": " : "\n    {\"id\": ");
    put_whole(to, m->blocks.id[row]);
    put(to, ", \"group\": ");
    put_text(to, m->groups[m->blocks.group[row]]);
    put(to, ", \"density\": ");
    put_number(to, m->blocks.density[row]);
    put(to, ", \"body\": ");
    put_whole(to, m->bodies.id[body]);
    put(to, ", ");
    put_fixed(to, m->bodies.fixed[body]);
    put(to, m->blocks.hidden[row] ? ", \"hidden\": true,\n     " : ", \"hidden\": false,\n     ");
    put_vertices(to, m, row);
    put(to, ",\n     ");
    put_faces(to, m, m->blocks.shape[row]);
    put(to, "}");
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
    for (size_t i = begin; i < end; i++) {
        put(piece, i ? ",\n    {\"name\": " : "\n    {\"name\": ");
        put_text(piece, m->joints[i].name);
        put(piece, ", \"planes\": ");
        put_whole(piece, m->joints[i].planes);
        put(piece, "}");
    }
}

static tl_status write_model(tl_output *output, tl_model *m)
{
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

static tl_status write_file(tl_model *m, const char *path)
{
    tl_output output = {0};
    atomic_store(&m->interrupted, false);
    tl_status status = tl_output_open(&output, path, &m->error);
    if (status == TL_OK)
        status = write_model(&output, m);
    if (status == TL_OK)
        status = tl_output_finish(&output, &m->error);
    if (status == TL_OK)
        status = tl_output_commit(&output, &m->error);
    tl_output_drop(&output);
    return status;
}

tl_status tl_write_blocks(tl_model *m, const char *path)
{
    tl_rows_tidy(m);
    sigset_t before;
    tl_signals_hold(&before, false);
    tl_status status = write_file(m, path);
    tl_signals_release(&before);
    if (status != TL_OK && status != TL_E_MEMORY)
        tl_error_prefix(&m->error, "write_blocks: ");
    return status;
}
