/* stage_commit.c - a staging set becomes the model's blocks: rows are written, blocks that were cut or
 * deleted go, and blocks that hang together become bodies. All memory is reserved before the model is
 * touched, but for that of the bodies of several blocks. */
#include "model/model.h"

#include <stdlib.h>
#include <string.h>

/* Moves a shape so that its centroid is the zero of its frame. Offsets follow from a vertex of the
 * face, which keeps the digits of a shape far from zero. */
static void centre_shape(tl_poly *shape, tl_vec3 centroid)
{
    for (uint32_t i = 0; i < shape->vertex_count; i++)
        shape->vertex[i] = tl_v3_sub(shape->vertex[i], centroid);
    for (uint32_t f = 0; f < shape->face_count; f++)
        shape->plane[f].offset =
            tl_v3_dot(shape->plane[f].normal, shape->vertex[shape->loop[shape->start[f]]]);
}

/* Fills the rows of a new block and of its body. A child moves on as its part of the source did. */
static void put(tl_model *m, const tl_stage_block *block, uint32_t row, uint32_t body)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    tl_mass mass = tl_poly_mass(block->shape);
    tl_vec3 c = mass.centroid;
    centre_shape(block->shape, c);
    blocks->id[row] = bodies->id[body] = m->next_id++;
    blocks->body[row] = body;
    blocks->shape[row] = block->shape;
    blocks->group[row] = block->group;
    blocks->density[row] = block->density;
    blocks->lineage[row] = block->lineage;
    blocks->hidden[row] = block->hidden || block->conceal;
    tl_block_measure(m, row, mass.volume);
    tl_body_measure_single(m, body, row, mass);
    if (block->source == TL_NO_ROW) {
        bodies->x_ref[body] = c;
        bodies->q[body] = tl_q_identity();
        bodies->r[body] = tl_m3_identity();
        bodies->fixed[body] = block->fixed;
        return;
    }
    uint32_t from = blocks->body[block->source];
    tl_vec3 arm = tl_m3_mul(&bodies->r[from], c);
    blocks->base[row] = blocks->base[block->source];
    bodies->x_ref[body] = tl_v3_add(bodies->x_ref[from], c);
    bodies->u[body] = tl_v3_add(bodies->u[from], tl_v3_sub(arm, c));
    bodies->q[body] = bodies->q[from];
    bodies->r[body] = bodies->r[from];
    bodies->v[body] = tl_v3_add(bodies->v[from], tl_v3_cross(bodies->w[from], arm));
    bodies->w[body] = bodies->w[from];
    bodies->v_moved[body] =
        tl_v3_add(bodies->v_moved[from], tl_v3_cross(bodies->w_moved[from], arm));
    bodies->w_moved[body] = bodies->w_moved[from];
    bodies->fixed[body] = bodies->fixed[from];
    bodies->drive[body] = bodies->drive[from];
    if (bodies->drive[body])
        m->drives[bodies->drive[body] - 1].bodies++;
}

static void summarize(tl_stage *stage, double volume_before)
{
    const tl_blocks *b = &stage->model->blocks;
    tl_generate_summary *s = &stage->summary;
    s->after = b->table.rows;
    s->smallest_volume = s->smallest_edge = s->smallest_face = s->after ? INFINITY : 0;
    double volume = 0;
    for (uint32_t row = 0; row < b->table.rows; row++) {
        const tl_poly *shape = b->shape[row];
        volume += b->volume[row];
        s->smallest_volume = fmin(s->smallest_volume, b->volume[row]);
        s->smallest_edge = fmin(s->smallest_edge, tl_poly_shortest_edge(shape));
        for (uint32_t f = 0; f < shape->face_count; f++)
            s->smallest_face = fmin(s->smallest_face, tl_poly_face_area(shape, f));
    }
    if (volume > 0)
        s->volume_error = fabs(volume - volume_before - stage->created_volume) / volume;
}

/* Adds what the stage did to the model's record. `first` is the id of the first block made; blocks of
 * the stage that were made got ids in their order. */
