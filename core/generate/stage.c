/* stage.c - the staging set: where generators create and cut blocks. It becomes the model's blocks
 * as a whole when it is committed, or is dropped without a trace.
 *
 * A cut replaces a block by two children. The one below the plane takes its place in the list, the one above goes to
 * the end. Both get new ids when committed. Children inherit group, density, velocity, fixity and displacement. */
#include "generate/stage.h"

#include "base/random.h"
#include "base/table.h"
#include "generate/fracture.h"
#include "generate/stage_bodies.h"
#include "geometry/convex_parts.h"
#include "geometry/cut.h"
#include "geometry/flatten.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "model/joints.h"
#include "model/model.h"
#include "model/rows.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Tolerance: A cut takes vertices this near, relative to the size, for being on its plane (TL_POLY_ON). And centres of
 * balls are known to some roundings of the coordinates. */
#define BALL_MARGIN (2 * TL_POLY_ON)
#define BALL_ROUNDINGS (32 * DBL_EPSILON)

/* A ball about a shape, by the mean of its vertices and the farthest from it. It holds what a cut takes for
 * touching and what rounds in between. */
static tl_stage_ball ball_of(const tl_model *m, const tl_stage_block *block)
{
    const tl_poly *p = block->shape;
    tl_vec3 center = tl_points_mean(p->vertex, p->vertex_count);
    double r2 = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double d2 = tl_v3_norm2(tl_v3_sub(p->vertex[i], center));
        r2 = d2 > r2 ? d2 : r2;
    }
    tl_stage_ball ball = {center, sqrt(r2) * (1 + BALL_MARGIN)};
    uint32_t body = tl_stage_frame(m, block);
    if (body != TL_NO_ROW)
        ball.center = tl_body_point(&m->bodies, body, center);
    ball.radius += BALL_ROUNDINGS * (tl_v3_norm(center) + tl_v3_norm(ball.center));
    return ball;
}

/* Adds a block, of which it then owns what the block does; false when out of memory. */
static bool stage_push(tl_stage *stage, const tl_stage_block *block)
{
    size_t of_balls = stage->capacity, of_visible = stage->capacity, need = stage->count + 1;
    if (!tl_grow(&stage->balls, &of_balls, need, sizeof *stage->balls) ||
        !tl_grow(&stage->visible, &of_visible, need, sizeof *stage->visible) ||
        !tl_grow(&stage->blocks, &stage->capacity, need, sizeof *stage->blocks))
        return false;
    if (!block->hidden && !block->hidden_by_generator)
        stage->visible[stage->visible_count++] = stage->count;
    stage->balls[stage->count] = ball_of(stage->model, block);
    stage->blocks[stage->count++] = *block;
    return true;
}

/* Gives the blocks of each body the key of its draws. */
static void key_bodies(tl_stage *stage)
{
    const tl_bodies *b = &stage->model->bodies;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        const uint32_t *rows = &stage->model->members[b->member_start[body]];
        uint64_t least = stage->blocks[rows[0]].lineage;
        for (uint32_t k = 1; k < b->member_count[body]; k++)
            if (stage->blocks[rows[k]].lineage < least)
                least = stage->blocks[rows[k]].lineage;
        for (uint32_t k = 0; k < b->member_count[body]; k++)
            stage->blocks[rows[k]].draw = least;
    }
}

tl_status tl_stage_begin_empty(tl_model *m, tl_stage *stage)
{
    *stage = (tl_stage){.model = m,
                        .joint_count = m->joint_count,
                        .group_count = m->group_count,
                        .next_body = (uint32_t)m->bodies.table.rows,
                        .origin_set = m->origin_set};
    stage->summary.before = tl_block_count(m);
    stage->plane_count = malloc((m->joint_count + 1) * sizeof *stage->plane_count);
    if (!stage->plane_count)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < m->joint_count; i++)
        stage->plane_count[i] = m->joints[i].planes;
    return TL_OK;
}

static void empty_lists(tl_stage *stage)
{
    stage->blocks = NULL;
    stage->balls = NULL;
    stage->visible = NULL;
    stage->count = stage->capacity = stage->visible_count = 0;
}

static void free_lists(tl_stage *stage)
{
    free(stage->blocks);
    free(stage->balls);
    free(stage->visible);
    empty_lists(stage);
}

