/* face_filter.c - which faces are meant by side, plane, box or direction.
 *
 * Of a rigid block a face counts as a whole. Of a deformable one each triangle of a face counts by itself, where it is
 * now. */
#include "edit/face_filter.h"

#include "base/error.h"
#include "zone/zones.h"

#include <math.h>
#include <string.h>
#include <talus/elementary.h>

/* Tolerance: off the plane, or out of the box, by less than this times the block's size a corner is in it. It is what
 * contacts take for touching (TL_CONTACT_TOLERANCE). */
#define TOLERANCE 1e-3
/* Tolerance: by this a cosine may be smaller than that of the angle given: at 45 degrees from {1, 0, 1} lies {1, 0,
 * 0}. Test: lua/test_boundary. */
#define ROUNDED 1e-12

#define DEGREE (3.14159265358979323846 / 180)

const char *const *tl_side_names(void)
{
    static const char *const names[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax", NULL};
    return names;
}

tl_side tl_side_named(const char *name)
{
    const char *const *names = tl_side_names();
    for (int i = 0; names[i]; i++)
        if (strcmp(names[i], name) == 0)
            return (tl_side)(TL_SIDE_XMIN + i);
    return TL_SIDE_ANY;
}

static tl_vec3 side_normal(int32_t side)
{
    static const tl_vec3 normals[] = {
        [TL_SIDE_XMIN] = {-1, 0, 0}, [TL_SIDE_XMAX] = {1, 0, 0},  [TL_SIDE_YMIN] = {0, -1, 0},
        [TL_SIDE_YMAX] = {0, 1, 0},  [TL_SIDE_ZMIN] = {0, 0, -1}, [TL_SIDE_ZMAX] = {0, 0, 1}};
    return normals[side];
}

/* Place of a vertex, relative to the model's origin. */
static tl_vec3 vertex_at(const tl_model *m, uint32_t row, uint32_t vertex)
{
    return tl_body_point(&m->bodies, m->blocks.body[row], m->blocks.shape[row]->vertex[vertex]);
}

/* The farthest place of a vertex, or of a gridpoint of a surface, along a direction, relative to the origin. */
static double farthest(const tl_model *m, tl_vec3 direction)
{
    double most = -INFINITY;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        for (uint32_t i = 0; !tl_block_deforms(m, row) && i < m->blocks.shape[row]->vertex_count; i++)
            most = fmax(most, tl_v3_dot(direction, vertex_at(m, row, i)));
    for (size_t k = 0; m->zones && k < m->zones->part_count; k++)
        for (int a = 0; a < 3; a++)
            most = fmax(most, tl_v3_dot(direction, tl_gridpoint_place(&m->zones->points, m->zones->part[k].corner[a])));
    return most;
}

tl_status tl_face_filter_begin(tl_model *m, const tl_boundary_where *where, tl_face_filter *s)
{
    *s = (tl_face_filter){.where = where};
    s->box = !isnan(where->box.min.x);
    s->facing = !isnan(where->facing.x);
    s->plane = where->side != TL_SIDE_ANY || !isnan(where->normal.x);
    if (where->side != TL_SIDE_ANY) {
        s->normal = side_normal(where->side);
        s->at = tl_v3_scale(farthest(m, s->normal), s->normal);
    } else if (s->plane) {
        if (!(tl_v3_norm(where->normal) > 0))
            return tl_fail(&m->error, TL_E_ARGUMENT, "boundary: the normal of the plane must not be zero");
        s->normal = tl_v3_unit(where->normal);
        s->at = tl_v3_sub(where->at, m->origin);
    }
    if (s->facing && !(tl_v3_norm(where->facing) > 0))
        return tl_fail(&m->error, TL_E_ARGUMENT, "boundary: facing must not be zero");
    if (s->facing) {
        s->direction = tl_v3_unit(where->facing);
        s->least_cosine = tl_cos(where->within * DEGREE) - ROUNDED;
    }
    if (s->box)
        s->bounds = (tl_bounds){tl_v3_sub(where->box.min, m->origin), tl_v3_sub(where->box.max, m->origin)};
    return TL_OK;
}

static bool in_box(const tl_bounds *box, tl_vec3 p, double slack)
{
    return p.x >= box->min.x - slack && p.x <= box->max.x + slack && p.y >= box->min.y - slack &&
           p.y <= box->max.y + slack && p.z >= box->min.z - slack && p.z <= box->max.z + slack;
}

/* Whether a face of this normal may be meant, and how far off a corner may be. */
static bool looks_so(const tl_face_filter *s, tl_vec3 n)
{
    return (!s->plane || tl_v3_dot(n, s->normal) > 0) && (!s->facing || tl_v3_dot(n, s->direction) >= s->least_cosine);
}

static double slack_of(const tl_model *m, const tl_face_filter *s, uint32_t row)
{
    return isnan(s->where->tolerance) ? TOLERANCE * m->blocks.size[row] : s->where->tolerance;
}

/* Whether a corner is where it may be. */
static bool corner_is_there(const tl_face_filter *s, tl_vec3 p, double slack)
{
    return (!s->plane || fabs(tl_v3_dot(s->normal, tl_v3_sub(p, s->at))) <= slack) &&
           (!s->box || in_box(&s->bounds, p, slack));
}

bool tl_face_is_there(const tl_model *m, const tl_face_filter *s, uint32_t row, uint32_t face)
{
    const tl_poly *shape = m->blocks.shape[row];
    const double slack = slack_of(m, s, row);
    bool there = looks_so(s, tl_m3_mul(&m->bodies.pose[m->blocks.body[row]].r, shape->plane[face].normal));
    for (uint32_t i = shape->start[face]; there && i < shape->start[face + 1]; i++)
        there = corner_is_there(s, vertex_at(m, row, shape->loop[i]), slack);
    return there;
}

bool tl_triangle_reaches_out(const tl_model *m, const tl_face_filter *s, uint32_t row, const tl_vec3 corner[3])
{
    const tl_vec3 middle = tl_v3_scale(1.0 / 3, tl_v3_add(corner[0], tl_v3_add(corner[1], corner[2])));
    tl_face_filter whole = *s;
    whole.box = false;
    return s->plane && s->box && in_box(&s->bounds, middle, 0) && tl_triangle_is_there(m, &whole, row, corner) &&
           !tl_triangle_is_there(m, s, row, corner);
}

bool tl_triangle_is_there(const tl_model *m, const tl_face_filter *s, uint32_t row, const tl_vec3 corner[3])
{
    const tl_vec3 area = tl_v3_cross(tl_v3_sub(corner[1], corner[0]), tl_v3_sub(corner[2], corner[0]));
    const double slack = slack_of(m, s, row);
    bool there = looks_so(s, tl_v3_unit(area));
    for (int a = 0; there && a < 3; a++)
        there = corner_is_there(s, corner[a], slack);
    return there;
}
