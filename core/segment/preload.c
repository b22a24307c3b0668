/* preload.c - initial stress of segments. */
#include "segment/preload.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "narrow/view.h"
#include "segment/side.h"

#include <math.h>

/* A place that goes with a side, the first corner of a triangle or the centroid of a rigid body. */
static tl_vec3 origin_of(const tl_model *m, const tl_segment_side *side)
{
    return tl_side_is_rigid(side) ? tl_body_place(&m->bodies, side->at[0])
                                  : tl_gridpoint_place(&m->zones->points, side->at[0]);
}

/* Where a point of a side lies from there. A step takes the same differences. So it finds the same distance of the
 * walls, far from the origin of the model as well. */
static tl_vec3 lies_at(const tl_model *m, const tl_segment_side *side, tl_vec3 at)
{
    if (tl_side_is_rigid(side))
        return tl_m3_mul(&m->bodies.pose[side->at[0]].r, at);
    const tl_vec3 first = origin_of(m, side);
    const tl_vec3 a = tl_v3_sub(tl_gridpoint_place(&m->zones->points, side->at[1]), first),
                  b = tl_v3_sub(tl_gridpoint_place(&m->zones->points, side->at[2]), first);
    return tl_v3_madd(tl_v3_scale(at.y, a), at.z, b);
}

/* The common normal of a segment, as a step finds it. */
static tl_vec3 normal_of(const tl_model *m, const tl_segment *of, double share)
{
    const tl_vec3 a = tl_side_now_of(m, &of->a, of->normal_a).normal,
                  b = tl_side_now_of(m, &of->b, of->normal_b).normal;
    const double rest = 1 - share;
    const tl_vec3 p = {share * a.x - rest * b.x, share * a.y - rest * b.y, share * a.z - rest * b.z};
    return tl_v3_scale(1 / tl_v3_norm(p), p);
}

/* Where the walls of a segment's points are: the place of its first side, and from there to the second. */
typedef struct walls {
    tl_vec3 a, between;
} walls;

static walls walls_of(const tl_model *m, const tl_segment *of)
{
    const tl_vec3 a = origin_of(m, &of->a);
    return (walls){a, tl_v3_sub(origin_of(m, &of->b), a)};
}

/* Where a point lies on the first side, and from there to the second. */
static walls walls_at(const tl_model *m, const tl_segment *of, const walls *from, size_t point)
{
    const tl_segment_points *p = &m->segments->points;
    const tl_vec3 on_a = lies_at(m, &of->a, tl_columns_get(p->at_a, point));
    const tl_vec3 on_b = lies_at(m, &of->b, tl_columns_get(p->at_b, point));
    return (walls){tl_v3_add(from->a, on_a), tl_v3_add(from->between, tl_v3_sub(on_b, on_a))};
}

bool tl_meet_is_together(const tl_model *m, const tl_meet *meet)
{
    const struct tl_segments *s = m->segments;
    const double size =
        fmin(m->blocks.size[tl_block_row_quiet(m, meet->a)], m->blocks.size[tl_block_row_quiet(m, meet->b)]);
    double area = 0, apart = 0;
    for (uint32_t row = meet->begin; row < meet->end; row++) {
        const tl_segment *of = &s->table.of[row];
        if (of->meet == TL_NO_ROW)
            continue;
        const tl_vec3 n = normal_of(m, of, meet->share);
        const walls from = walls_of(m, of);
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
            const size_t point = tl_segment_point_row(row, k);
            area += s->points.area[point];
            apart += s->points.area[point] * tl_v3_dot(walls_at(m, of, &from, point).between, n);
        }
    }
    return apart <= TL_CONTACT_TOLERANCE * size * area;
}

void tl_segment_preload(tl_model *m, uint32_t row, tl_sym3 (*stress)(const void *user, tl_vec3 place), const void *user)
{
    struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    tl_segment_points *p = &s->points;
    const double share = s->meet[of->meet].share;
    const tl_vec3 n = normal_of(m, of, share);
    const walls from = walls_of(m, of);
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t point = tl_segment_point_row(row, k);
        const walls at = walls_at(m, of, &from, point);
        const tl_vec3 traction = tl_s3_mul(stress(user, tl_v3_madd(at.a, share, at.between)), n);
        const double normal = tl_v3_dot(n, traction);
        p->reference[point] = -tl_v3_dot(at.between, n);
        p->f_n0[point] = p->f_n[point] = -normal * p->area[point];
        tl_columns_put(p->f_s, point, tl_v3_scale(-p->area[point], tl_v3_madd(traction, -normal, n)));
        p->flags[point] = 0;
    }
    tl_columns_put(s->table.normal, row, n);
}
