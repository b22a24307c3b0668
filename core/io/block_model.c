/* block_model.c - writes the blocks of a model into a JSON file; docs/block_model.md describes it. Numbers
 * are written with the digits that give back the same double. */
#include "base/params.h"
#include "base/signals.h"
#include "io/output_file.h"
#include "model/model.h"

/* A text in quotes, escaped as JSON wants it. */
static void write_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
        if (*c == '"' || *c == '\\')
            fprintf(file, "\\%c", *c);
        else if (*c < ' ')
            fprintf(file, "\\u%04x", *c);
        else
            fputc(*c, file);
    }
    fputc('"', file);
}

static void write_vertices(FILE *file, const tl_block_mesh *mesh)
{
    fputs("\"vertices\": [", file);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        char x[TL_NUMBER_TEXT], y[TL_NUMBER_TEXT], z[TL_NUMBER_TEXT];
        tl_number_text(mesh->vertices[i].x, x);
        tl_number_text(mesh->vertices[i].y, y);
        tl_number_text(mesh->vertices[i].z, z);
        fprintf(file, "%s[%s, %s, %s]", i ? ", " : "", x, y, z);
    }
    fputs("]", file);
}

static void write_faces(FILE *file, const tl_model *m, const tl_block_mesh *mesh)
{
    fputs("\"faces\": [", file);
    for (size_t f = 0; f < mesh->face_count; f++) {
        fprintf(file, "%s\n      {\"vertices\": [", f ? "," : "");
        for (uint32_t i = mesh->start[f]; i < mesh->start[f + 1]; i++)
            fprintf(file, "%s%u", i > mesh->start[f] ? ", " : "", mesh->loops[i]);
        fputs("]", file);
        if (mesh->tags[f].joint) {
            fputs(", \"joint\": ", file);
            write_text(file, m->joints[mesh->tags[f].joint - 1].name);
            fprintf(file, ", \"plane\": %u", mesh->tags[f].plane);
        }
        fputs("}", file);
    }
    fputs("]", file);
}

static void write_fixed(FILE *file, unsigned fixed)
{
    static const char *const names[] = {"x", "y", "z", "rotation"};
    fputs("\"fixed\": [", file);
    bool first = true;
    for (unsigned i = 0; i < 4; i++) {
        if (!(fixed & 1u << i))
            continue;
        fprintf(file, "%s\"%s\"", first ? "" : ", ", names[i]);
        first = false;
    }
    fputs("]", file);
}

static tl_status write_block(FILE *file, tl_model *m, uint32_t row)
{
    tl_block_mesh mesh;
    tl_status status = tl_block_mesh_get(m, m->blocks.id[row], &mesh);
    if (status != TL_OK)
        return status;
    uint32_t body = m->blocks.body[row];
    char density[TL_NUMBER_TEXT];
    tl_number_text(m->blocks.density[row], density);
    fprintf(file, "%s\n    {\"id\": %u, \"group\": ", row ? "," : "", m->blocks.id[row]);
    write_text(file, m->groups[m->blocks.group[row]]);
    fprintf(file, ", \"density\": %s, \"body\": %u, ", density, m->bodies.id[body]);
    write_fixed(file, m->bodies.fixed[body]);
    fprintf(file, ", \"hidden\": %s,\n     ", m->blocks.hidden[row] ? "true" : "false");
    write_vertices(file, &mesh);
    fputs(",\n     ", file);
    write_faces(file, m, &mesh);
    fputs("}", file);
    tl_block_mesh_free(&mesh);
    return TL_OK;
}

static tl_status write_model(FILE *file, tl_model *m)
{
    fputs("{\"format\": \"talus block model\", \"version\": 1,\n  \"joints\": [", file);
    for (size_t i = 0; i < m->joint_count; i++) {
        fprintf(file, "%s\n    {\"name\": ", i ? "," : "");
        write_text(file, m->joints[i].name);
        fprintf(file, ", \"planes\": %u}", m->joints[i].planes);
    }
    fputs("],\n  \"blocks\": [", file);
    tl_status status = TL_OK;
    for (uint32_t row = 0; row < m->blocks.table.rows && status == TL_OK; row++) {
        status = write_block(file, m, row);
        if (status == TL_OK)
            status = tl_output_go_on(m);
    }
    fputs("]}\n", file);
    return status;
}

static tl_status write_file(tl_model *m, const char *path)
{
    tl_output output = {0};
    atomic_store(&m->interrupted, false);
    tl_status status = tl_output_open(&output, path, &m->error);
    if (status == TL_OK)
        status = write_model(output.file, m);
    if (status == TL_OK)
        status = tl_output_finish(&output, &m->error);
    if (status == TL_OK)
        status = tl_output_commit(&output, &m->error);
    tl_output_drop(&output);
    return status;
}

tl_status tl_write_blocks(tl_model *m, const char *path)
{
    sigset_t before;
    tl_signals_hold(&before, false);
    tl_status status = write_file(m, path);
    tl_signals_release(&before);
    if (status != TL_OK && status != TL_E_MEMORY)
        tl_error_prefix(&m->error, "write_blocks: ");
    return status;
}