tl_status tl_stage_open(tl_stage *stage)
{
    tl_model *m = stage->model;
    const tl_blocks *b = &m->blocks;
    if (stage->opened)
        return TL_OK;
    tl_rows_tidy(m);
    tl_stage added = *stage;
    bool enough = true;
    empty_lists(stage);
    for (uint32_t row = 0; row < b->table.rows && enough; row++) {
        tl_stage_block block = {.shape = b->shape[row],
                                .source = row,
                                .group = b->group[row],
                                .density = b->density[row],
                                .lineage = b->lineage[row],
                                .draw = b->lineage[row],
                                .body = b->body[row],
                                .detached_from = TL_NO_ROW,
                                .multi_block = m->bodies.member_count[b->body[row]] > 1,
                                .hidden = b->hidden[row] != 0};
        enough = stage_push(stage, &block);
    }
    for (size_t i = 0; i < added.count && enough; i++)
        enough = stage_push(stage, &added.blocks[i]);
    if (!enough) {
        free_lists(stage);
        *stage = added;
        return tl_fail_memory(&m->error);
    }
    free_lists(&added);
    stage->opened = true;
    key_bodies(stage);
    return TL_OK;
}

/* Drops the shapes, and the joints, planes and groups made since the staging set was begun. */
static void drop(tl_stage *stage)
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
    if (!stage->origin_set) {
        m->origin_set = false;
        m->origin = tl_v3(0, 0, 0);
    }
}

void tl_stage_end(tl_stage *stage)
{
    if (!stage->committed)
        drop(stage);
    free_lists(stage);
    free(stage->plane_count);
    free(stage->refused);
    stage->plane_count = NULL;
    stage->refused = NULL;
}

/* ---------------------------------------------------------------- cutting ---------------- */

/* A plane as it meets one staged block. */
typedef struct plane_in_block {
    tl_plane plane; /* in the block's frame */
    double reach;   /* the largest coordinate that it was computed with */
} plane_in_block;

/* `point` is relative to the model's origin. */
static plane_in_block plane_in_block_of(const tl_model *m, const tl_stage_block *block, tl_vec3 normal, tl_vec3 point)
{
    plane_in_block x = {{normal, tl_v3_dot(normal, point)}, tl_v3_norm(point)};
    uint32_t body = tl_stage_frame(m, block);
    if (body == TL_NO_ROW)
        return x;
    const tl_pose *pose = &m->bodies.pose[body];
    tl_vec3 relative = tl_v3_sub(tl_v3_sub(point, pose->x_ref), pose->u);
    x.plane = (tl_plane){tl_m3_tmul(&pose->r, normal), tl_v3_dot(normal, relative)};
    x.reach = fmax(x.reach, tl_v3_norm(tl_body_place(&m->bodies, body)));
    return x;
}

/* Cuts a staged block by a plane through `point`, relative to the origin: one of those that bound a space. Planes of a
 * space meet in its edges, as well as the coordinates of points on them are known in the axes of the model. So a corner
 * of the block that is nearer to the plane lies on it. */
static tl_status cut_by(tl_model *m, const tl_stage_block *block, tl_vec3 normal, tl_vec3 point, tl_cut *cut)
{
    plane_in_block x = plane_in_block_of(m, block, normal, point);
    x.reach = fmax(x.reach, tl_v3_norm(tl_v3_add(point, m->origin)));
    return tl_poly_cut(block->shape, x.plane, x.reach, (tl_tag){0, 0}, cut, &m->error);
}

/* Gives a face a new tag; a shape of the model is copied first. */
static tl_status retag(tl_stage *stage, tl_stage_block *block, uint32_t face, tl_tag tag)
{
    if (!block->owned) {
        tl_poly *copy = tl_poly_copy(block->shape);
        if (!copy)
            return tl_fail_memory(&stage->model->error);
        block->shape = copy;
        block->owned = block->retagged = true;
    }
    block->shape->tag[face] = tag;
    /* a joint on a face over which the body may hang together */
    block->needs_reconnect = block->multi_block;
    stage->needs_reconnect = stage->needs_reconnect || block->multi_block;
    stage->regroups = stage->regroups || block->multi_block;
    return TL_OK;
}

/* Puts the two sides of a cut in the place of block `index`. The sides of a single block are bodies of their own when
 * a joint runs between them. What becomes of a body of several is found out later. */
