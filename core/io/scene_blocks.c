/* scene_blocks.c - SHAP and FRAM: shapes once, places and motions in every frame.
 *
 * A block's frame is that of its body, moved to the block's own centroid, so the quaternion of its body turns it, and rows
 * need nothing of an earlier frame. */
#include "io/scene_blocks.h"

#include "base/parallel.h"
#include "io/pieces.h"
#include "io/scene_put.h"
#include "model/regroup.h"

#include <stdlib.h>
#include <talus/vmath.h>

/* Blocks that a thread takes at a time. */
#define CHUNK 1024

/* ---------------------------------------------------------------- shapes ----------------- */

typedef struct shape_counts {
    size_t vertices, faces, corners;
} shape_counts;

typedef struct shape_columns {
    unsigned char *id, *body, *group, *vertices, *faces, *volume, *density, *centroid, *vertex,
        *joint, *plane, *corners, *loop;
} shape_columns;

static void put_shape(shape_columns *to, const tl_model *m, uint32_t row)
{
    const tl_blocks *b = &m->blocks;
    const tl_poly *shape = b->shape[row];
    tl_vec3 local = tl_block_local(m, row);
    to->id = tl_put_u32(to->id, b->id[row]);
    to->body = tl_put_u32(to->body, m->bodies.id[b->body[row]]);
    to->group = tl_put_u32(to->group, b->group[row]);
    to->vertices = tl_put_u32(to->vertices, shape->vertex_count);
    to->faces = tl_put_u32(to->faces, shape->face_count);
    to->volume = tl_put_f32(to->volume, b->volume[row]);
    to->density = tl_put_f32(to->density, b->density[row]);
    to->centroid = tl_put_vec3(to->centroid, tl_v3_sub(tl_block_centroid(m, row), m->origin));
    for (uint32_t v = 0; v < shape->vertex_count; v++)
        to->vertex = tl_put_vec3(to->vertex, tl_v3_sub(shape->vertex[v], local));
    for (uint32_t f = 0; f < shape->face_count; f++) {
        to->joint = tl_put_u32(to->joint, shape->tag[f].joint);
        to->plane = tl_put_u32(to->plane, shape->tag[f].plane);
        to->corners = tl_put_u16(to->corners, tl_poly_face_size(shape, f));
    }
    for (uint32_t i = 0; i < shape->start[shape->face_count]; i++)
        to->loop = tl_put_u16(to->loop, shape->loop[i]);
}

tl_status tl_scene_shapes(tl_model *m, const uint32_t *rows, size_t count, tl_piece *out)
{
    shape_counts n = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const tl_poly *shape = m->blocks.shape[rows[i]];
        n.vertices += shape->vertex_count;
        n.faces += shape->face_count;
        n.corners += shape->start[shape->face_count];
    }
    size_t bytes = 16 + count * 40 + n.vertices * 12 + n.faces * 8 +
                   tl_scene_column_bytes(n.faces, 2) + tl_scene_column_bytes(n.corners, 2);
    unsigned char *to = tl_scene_chunk(out, "SHAP", bytes, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)count);
    to = tl_put_u32(to, (uint32_t)n.vertices);
    to = tl_put_u32(to, (uint32_t)n.faces);
    to = tl_put_u32(to, (uint32_t)n.corners);
    shape_columns columns = {.id = tl_scene_column(&to, count, 4),
                             .body = tl_scene_column(&to, count, 4),
                             .group = tl_scene_column(&to, count, 4),
                             .vertices = tl_scene_column(&to, count, 4),
                             .faces = tl_scene_column(&to, count, 4),
                             .volume = tl_scene_column(&to, count, 4),
                             .density = tl_scene_column(&to, count, 4),
                             .centroid = tl_scene_column(&to, count, 12),
                             .vertex = tl_scene_column(&to, n.vertices, 12),
                             .joint = tl_scene_column(&to, n.faces, 4),
                             .plane = tl_scene_column(&to, n.faces, 4),
                             .corners = tl_scene_column(&to, n.faces, 2),
                             .loop = tl_scene_column(&to, n.corners, 2)};
    for (size_t i = 0; i < count; i++)
        put_shape(&columns, m, rows[i]);
    return TL_OK;
}

