/* block_mesh.c - the shape of a block in its place. */
#include "model/model.h"

#include <stdlib.h>
#include <string.h>
#include <talus/views.h>

/* The faces of a block's shape, and its vertices and normals in its body's frame. */
tl_status tl_block_mesh_local(tl_model *m, tl_id block, tl_block_mesh *mesh)
{
    *mesh = (tl_block_mesh){0};
    uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    const tl_poly *shape = m->blocks.shape[row];
    size_t corners = shape->start[shape->face_count];
    mesh->vertex_count = shape->vertex_count;
    mesh->face_count = shape->face_count;
    mesh->vertices = malloc(shape->vertex_count * sizeof *mesh->vertices);
    mesh->start = malloc((shape->face_count + 1u) * sizeof *mesh->start);
    mesh->loops = malloc(corners * sizeof *mesh->loops);
    mesh->tags = malloc(shape->face_count * sizeof *mesh->tags);
    mesh->normals = malloc(shape->face_count * sizeof *mesh->normals);
    if (!mesh->vertices || !mesh->start || !mesh->loops || !mesh->tags || !mesh->normals) {
        tl_block_mesh_free(mesh);
        return tl_fail_memory(&m->error);
    }
    memcpy(mesh->vertices, shape->vertex, shape->vertex_count * sizeof *mesh->vertices);
    for (size_t f = 0; f <= shape->face_count; f++)
        mesh->start[f] = shape->start[f];
    for (size_t i = 0; i < corners; i++)
        mesh->loops[i] = shape->loop[i];
    memcpy(mesh->tags, shape->tag, shape->face_count * sizeof *mesh->tags);
    for (uint32_t i = 0; i < shape->face_count; i++)
        mesh->normals[i] = shape->plane[i].normal;
    return TL_OK;
}

tl_status tl_block_mesh_get(tl_model *m, tl_id block, tl_block_mesh *mesh)
{
    tl_status status = tl_block_mesh_local(m, block, mesh);
    if (status != TL_OK)
        return status;
    uint32_t body = m->blocks.body[tl_block_row_quiet(m, block)];
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = tl_model_point(m, body, mesh->vertices[i]);
    for (size_t i = 0; i < mesh->face_count; i++)
        mesh->normals[i] = tl_m3_mul(&m->bodies.pose[body].r, mesh->normals[i]);
    return TL_OK;
}

void tl_block_mesh_free(tl_block_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->start);
    free(mesh->loops);
    free(mesh->tags);
    free(mesh->normals);
    *mesh = (tl_block_mesh){0};
}