static tl_status replace(tl_stage *stage, size_t index, const tl_cut *cut, uint64_t key, bool joint)
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
    if (joint && !below.multi_block) {
        above.body = stage->next_body++;
        below.draw = below.lineage;
        above.draw = above.lineage;
    } else {
        below.multi_block = above.multi_block = below.needs_reconnect = above.needs_reconnect = true;
        stage->needs_reconnect = stage->regroups = true;
    }
    stage->blocks[index] = below;
    stage->balls[index] = ball_of(stage->model, &below);
    if (!stage_push(stage, &above)) {
        tl_poly_free(above.shape);
        return tl_fail_memory(&stage->model->error);
    }
    stage->summary.cuts++;
    return TL_OK;
}

/* False when the ball about a block shows that a fracture passes it by. */
static bool may_meet(const tl_model *m, const tl_fracture *f, tl_stage_ball ball)
{
    const tl_vec3 point = tl_v3_sub(f->point, m->origin);
    const double offset = tl_v3_dot(f->normal, point), rounding = BALL_ROUNDINGS * fabs(offset);
    if (fabs(tl_v3_dot(f->normal, ball.center) - offset) > ball.radius + rounding)
        return false;
    return isinf(f->radius) || tl_v3_norm(tl_v3_sub(ball.center, point)) <= f->radius + ball.radius + rounding;
}

/* Whether a block that the plane crosses is in the path of the fracture. The fracture reaches the section of the
 * block with the plane, or the face that the plane falls on. */
static bool in_path(const tl_model *m, const tl_fracture *fracture, const tl_stage_block *block, const tl_cut *cut)
{
    const uint32_t body = tl_stage_frame(m, block);
    if (cut->result == TL_CUT_MISS)
        return false;
    if (cut->result == TL_CUT_MADE) /* the cap is the last face */
        return tl_fracture_reaches(m, fracture, body, cut->below, cut->below->face_count - 1);
    /* a sliver without a face along the plane has no section to speak of: its ball decided */
    return cut->face == UINT32_MAX || tl_fracture_reaches(m, fracture, body, block->shape, cut->face);
}

/* Notes a cut that was refused, for the model's report; only so many are listed. */
static void note_refused(tl_stage *stage, size_t index, const tl_cut *cut, tl_tag joint, tl_vec3 normal, tl_vec3 point)
{
    stage->summary.refused++;
    size_t n = stage->refused_listed;
    if (stage->model->record.listed + n >= TL_REFUSED_LISTED)
        return;
    if (!stage->refused)
        stage->refused = malloc(TL_REFUSED_LISTED * sizeof *stage->refused);
    if (!stage->refused)
        return; /* without memory for the list, counting must do */
    stage->refused[n] = (tl_refused_cut){.joint = joint,
                                         .normal = normal,
                                         .point = point,
                                         .block = (tl_id)index,
                                         .thickness = cut->thickness,
                                         .limit = cut->limit};
    stage->refused_listed++;
}

tl_status tl_stage_cut_fracture(tl_stage *stage, const tl_fracture *fracture, tl_tag tag, double persistence,
                                size_t *met)
{
    tl_model *m = stage->model;
    tl_status settled = tl_stage_open(stage);
    if (settled == TL_OK)
        settled = tl_stage_settle(stage);
    if (settled != TL_OK)
        return settled;
    tl_vec3 local = tl_v3_sub(fracture->point, m->origin);
    uint64_t key = tl_key(tl_key_text(tl_key(0, (uint64_t)m->config.seed), m->joints[tag.joint - 1].name), tag.plane);
    bool coincident = false;
    size_t count = stage->count; /* children of this cut are not cut by it again */
    for (size_t i = 0; i < count; i++) {
        if (!may_meet(m, fracture, stage->balls[i]))
            continue;
        tl_stage_block *block = &stage->blocks[i];
        if (block->hidden || block->hidden_by_generator)
            continue;
        plane_in_block x = plane_in_block_of(m, block, fracture->normal, local);
        tl_cut cut;
        tl_status status = tl_poly_cut(block->shape, x.plane, x.reach, tag, &cut, &m->error);
        if (status != TL_OK)
            return status;
        bool path = in_path(m, fracture, block, &cut);
        *met += path;
        /* the draw belongs to a body that lies in the joint's path */
        if (!path || (persistence < 1 && tl_uniform(tl_key(key, block->draw)) >= persistence)) {
            tl_poly_free(cut.below);
            tl_poly_free(cut.above);
            continue;
        }
        if (cut.result == TL_CUT_MADE)
            status = replace(stage, i, &cut, key, true);
        else if (cut.face != UINT32_MAX)
            status = retag(stage, block, cut.face, tag);
        if (status != TL_OK)
            return status;
        coincident = coincident || cut.result == TL_CUT_COINCIDENT;
        if (cut.result == TL_CUT_REFUSED)
            note_refused(stage, i, &cut, tag, fracture->normal, fracture->point);
    }
    stage->summary.coincident += coincident;
    return TL_OK;
}

