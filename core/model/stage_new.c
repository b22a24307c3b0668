/* stage_new.c - new blocks of a staging set: hulls, boxes, and blocks given by their faces. */
#include "model/model.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

/* The origin is rounded to a power of two of at least this many sizes of the first block, so models
 * near zero keep the origin zero, and subtracting it from coordinates is exact. */
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
    m->origin = tl_v3(unit * round(center.x / unit), unit * round(center.y / unit),
                      unit * round(center.z / unit));
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
    if (block.group == UINT32_MAX || !tl_stage_push(stage, &block)) {
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

/* The plane of a face, from the sum of its fan of triangles and its first corner. */
static tl_plane face_plane(const tl_vec3 *vertex, const uint16_t *loop, size_t count)
{
    tl_vec3 zero = vertex[loop[0]], area = {0, 0, 0};
    for (size_t i = 1; i + 1 < count; i++)
        area = tl_v3_add(area, tl_v3_cross(tl_v3_sub(vertex[loop[i]], zero),
                                           tl_v3_sub(vertex[loop[i + 1]], zero)));
    tl_vec3 normal = tl_v3_unit(area);
    return (tl_plane){normal, tl_v3_dot(normal, zero)};
}

/* Copies of what tl_poly_make takes, one allocation each. */
typedef struct face_list {
    tl_vec3 *vertex;
    uint16_t *loop;
    tl_plane *plane;
} face_list;

static tl_status make_faces(tl_model *m, const tl_block_shape *given, const face_list *l,
                            tl_poly **shape)
{
    for (size_t i = 0; i < given->vertex_count; i++)
        l->vertex[i] = tl_v3_sub(given->vertices[i], m->origin);
    for (size_t i = 0; i < given->start[given->face_count]; i++)
        l->loop[i] = (uint16_t)given->loops[i];
    for (size_t f = 0; f < given->face_count; f++)
        l->plane[f] =
            face_plane(l->vertex, l->loop + given->start[f], given->start[f + 1] - given->start[f]);
    tl_status status = tl_poly_make(l->vertex, given->vertex_count, l->plane, given->tags,
                                    given->start, l->loop, given->face_count, shape, &m->error);
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
    tl_vec3 min = given->vertices[0], max = min;
    for (size_t i = 0; i < given->vertex_count; i++) {
        min = tl_v3_min(min, given->vertices[i]);
        max = tl_v3_max(max, given->vertices[i]);
    }
    set_origin(m, min, max);
    face_list l = {malloc(given->vertex_count * sizeof *l.vertex),
                   malloc(given->start[given->face_count] * sizeof *l.loop),
                   malloc(given->face_count * sizeof *l.plane)};
    tl_poly *shape = NULL;
    tl_status status = l.vertex && l.loop && l.plane ? make_faces(m, given, &l, &shape)
                                                     : tl_fail_memory(&m->error);
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