static void keep_record(tl_stage *stage, tl_id first)
{
    tl_model *m = stage->model;
    tl_cut_record *record = &m->record;
    record->cuts += stage->summary.cuts;
    record->refused += stage->summary.refused;
    record->coincident += stage->summary.coincident;
    record->created += stage->created_volume;
    if (!stage->refused_listed)
        return;
    size_t listed = record->listed + stage->refused_listed;
    tl_refused_cut *list = realloc(record->list, listed * sizeof *list);
    if (!list)
        return;
    record->list = list;
    tl_id *id = malloc((stage->count + 1) * sizeof *id);
    if (!id)
        return;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        id[i] = block->owned && !block->retagged ? first++ : m->blocks.id[block->source];
    }
    for (size_t i = 0; i < stage->refused_listed; i++) {
        list[record->listed] = stage->refused[i];
        list[record->listed++].block = id[stage->refused[i].block];
    }
    free(id);
}

/* What a commit needs before it changes anything. */
typedef struct commit_room {
    unsigned char *keep; /* [rows] */
    tl_id *ids;          /* [staged blocks] their ids in the model */
    uint32_t *first;     /* [staged bodies] */
    uint32_t *group;     /* [rows] */
} commit_room;

static void free_room(commit_room *room)
{
    free(room->keep);
    free(room->ids);
    free(room->first);
    free(room->group);
}

static bool make_room(tl_stage *stage, size_t old, size_t made, commit_room *room)
{
    *room = (commit_room){.keep = calloc(old + made + 1, 1),
                          .ids = malloc((stage->count + 1) * sizeof *room->ids)};
    if (stage->regroups) {
        room->first = malloc((stage->next_body + (size_t)1) * sizeof *room->first);
        room->group = malloc((old + made + 1) * sizeof *room->group);
    }
    return room->keep && room->ids && (!stage->regroups || (room->first && room->group)) &&
           old + made < TL_NO_ROW &&
           tl_rows_reserve(stage->model, old + made, stage->model->next_id + (tl_id)made);
}

/* Moves the staged blocks into the model's rows, each as a body of its own, and drops what they
 * replace. */
static void move_blocks(tl_stage *stage, size_t made, commit_room *room)
{
    tl_model *m = stage->model;
    tl_blocks *blocks = &m->blocks;
    uint32_t row = (uint32_t)blocks->table.rows, body = (uint32_t)m->bodies.table.rows;
    tl_table_resize(&blocks->table, row + made);
    tl_table_resize(&m->bodies.table, body + made);
    for (size_t i = 0; i < stage->count; i++) {
        tl_stage_block *block = &stage->blocks[i];
        if (block->owned && !block->retagged) {
            put(m, block, row++, body++);
            room->ids[i] = m->next_id - 1;
            continue;
        }
        room->keep[block->source] = 1;
        room->ids[i] = blocks->id[block->source];
        blocks->group[block->source] = block->group;
        if (block->retagged) {
            tl_poly_free(blocks->shape[block->source]);
            blocks->shape[block->source] = block->shape;
        }
    }
    tl_rows_keep(m, room->keep);
}

tl_status tl_stage_commit(tl_stage *stage)
{
    tl_model *m = stage->model;
    size_t old = m->blocks.table.rows, made = 0;
    for (size_t i = 0; i < stage->count; i++)
        made += stage->blocks[i].owned && !stage->blocks[i].retagged;
    commit_room room = {NULL, NULL, NULL, NULL};
    tl_status status = tl_stage_settle(stage);
    if (status == TL_OK && !make_room(stage, old, made, &room))
        status = tl_fail_memory(&m->error);
    if (status != TL_OK) {
        free_room(&room);
        tl_stage_drop(stage);
        return status;
    }
    /* From here on nothing can fail but the grouping of blocks into bodies, for want of memory. */
    keep_record(stage, m->next_id);
    double volume_before = 0;
    for (size_t row = 0; row < old; row++)
        volume_before += m->blocks.volume[row];
    memset(room.keep + old, 1, made);
    move_blocks(stage, made, &room);
    summarize(stage, volume_before);
    if (stage->regroups) {
        tl_stage_groups(stage, room.ids, room.first, room.group);
        status = tl_bodies_regroup(m, room.group);
    }
    free_room(&room);
    tl_stage_end(stage);
    return status;
}