tl_status tl_stage_cut_block(tl_stage *stage, size_t index, tl_vec3 normal, tl_vec3 point, size_t *above)
{
    tl_model *m = stage->model;
    const tl_stage_block *block = &stage->blocks[index];
    tl_cut cut;
    *above = SIZE_MAX;
    tl_status status = cut_by(m, block, normal, tl_v3_sub(point, m->origin), &cut);
    if (status != TL_OK)
        return status;
    if (cut.result == TL_CUT_REFUSED)
        note_refused(stage, index, &cut, (tl_tag){0, 0}, normal, point);
    if (cut.result != TL_CUT_MADE)
        return TL_OK;
    status = replace(stage, index, &cut, tl_key_text(0, "no joint"), false);
    if (status == TL_OK)
        *above = stage->count - 1;
    return status;
}

tl_status tl_stage_meets(tl_stage *stage, size_t index, const tl_half_space *spaces, size_t count, bool *meets)
{
    tl_model *m = stage->model;
    tl_stage_block rest = stage->blocks[index];
    tl_status status = TL_OK;
    bool owned = false; /* the rest is no longer the block's own shape */
    *meets = true;
    for (size_t i = 0; i < count && *meets && status == TL_OK; i++) {
        tl_vec3 point = tl_v3_sub(spaces[i].point, m->origin);
        tl_stage_ball ball = stage->balls[index]; /* about the whole block */
        double distance = tl_v3_dot(spaces[i].normal, tl_v3_sub(ball.center, point));
        if (fabs(distance) > ball.radius + BALL_ROUNDINGS * tl_v3_norm(point)) {
            *meets = distance < 0;
            continue;
        }
        tl_cut cut;
        status = cut_by(m, &rest, spaces[i].normal, point, &cut);
        if (status == TL_OK && cut.result == TL_CUT_MADE) {
            tl_poly_free(cut.above);
            if (owned)
                tl_poly_free(rest.shape);
            rest.shape = cut.below;
            owned = true;
        } else if (status == TL_OK) {
            /* all but a sliver lies on one side */
            tl_plane plane = plane_in_block_of(m, &rest, spaces[i].normal, point).plane;
            tl_vec3 c = tl_poly_mass(rest.shape).centroid;
            *meets = tl_v3_dot(plane.normal, c) < plane.offset;
        }
    }
    if (owned)
        tl_poly_free(rest.shape);
    return status;
}

/* ---------------------------------------------------------------- new blocks -------------- */

/* Tolerance: the origin is rounded to a power of two of at least this many sizes of the first block. So models near
 * zero keep the origin zero, and subtracting it from coordinates is exact. */
#define ORIGIN_SIZES 8.0

/* Fixes the model's origin from the extent of the first block made. */
static void set_origin(tl_model *m, tl_vec3 min, tl_vec3 max)
{
    if (m->origin_set)
        return;
    m->origin_set = true;
    double size = tl_v3_norm(tl_v3_sub(max, min));
    if (!(size > 0) || !isfinite(size))
        return;
    int exponent; /* the least power of two that is no smaller */
    double share = frexp(ORIGIN_SIZES * size, &exponent);
    double unit = ldexp(1, share > 0.5 ? exponent : exponent - 1);
    tl_vec3 center = tl_v3_scale(0.5, tl_v3_add(min, max));
    m->origin = tl_v3(unit * round(center.x / unit), unit * round(center.y / unit), unit * round(center.z / unit));
}

static void set_origin_by(tl_model *m, const tl_vec3 *vertices, size_t count)
{
    const tl_bounds bounds = count ? tl_points_bounds(vertices, count) : (tl_bounds){tl_v3(0, 0, 0), tl_v3(0, 0, 0)};
    set_origin(m, bounds.min, bounds.max);
}

