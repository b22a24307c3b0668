/* stage.c - the staging set: where generators create and cut blocks. It becomes the model's blocks
 * as a whole when it is committed, or is dropped without a trace.
 *
 * A cut replaces a block by two children: the one below the plane takes its place in the list, the one
 * above goes to the end; both get new ids when committed. Children inherit group, density, velocity,
 * fixity and displacement. */
#include "model/model.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

/* The origin is rounded to a power of two of at least this many sizes of the first block, so models
 * near zero keep the origin zero, and subtracting it from coordinates is exact. */
#define ORIGIN_SIZES 8.0

static bool stage_push(tl_stage *stage, const tl_stage_block *block)
{
    if (stage->count == stage->capacity) {
        size_t capacity = stage->capacity ? 2 * stage->capacity : 64;
        tl_stage_block *blocks = realloc(stage->blocks, capacity * sizeof *blocks);
        if (!blocks)
            return false;
        stage->blocks = blocks;
        stage->capacity = capacity;
    }
    stage->blocks[stage->count++] = *block;
    return true;
}

/* A ball about a shape: the mean of its vertices and the farthest from it. */
static void set_ball(tl_stage_block *block)
{
    const tl_poly *p = block->shape;
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < p->vertex_count; i++)
        sum = tl_v3_add(sum, p->vertex[i]);
    block->center = tl_v3_scale(1.0 / p->vertex_count, sum);
    double r2 = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double d2 = tl_v3_norm2(tl_v3_sub(p->vertex[i], block->center));
        r2 = d2 > r2 ? d2 : r2;
    }
    block->radius = sqrt(r2);
}

tl_status tl_stage_begin(tl_model *m, tl_stage *stage)
{
    *stage = (tl_stage){.model = m,
                        .joint_count = m->joint_count,
                        .group_count = m->group_count,
                        .created = m->created,
                        .origin_set = m->origin_set};
    const tl_blocks *b = &m->blocks;
    stage->summary.before = b->table.rows;
    stage->plane_count = malloc((m->joint_count + 1) * sizeof *stage->plane_count);
    if (!stage->plane_count)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < m->joint_count; i++)
        stage->plane_count[i] = m->joints[i].planes;
    for (uint32_t row = 0; row < b->table.rows; row++) {
        tl_stage_block block = {.shape = b->shape[row],
                                .source = row,
                                .group = b->group[row],
                                .density = b->density[row],
                                .lineage = b->lineage[row],
                                .hidden = b->hidden[row] != 0};
        set_ball(&block);
        if (!stage_push(stage, &block)) {
            tl_stage_drop(stage);
            return tl_fail_memory(&m->error);
        }
    }
    return TL_OK;
}

static void stage_end(tl_stage *stage)
{
    free(stage->blocks);
    free(stage->plane_count);
    stage->blocks = NULL;
    stage->plane_count = NULL;
    stage->count = stage->capacity = 0;
}

void tl_stage_drop(tl_stage *stage)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++)
        if (stage->blocks[i].owned)
            tl_poly_free(stage->blocks[i].shape);
    while (m->joint_count > stage->joint_count)
        free(m->joints[--m->joint_count].name);
    for (size_t i = 0; i < m->joint_count; i++)
        m->joints[i].planes = stage->plane_count[i];
    while (m->group_count > stage->group_count)
        free(m->groups[--m->group_count]);
    m->created = stage->created;
    if (!stage->origin_set) {
        m->origin_set = false;
        m->origin = tl_v3(0, 0, 0);
    }
    stage_end(stage);
}

/* Fixes the model's origin from the extent of the first block made. */
static void set_origin(tl_model *m, tl_vec3 min, tl_vec3 max)
{
    if (m->origin_set)
        return;
    m->origin_set = true;
    double size = tl_v3_norm(tl_v3_sub(max, min));
    if (!(size > 0) || !isfinite(size))
        return;
    double unit = exp2(ceil(log2(ORIGIN_SIZES * size)));
    tl_vec3 center = tl_v3_scale(0.5, tl_v3_add(min, max));
    m->origin = tl_v3(unit * round(center.x / unit), unit * round(center.y / unit),
                      unit * round(center.z / unit));
}

/* Adds a shape in coordinates relative to the origin; the stage owns it from then on. */
static tl_status add_shape(tl_stage *stage, tl_poly *shape, double density, const char *group)
{
    tl_model *m = stage->model;
    tl_stage_block block = {.shape = shape, .source = TL_NO_ROW, .density = density, .owned = true};
    block.group = tl_group_intern(m, group ? group : "");
    block.lineage = tl_key(0, ++m->created);
    set_ball(&block);
    if (block.group == UINT32_MAX || !stage_push(stage, &block)) {
        tl_poly_free(shape);
        return tl_fail_memory(&m->error);
    }
    stage->created_volume += tl_poly_mass(shape).volume;
    return TL_OK;
}

