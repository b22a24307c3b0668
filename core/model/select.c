/* select.c - which blocks: the filters of a selection. Positions are the present ones and boundaries are included. */
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "model/deformable.h"
#include "model/joints.h"
#include "model/model.h"
#include "model/options.h"
#include "model/rows.h"

#include <stdlib.h>
#include <string.h>

/* Tolerance: a point this near a boundary, relative to the block's size, counts as on it. It is the rounding of a few
 * operations on coordinates of the model. */
#define BOUNDARY 1e-9

static bool has_joint(const tl_poly *shape, tl_tag pattern)
{
    for (uint32_t f = 0; f < shape->face_count; f++)
        if (shape->tag[f].joint != 0 && tl_tag_matches(pattern, shape->tag[f]))
            return true;
    return false;
}

static bool contains(const tl_model *m, uint32_t row, tl_vec3 point)
{
    const tl_poly *shape = m->blocks.shape[row];
    tl_vec3 local = tl_body_local(&m->bodies, m->blocks.body[row], tl_v3_sub(point, m->origin));
    return tl_poly_contains(shape, local, BOUNDARY * shape->size);
}

/* Signed height of a point over a half-space's plane. */
static double height(const tl_halfspace *plane, tl_vec3 point)
{
    return tl_v3_dot(tl_plane_normal(plane->dip, plane->dip_direction), tl_v3_sub(point, plane->origin));
}

static bool in_bounds(const tl_bounds *box, tl_vec3 p, double slack)
{
    return p.x >= box->min.x - slack && p.x <= box->max.x + slack && p.y >= box->min.y - slack &&
           p.y <= box->max.y + slack && p.z >= box->min.z - slack && p.z <= box->max.z + slack;
}

/* Whether a point is on one side of all planes: above them for `sign` 1, below them for -1. */
static bool beyond(const tl_halfspace *planes, size_t count, double sign, tl_vec3 point, double slack)
{
    for (size_t i = 0; planes && i < count; i++)
        if (sign * height(&planes[i], point) < -slack)
            return false;
    return true;
}

/* What a filter's joint and region mean in a model. */
typedef struct filter_of {
    const tl_block_filter *filter;
    tl_tag joint;
    tl_poly *region; /* in user coordinates less `from`; NULL: any */
    tl_vec3 from;
} filter_of;

static tl_status read_region(tl_model *m, const tl_block_filter *f, filter_of *of)
{
    if (!f->region)
        return TL_OK;
    if (f->region_count < 4)
        return tl_fail(&m->error, TL_E_ARGUMENT, "region has %zu points; a region in space needs at least 4",
                       f->region_count);
    of->from = f->region[0];
    tl_vec3 *points = malloc(f->region_count * sizeof *points);
    if (!points)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < f->region_count; i++)
        points[i] = tl_v3_sub(f->region[i], of->from);
    tl_status status = tl_poly_hull(points, f->region_count, TL_HULL_OF_ANY, &of->region, &m->error);
    free(points);
    if (status != TL_OK)
        tl_error_prefix(&m->error, "region: ");
    return status;
}

static bool passes(const tl_model *m, const filter_of *of, uint32_t row)
{
    const tl_block_filter *f = of->filter;
    const tl_blocks *b = &m->blocks;
    if (f->hidden >= 0 && (b->hidden[row] != 0) != (f->hidden != 0))
        return false;
    if (f->group && strcmp(m->groups[b->group[row]], f->group) != 0)
        return false;
    if (f->fixed >= 0 && tl_body_is_held(m, b->body[row]) != (f->fixed != 0))
        return false;
    if (f->joint && !has_joint(b->shape[row], of->joint))
        return false;
    if (f->inside || f->above || f->below || of->region) {
        tl_vec3 c = tl_block_centroid(m, row);
        double slack = BOUNDARY * b->shape[row]->size;
        if (f->inside && !in_bounds(f->inside, c, slack))
            return false;
        if (!beyond(f->above, f->above_count, 1, c, slack) || !beyond(f->below, f->below_count, -1, c, slack))
            return false;
        if (of->region && !tl_poly_contains(of->region, tl_v3_sub(c, of->from), slack))
            return false;
    }
    return !f->containing || contains(m, row, *f->containing);
}

tl_status tl_blocks_select(tl_model *m, const tl_block_filter *given, tl_id **ids, size_t *count)
{
    *ids = NULL;
    *count = 0;
    tl_block_filter filter;
    filter_of of = {.filter = &filter};
    tl_status status = TL_OPTIONS_READ(tl_block_filter, given, &filter, &m->error);
    if (status != TL_OK)
        return status;
    if (filter.joint) {
        status = tl_joint_parse(m, filter.joint, &of.joint);
        if (status != TL_OK)
            return status;
    }
    status = read_region(m, &filter, &of);
    if (status != TL_OK)
        return status;
    uint32_t begin = 0, end;
    if (filter.id != TL_NO_ID) { /* one block at most, and other rows may be untidy */
        begin = tl_block_row_quiet(m, filter.id);
        end = begin == TL_NO_ROW ? begin : begin + 1;
    } else {
        tl_rows_tidy(m);
        end = (uint32_t)m->blocks.table.rows;
    }
    tl_id *list = malloc((end - begin + 1u) * sizeof *list);
    size_t n = 0;
    for (uint32_t row = begin; list && row < end; row++)
        if (passes(m, &of, row))
            list[n++] = m->blocks.id[row];
    tl_poly_free(of.region);
    if (!list)
        return tl_fail_memory(&m->error);
    *ids = list;
    *count = n;
    return TL_OK;
}