/* The key of a new block: of where its corners are, so that draws do not depend on what was made before. */
static uint64_t shape_key(const tl_model *m, const tl_poly *shape)
{
    uint64_t key = 0;
    for (uint32_t i = 0; i < shape->vertex_count; i++) {
        tl_vec3 x = tl_v3_add(shape->vertex[i], m->origin);
        const double place[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* no negative zeros */
        for (int k = 0; k < 3; k++) {
            uint64_t word;
            memcpy(&word, &place[k], sizeof word);
            key = tl_key(key, word);
        }
    }
    return key;
}

/* Adds a shape in coordinates relative to the origin; the stage owns it from then on. */
static tl_status add_shape(tl_stage *stage, tl_poly *shape, double density, const char *group)
{
    tl_model *m = stage->model;
    tl_status status = tl_check_measures(&m->error, shape, density);
    if (status != TL_OK) {
        tl_poly_free(shape);
        return status;
    }
    tl_stage_block block = {.shape = shape, .source = TL_NO_ROW, .density = density, .owned = true};
    block.group = tl_group_intern(m, group ? group : "");
    block.lineage = block.draw = shape_key(m, shape);
    block.body = stage->next_body++;
    block.detached_from = TL_NO_ROW;
    if (block.group == UINT32_MAX || !stage_push(stage, &block)) {
        tl_poly_free(shape);
        return tl_fail_memory(&m->error);
    }
    stage->created_volume += tl_poly_mass(shape).volume;
    return TL_OK;
}

tl_status tl_stage_add_hull(tl_stage *stage, const tl_vec3 *vertices, size_t count, double density, const char *group)
{
    tl_model *m = stage->model;
    tl_vec3 *local = malloc((count + 1) * sizeof *local);
    if (!local)
        return tl_fail_memory(&m->error);
    set_origin_by(m, vertices, count);
    for (size_t i = 0; i < count; i++)
        local[i] = tl_v3_sub(vertices[i], m->origin);
    tl_poly *shape;
    tl_status status = tl_poly_hull(local, count, TL_HULL_OF_CORNERS, &shape, &m->error);
    free(local);
    return status == TL_OK ? add_shape(stage, shape, density, group) : status;
}

tl_status tl_stage_add_box(tl_stage *stage, tl_vec3 min, tl_vec3 max, double density, const char *group)
{
    tl_model *m = stage->model;
    set_origin(m, min, max);
    tl_poly *shape;
    tl_status status = tl_poly_box(tl_v3_sub(min, m->origin), tl_v3_sub(max, m->origin), &shape, &m->error);
    return status == TL_OK ? add_shape(stage, shape, density, group) : status;
}

/* The plane of a face, from the sum of its fan of triangles and its first corner. */
static tl_plane face_plane(const tl_vec3 *vertex, const uint16_t *loop, size_t count)
{
    tl_vec3 normal = tl_v3_unit(tl_poly_fan_area(vertex, loop, count));
    return (tl_plane){normal, tl_v3_dot(normal, vertex[loop[0]])};
}

/* Copies of what tl_poly_make takes, one allocation each. */
typedef struct face_list {
    tl_vec3 *vertex;
    uint16_t *loop;
    tl_plane *plane;
} face_list;

static tl_status make_faces(tl_model *m, const tl_block_shape *given, const face_list *l, tl_poly **shape)
{
    for (size_t i = 0; i < given->vertex_count; i++)
        l->vertex[i] = tl_v3_sub(given->vertices[i], m->origin);
    for (size_t i = 0; i < given->start[given->face_count]; i++)
        l->loop[i] = (uint16_t)given->loops[i];
    for (size_t f = 0; f < given->face_count; f++)
        l->plane[f] = face_plane(l->vertex, l->loop + given->start[f], given->start[f + 1] - given->start[f]);
    tl_status status = tl_poly_make(l->vertex, given->vertex_count, l->plane, given->tags, given->start, l->loop,
                                    given->face_count, shape, &m->error);
    if (status != TL_OK)
        return status;
    status = tl_poly_flatten(shape, &m->error);
    if (status == TL_OK)
        status = tl_poly_check(*shape, TL_POLY_BENT, &m->error);
    if (status != TL_OK)
        tl_poly_free(*shape);
    return status;
}

tl_status tl_stage_add_faces(tl_stage *stage, const tl_block_shape *given)
{
    tl_model *m = stage->model;
    set_origin_by(m, given->vertices, given->vertex_count);
    face_list l = {malloc(given->vertex_count * sizeof *l.vertex),
                   malloc(given->start[given->face_count] * sizeof *l.loop),
                   malloc(given->face_count * sizeof *l.plane)};
    tl_poly *shape = NULL;
    tl_status status = l.vertex && l.loop && l.plane ? make_faces(m, given, &l, &shape) : tl_fail_memory(&m->error);
    free(l.vertex);
    free(l.loop);
    free(l.plane);
    if (status == TL_OK)
        status = add_shape(stage, shape, given->density, given->group);
    if (status != TL_OK)
        return status;
    stage->blocks[stage->count - 1].fixed = (uint8_t)given->fixed;
    stage->blocks[stage->count - 1].hide_on_commit = given->hidden != 0;
    return TL_OK;
}

/* ---------------------------------------------------------------- solids ----------------- */

/* Takes the blocks from the end that were added last. */
static void pop_blocks(tl_stage *stage, size_t count)
{
    while (stage->count > count) {
        const tl_stage_block *block = &stage->blocks[--stage->count];
        stage->created_volume -= tl_poly_mass(block->shape).volume;
        tl_poly_free(block->shape);
        stage->visible_count--;
    }
}

/* Adds the parts of a solid as blocks of one body. All or none; the shapes are the stage's from then on. */
static tl_status add_parts(tl_stage *stage, const tl_block_shape *given, tl_convex_parts *parts)
{
    tl_status status = tl_stage_open(stage);
    const size_t first = stage->count;
    for (size_t i = 0; i < parts->count && status == TL_OK; i++) {
        tl_poly *shape = parts->part[i];
        parts->part[i] = NULL;
        status = add_shape(stage, shape, given->density, given->group);
    }
    if (status != TL_OK) {
        pop_blocks(stage, first);
        return status;
    }
    const uint32_t body = stage->blocks[first].body;
    uint64_t least = UINT64_MAX;
    for (size_t i = first; i < stage->count; i++)
        least = stage->blocks[i].lineage < least ? stage->blocks[i].lineage : least;
    for (size_t i = first; i < stage->count; i++) {
        tl_stage_block *block = &stage->blocks[i];
        block->body = body;
        block->draw = least;
        block->multi_block = stage->count - first > 1;
        block->fixed = (uint8_t)given->fixed;
        block->hide_on_commit = given->hidden != 0;
    }
    stage->regroups = stage->regroups || stage->count - first > 1;
    return TL_OK;
}

static tl_status divide_solid(tl_stage *stage, const tl_block_shape *given, double flat, bool whole, size_t *count)
{
    tl_model *m = stage->model;
    tl_convex_parts parts;
    tl_vec3 *local = malloc(given->vertex_count * sizeof *local);
    if (!local)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < given->vertex_count; i++)
        local[i] = tl_v3_sub(given->vertices[i], m->origin);
    const tl_solid_surface surface = {.vertices = local,
                                      .vertex_count = given->vertex_count,
                                      .start = given->start,
                                      .loops = given->loops,
                                      .face_count = given->face_count,
                                      .tags = given->tags,
                                      .flat = flat,
                                      .whole = whole,
                                      .place = m->origin};
    tl_status status = tl_convex_parts_make(&surface, &parts, &m->error);
    free(local);
    if (status != TL_OK)
        return status;
    *count = parts.count;
    if (parts.reflex_edges == 0 && given->vertex_count <= TL_POLY_MAX_VERTICES &&
        given->face_count <= TL_POLY_MAX_FACES)
        status = tl_stage_add_faces(stage, given);
    else
        status = add_parts(stage, given, &parts);
    tl_convex_parts_free(&parts);
    return status;
}

tl_status tl_stage_add_solid(tl_stage *stage, const tl_block_shape *given, double flat, bool whole, size_t *parts)
{
    tl_model *m = stage->model;
    const bool had_origin = m->origin_set;
    const tl_vec3 origin = m->origin;
    *parts = 0;
    set_origin_by(m, given->vertices, given->vertex_count);
    const tl_status status = divide_solid(stage, given, flat, whole, parts);
    if (status == TL_OK)
        return status;
    *parts = 0;
    m->origin_set = had_origin;
    m->origin = origin;
    return status;
}