/* ---------------------------------------------------------------- places ----------------- */

typedef struct frame {
    const tl_model *model;
    unsigned char *id, *place, *turn, *velocity, *displacement, *rotation, *spin, *unbalanced,
        *flags;
    double *largest; /* square of the largest displacement, by chunk */
} frame;

enum { HELD = 1, HIDDEN = 2 };

static void put_block(const frame *f, size_t i)
{
    const tl_model *m = f->model;
    const tl_bodies *bodies = &m->bodies;
    uint32_t row = (uint32_t)i, body = m->blocks.body[row];
    tl_quat q = bodies->q[body];
    tl_put_u32(f->id + 4 * i, m->blocks.id[row]);
    tl_put_vec3(f->place + 12 * i, tl_block_place(m, row));
    unsigned char *turn = f->turn + 16 * i;
    turn = tl_put_f32(turn, q.x);
    turn = tl_put_f32(turn, q.y);
    turn = tl_put_f32(turn, q.z);
    tl_put_f32(turn, q.w);
    tl_put_vec3(f->velocity + 12 * i, tl_block_velocity(m, row));
    tl_put_vec3(f->displacement + 12 * i, tl_block_displacement(m, row));
    tl_put_vec3(f->rotation + 12 * i, tl_q_vector(q));
    tl_put_vec3(f->spin + 12 * i, bodies->w[body]);
    tl_put_f32(f->unbalanced + 4 * i, tl_v3_norm(bodies->force[body]));
    tl_put_u8(f->flags + i, (bodies->fixed[body] == TL_FIX_ALL ? HELD : 0u) |
                                (m->blocks.hidden[row] ? HIDDEN : 0u));
}

static void put_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    const frame *f = user;
    double largest = 0;
    for (size_t i = begin; i < end; i++) {
        put_block(f, i);
        largest = fmax(largest, tl_v3_norm2(tl_block_displacement(f->model, (uint32_t)i)));
    }
    f->largest[chunk] = largest;
}

tl_status tl_scene_blocks(tl_model *m, tl_piece *out, double *largest)
{
    size_t n = m->blocks.table.rows, chunks = (n + CHUNK - 1) / CHUNK;
    frame f = {.model = m, .largest = malloc((chunks + 1) * sizeof *f.largest)};
    if (!f.largest)
        return tl_fail_memory(&m->error);
    unsigned char *to =
        tl_scene_chunk(out, "FRAM", 20 + 84 * n + tl_scene_column_bytes(n, 1), &m->error);
    if (!to) {
        free(f.largest);
        return m->error.status;
    }
    to = tl_put_f64(to, m->time);
    to = tl_put_f64(to, (double)m->cycles);
    to = tl_put_u32(to, (uint32_t)n);
    f.id = tl_scene_column(&to, n, 4);
    f.place = tl_scene_column(&to, n, 12);
    f.turn = tl_scene_column(&to, n, 16);
    f.velocity = tl_scene_column(&to, n, 12);
    f.displacement = tl_scene_column(&to, n, 12);
    f.rotation = tl_scene_column(&to, n, 12);
    f.spin = tl_scene_column(&to, n, 12);
    f.unbalanced = tl_scene_column(&to, n, 4);
    f.flags = tl_scene_column(&to, n, 1);
    tl_parallel_for(m->pool, n, CHUNK, put_range, &f);
    double square = 0;
    for (size_t i = 0; i < chunks; i++)
        square = fmax(square, f.largest[i]);
    *largest = sqrt(square);
    free(f.largest);
    return TL_OK;
}
