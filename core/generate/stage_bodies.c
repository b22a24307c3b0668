/* stage_bodies.c - which staged blocks are one body.
 *
 * Every staged block bears the number of its body. A cut without a joint leaves both sides in the body. A joint may
 * divide a body of several blocks: it cuts it, or runs along a face between two of them. So may a block that is taken
 * out of it. The body falls into the parts that hang together over shared faces. Faces of joints made before this
 * staging set was begun still hold a body together, since its blocks were joined across them. */
#include "generate/stage_bodies.h"

#include "geometry/make.h"
#include "geometry/seam.h"
#include "model/model.h"

#include <stdlib.h>

/* A joined block, to be sorted by its body. */
typedef struct member {
    uint32_t body;
    size_t index;
} member;

static int compare_member(const void *x, const void *y)
{
    const member *a = x, *b = y;
    if (a->body != b->body)
        return a->body < b->body ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

/* Joints that were made, or got the plane, since the stage was begun. */
static bool is_new_joint(const void *user, tl_tag tag)
{
    const tl_stage *stage = user;
    return tag.joint > stage->joint_count || (tag.joint > 0 && tag.plane > stage->plane_count[tag.joint - 1]);
}

/* Replaces shapes by copies in the model's frame. */
static tl_status copy_shapes(tl_stage *stage, const member *members, size_t count, tl_poly **shapes)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < count; i++) {
        uint32_t body = tl_stage_frame(m, &stage->blocks[members[i].index]);
        const tl_mat3 *turn = body == TL_NO_ROW ? NULL : &m->bodies.pose[body].r;
        tl_vec3 shift = body == TL_NO_ROW ? tl_v3(0, 0, 0) : tl_body_place(&m->bodies, body);
        tl_status status = tl_poly_transformed(shapes[i], turn, shift, &shapes[i], &m->error);
        if (status != TL_OK) {
            while (i > 0)
                tl_poly_free(shapes[--i]);
            return status;
        }
    }
    return TL_OK;
}

/* Labels the parts of a body that hang together. Its blocks have one frame unless they were joined in
 * this staging set. */
static tl_status label_parts(tl_stage *stage, const member *members, size_t count, tl_poly **shapes, uint32_t *label)
{
    const uint32_t frame = tl_stage_frame(stage->model, &stage->blocks[members[0].index]);
    bool one_frame = true;
    for (size_t i = 0; i < count; i++) {
        const tl_stage_block *block = &stage->blocks[members[i].index];
        shapes[i] = block->shape;
        one_frame = one_frame && tl_stage_frame(stage->model, block) == frame;
    }
    tl_status status = one_frame ? TL_OK : copy_shapes(stage, members, count, shapes);
    if (status != TL_OK)
        return status;
    status = tl_poly_connected(shapes, count, is_new_joint, stage, label, &stage->model->error);
    for (size_t i = 0; i < count && !one_frame; i++)
        tl_poly_free(shapes[i]);
    return status;
}

/* Numbers the parts of one body by `label`; the first keeps the body's number. */
static void number_parts(tl_stage *stage, const member *members, size_t count, const uint32_t *label)
{
    for (size_t i = 0; i < count; i++) {
        tl_stage_block *block = &stage->blocks[members[i].index];
        block->multi_block = block->needs_reconnect = false;
        block->detached_from = TL_NO_ROW;
        block->draw = block->lineage;
        if (label[i] == i) {
            block->body = i == 0 ? block->body : stage->next_body++;
            continue;
        }
        tl_stage_block *first = &stage->blocks[members[label[i]].index];
        block->body = first->body;
        block->multi_block = first->multi_block = true;
        first->draw = block->draw < first->draw ? block->draw : first->draw;
    }
    for (size_t i = 0; i < count; i++)
        stage->blocks[members[i].index].draw = stage->blocks[members[label[i]].index].draw;
}

static tl_status settle_body(tl_stage *stage, const member *members, size_t count)
{
    tl_poly **shapes = malloc(count * sizeof *shapes);
    uint32_t *label = malloc(count * sizeof *label);
    tl_status status =
        shapes && label ? label_parts(stage, members, count, shapes, label) : tl_fail_memory(&stage->model->error);
    if (status == TL_OK)
        number_parts(stage, members, count, label);
    free(shapes);
    free(label);
    return status;
}

static int compare_body(const void *x, const void *y)
{
    uint32_t a = *(const uint32_t *)x, b = *(const uint32_t *)y;
    return (a > b) - (a < b);
}

/* Lists the bodies with a block that needs reconnecting, and those from which one was detached, ascending; returns how
 * many. */
static size_t list_marked(const tl_stage *stage, uint32_t *bodies)
{
    size_t count = 0, kept = 0;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (block->needs_reconnect)
            bodies[count++] = block->body;
        if (block->detached_from != TL_NO_ROW)
            bodies[count++] = block->detached_from;
    }
    qsort(bodies, count, sizeof *bodies, compare_body);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || bodies[i] != bodies[i - 1])
            bodies[kept++] = bodies[i];
    return kept;
}

/* The blocks of listed bodies, body by body; returns how many. */
static size_t list_members(const tl_stage *stage, const uint32_t *bodies, size_t body_count, member *members)
{
    size_t count = 0;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (block->multi_block && bsearch(&block->body, bodies, body_count, sizeof *bodies, compare_body))
            members[count++] = (member){block->body, i};
    }
    qsort(members, count, sizeof *members, compare_member);
    return count;
}

tl_status tl_stage_settle(tl_stage *stage)
{
    if (!stage->needs_reconnect)
        return TL_OK;
    member *members = malloc((stage->count + 1) * sizeof *members);
    uint32_t *bodies = malloc((2 * stage->count + 1) * sizeof *bodies);
    tl_status status = members && bodies ? TL_OK : tl_fail_memory(&stage->model->error);
    size_t count = 0;
    if (status == TL_OK)
        count = list_members(stage, bodies, list_marked(stage, bodies), members);
    for (size_t from = 0, to; from < count && status == TL_OK; from = to) {
        for (to = from; to < count && members[to].body == members[from].body;)
            to++;
        status = settle_body(stage, members + from, to - from);
    }
    free(members);
    free(bodies);
    stage->needs_reconnect = status != TL_OK;
    return status;
}