tl_status tl_stage_add_hull(tl_stage *stage, const tl_vec3 *vertices, size_t count, double density,
                            const char *group)
{
    tl_model *m = stage->model;
    tl_vec3 *local = malloc((count + 1) * sizeof *local);
    if (!local)
        return tl_fail_memory(&m->error);
    tl_vec3 min = count ? vertices[0] : tl_v3(0, 0, 0), max = min;
    for (size_t i = 0; i < count; i++) {
        min = tl_v3_min(min, vertices[i]);
        max = tl_v3_max(max, vertices[i]);
    }
    set_origin(m, min, max);
    for (size_t i = 0; i < count; i++)
        local[i] = tl_v3_sub(vertices[i], m->origin);
    tl_poly *shape;
    tl_status status = tl_poly_hull(local, count, &shape, &m->error);
    free(local);
    return status == TL_OK ? add_shape(stage, shape, density, group) : status;
}

tl_status tl_stage_add_box(tl_stage *stage, tl_vec3 min, tl_vec3 max, double density,
                           const char *group)
{
    tl_model *m = stage->model;
    set_origin(m, min, max);
    tl_poly *shape;
    tl_status status =
        tl_poly_box(tl_v3_sub(min, m->origin), tl_v3_sub(max, m->origin), &shape, &m->error);
    return status == TL_OK ? add_shape(stage, shape, density, group) : status;
}

/* ---------------------------------------------------------------- cutting ---------------- */

/* The plane through `point` (relative to the origin) in the frame of a staged block. */
static tl_plane plane_in_frame(const tl_model *m, const tl_stage_block *block, tl_vec3 normal,
                               tl_vec3 point)
{
    if (block->source == TL_NO_ROW)
        return (tl_plane){normal, tl_v3_dot(normal, point)};
    uint32_t body = m->blocks.body[block->source];
    tl_vec3 relative = tl_v3_sub(tl_v3_sub(point, m->bodies.x_ref[body]), m->bodies.u[body]);
    return (tl_plane){tl_m3_tmul(&m->bodies.r[body], normal), tl_v3_dot(normal, relative)};
}

/* Gives a face a new tag; a shape of the model is copied first. */
static tl_status retag(tl_stage *stage, tl_stage_block *block, uint32_t face, tl_tag tag)
{
    if (!block->owned) {
        tl_poly *copy;
        tl_status status =
            tl_poly_transformed(block->shape, NULL, tl_v3(0, 0, 0), &copy, &stage->model->error);
        if (status != TL_OK)
            return status;
        block->shape = copy;
        block->owned = block->retagged = true;
    }
    block->shape->tag[face] = tag;
    return TL_OK;
}

/* Puts the two sides of a cut in the place of block `index`. */
static tl_status replace(tl_stage *stage, size_t index, const tl_cut *cut, uint64_t key)
{
    tl_stage_block below = stage->blocks[index], above = below;
    if (below.owned)
        tl_poly_free(below.shape);
    below.owned = above.owned = true;
    below.retagged = above.retagged = false;
    below.shape = cut->below;
    above.shape = cut->above;
    above.lineage = tl_key(tl_key(below.lineage, key), 1);
    below.lineage = tl_key(tl_key(below.lineage, key), 0);
    set_ball(&below);
    set_ball(&above);
    stage->blocks[index] = below;
    if (!stage_push(stage, &above)) {
        tl_poly_free(above.shape);
        return tl_fail_memory(&stage->model->error);
    }
    stage->summary.cuts++;
    return TL_OK;
}

/* A joint's plane, or disc, as it meets one staged block. */
typedef struct crossing {
    tl_plane plane; /* in the block's frame */
    tl_vec3 center; /* of the disc */
    double radius;  /* INFINITY: the whole plane */
} crossing;

static crossing crossing_in_frame(const tl_model *m, const tl_stage_block *block, tl_vec3 normal,
                                  tl_vec3 point, double radius)
{
    crossing x = {plane_in_frame(m, block, normal, point), point, radius};
    if (block->source != TL_NO_ROW && !isinf(radius)) {
        uint32_t body = m->blocks.body[block->source];
        tl_vec3 relative = tl_v3_sub(tl_v3_sub(point, m->bodies.x_ref[body]), m->bodies.u[body]);
        x.center = tl_m3_tmul(&m->bodies.r[body], relative);
    }
    return x;
}

/* False when the ball about a block shows that the plane or disc passes it by. */
static bool may_meet(const crossing *x, const tl_stage_block *block)
{
    double reach = block->radius * (1 + TL_POLY_ON);
    if (fabs(tl_v3_dot(x->plane.normal, block->center) - x->plane.offset) > reach)
        return false;
    return isinf(x->radius) || tl_v3_norm(tl_v3_sub(block->center, x->center)) <= x->radius + reach;
}

/* Whether a block that the plane crosses is in the path of the disc: the disc reaches the section of the
 * block with the plane, or the face that the plane falls on. */
static bool in_path(const crossing *x, const tl_stage_block *block, const tl_cut *cut)
{
    if (cut->result == TL_CUT_MISS)
        return false;
    if (isinf(x->radius))
        return true;
    if (cut->result == TL_CUT_MADE) /* the cap is the last face */
        return tl_poly_face_distance(cut->below, cut->below->face_count - 1, x->center) < x->radius;
    /* a sliver without a face along the plane has no section to speak of: its ball decided */
    return cut->face == UINT32_MAX ||
           tl_poly_face_distance(block->shape, cut->face, x->center) < x->radius;
}

tl_status tl_stage_cut_disc(tl_stage *stage, tl_vec3 normal, tl_vec3 point, double radius,
                            tl_tag tag, double persistence, size_t *met)
{
    tl_model *m = stage->model;
    tl_vec3 local = tl_v3_sub(point, m->origin);
    uint64_t key = tl_key(
        tl_key_text(tl_key(0, (uint64_t)m->config.seed), m->joints[tag.joint - 1].name), tag.plane);
    bool coincident = false;
    size_t count = stage->count; /* children of this cut are not cut by it again */
    for (size_t i = 0; i < count; i++) {
        tl_stage_block *block = &stage->blocks[i];
        if (block->hidden)
            continue;
        crossing x = crossing_in_frame(m, block, normal, local, radius);
        if (!may_meet(&x, block))
            continue;
        tl_cut cut;
        tl_status status = tl_poly_cut(block->shape, x.plane, tag, &cut, &m->error);
        if (status != TL_OK)
            return status;
        bool path = in_path(&x, block, &cut);
        *met += path;
        /* the draw belongs to a block that lies in the joint's path */
        if (!path || (persistence < 1 && tl_uniform(tl_key(key, block->lineage)) >= persistence)) {
            tl_poly_free(cut.below);
            tl_poly_free(cut.above);
            continue;
        }
        if (cut.result == TL_CUT_MADE)
            status = replace(stage, i, &cut, key);
        else if (cut.face != UINT32_MAX)
            status = retag(stage, block, cut.face, tag);
        if (status != TL_OK)
            return status;
        coincident = coincident || cut.result == TL_CUT_COINCIDENT;
        stage->summary.refused += cut.result == TL_CUT_REFUSED;
    }
    stage->summary.coincident += coincident;
    return TL_OK;
}

tl_status tl_stage_cut(tl_stage *stage, tl_vec3 normal, tl_vec3 point, tl_tag tag,
                       double persistence)
{
    size_t met = 0;
    return tl_stage_cut_disc(stage, normal, point, (double)INFINITY, tag, persistence, &met);
}

/* ---------------------------------------------------------------- commit ----------------- */

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

/* Appends the row of a new block and of its body. A child moves on as its part of the source did. */
static void append(tl_model *m, const tl_stage_block *block)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    uint32_t row = (uint32_t)blocks->table.rows, body = (uint32_t)bodies->table.rows;
    tl_table_resize(&blocks->table, row + 1u);
    tl_table_resize(&bodies->table, body + 1u);
    tl_vec3 c = tl_poly_mass(block->shape).centroid;
    centre_shape(block->shape, c);
    blocks->id[row] = bodies->id[body] = m->next_id++;
    blocks->body[row] = body;
    blocks->shape[row] = block->shape;
    blocks->group[row] = block->group;
    blocks->density[row] = block->density;
    blocks->lineage[row] = block->lineage;
    blocks->hidden[row] = block->hidden;
    tl_block_measure(m, row);
    if (block->source == TL_NO_ROW) {
        bodies->x_ref[body] = c;
        bodies->q[body] = tl_q_identity();
        bodies->r[body] = tl_m3_identity();
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

tl_status tl_stage_commit(tl_stage *stage)
{
    tl_model *m = stage->model;
    tl_blocks *blocks = &m->blocks;
    size_t old = blocks->table.rows, made = 0;
    for (size_t i = 0; i < stage->count; i++)
        made += stage->blocks[i].owned && !stage->blocks[i].retagged;
    unsigned char *keep = calloc(old + made + 1, 1);
    if (!keep || old + made >= TL_NO_ROW ||
        !tl_rows_reserve(m, old + made, m->next_id + (tl_id)made)) {
        free(keep);
        tl_stage_drop(stage);
        return tl_fail_memory(&m->error);
    }
    /* From here on nothing can fail but the parting of joined bodies that were cut. */
    double volume_before = 0;
    for (size_t row = 0; row < old; row++)
        volume_before += blocks->volume[row];
    memset(keep + old, 1, made);
    for (size_t i = 0; i < stage->count; i++) {
        tl_stage_block *block = &stage->blocks[i];
        if (block->owned && !block->retagged) {
            append(m, block);
            continue;
        }
        keep[block->source] = 1;
        if (block->retagged) {
            tl_poly_free(blocks->shape[block->source]);
            blocks->shape[block->source] = block->shape;
        }
    }
    tl_rows_keep(m, keep);
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.mass[body] == 0)
            tl_body_measure(m, body);
    summarize(stage, volume_before);
    free(keep);
    stage_end(stage);
    return tl_bodies_mend(m);
}
