/* press_slope.c - a press near a place where it was found: force and all else go on by their slopes there.
 *
 * Blocks at rest move by a small part of their overlap. There the energy is a quadratic of the motion. Its force goes
 * by the slopes -d2G, which are symmetric, so that what swings within neither gains nor loses. The mesh of a field
 * tells them where there is no patch (field_mesh.c). Otherwise they are central differences over the way that they are
 * used for. */
#include "narrow/press_slope.h"

#include "narrow/narrow.h"

#include <talus/vmath.h>

/* A motion of B: a turn about a point, as a vector, and the way of that point. */
typedef struct motion {
    tl_vec3 way, turn;
} motion;

static motion motion_between(tl_vec3 point, const tl_pair_pose *from, const tl_pair_pose *to)
{
    tl_mat3 q = tl_m3_product_t(&to->turn, &from->turn);
    tl_vec3 arm = tl_v3_sub(from->shift, point);
    return (motion){.way = tl_v3_sub(tl_v3_sub(to->shift, point), tl_m3_mul(&q, arm)),
                    .turn =
                        tl_v3_scale(0.5, tl_v3(q.m[2][1] - q.m[1][2], q.m[0][2] - q.m[2][0], q.m[1][0] - q.m[0][1]))};
}

double tl_press_lever(const tl_press *at)
{
    return fmax(2 * at->radius, at->deepest);
}

/* The motion over the overlap of the press: along, and by turns at the rim of its area. */
static double over_depth(const tl_press *at, const motion *by)
{
    return (tl_v3_norm(by->way) + tl_press_lever(at) * tl_v3_norm(by->turn)) / at->deepest;
}

bool tl_press_stays(const tl_press *at, const tl_pair_pose *from, const tl_pair_pose *to, double reach)
{
    const tl_vec3 then = tl_m3_tmul(&from->turn, tl_v3_sub(at->point, from->shift)); /* the point in B's frame */
    const tl_vec3 way = tl_v3_sub(tl_v3_add(tl_m3_mul(&to->turn, then), to->shift), at->point);
    if (!(tl_v3_norm(way) <= reach * at->deepest)) /* as mostly in motion */
        return false;
    const motion by = motion_between(at->point, from, to);
    return over_depth(at, &by) <= reach;
}

/* The view after B has moved along an axis, or turned about it. */
static tl_pair_view moved(const tl_pair_view *view, tl_vec3 point, int axis, double by)
{
    tl_pair_view out = *view;
    tl_vec3 way = {0, 0, 0};
    (&way.x)[axis % 3] = by;
    if (axis < 3) {
        out.shift = tl_v3_add(view->shift, way);
        return out;
    }
    double half = 0.5 * by;
    tl_vec3 v = tl_v3_scale(0.5, way);
    tl_mat3 turn = tl_q_matrix(tl_q_unit((tl_quat){1 - 0.5 * half * half, v.x, v.y, v.z}));
    out.shift = tl_v3_add(point, tl_m3_mul(&turn, tl_v3_sub(view->shift, point)));
    out.turn = tl_m3_product(&turn, &view->turn);
    return out;
}

static tl_vec3 difference(tl_vec3 to, tl_vec3 from, double per)
{
    return tl_v3_scale(per, tl_v3_sub(to, from));
}

bool tl_press_slope_find(const tl_press_query *query, const tl_press *at, tl_narrow_scratch *scratch,
                         tl_press_slope *slope)
{
    const tl_region *region = query->region;
    slope->known = true;
    for (int axis = 0; axis < 6; axis++) {
        double way = TL_PRESS_NEAR * at->deepest, by = axis < 3 ? way : way / tl_press_lever(at);
        double per = 1 / (2 * by);
        tl_field_mesh mesh[2], flat[2];
        tl_region same[2] = {*region, *region};
        tl_press side[2];
        tl_pair_view view[] = {moved(query->view, at->point, axis, -by), moved(query->view, at->point, axis, by)};
        tl_press_query there[] = {*query, *query};
        for (int k = 0; k < 2; k++) {
            mesh[k] = region->mesh ? *region->mesh : (tl_field_mesh){0};
            same[k].mesh = &mesh[k];
            flat[k] = region->flat ? *region->flat : (tl_field_mesh){0};
            same[k].flat = &flat[k];
            there[k].region = &same[k];
            there[k].view = &view[k];
            there[k].faces_only = false;
        }
        if (!tl_pairs_place(view, 2, scratch) || !tl_press_find(there, 2, scratch, side, NULL))
            return false;
        slope->known = slope->known && side[0].area > 0 && side[1].area > 0;
        slope->force[axis] = difference(side[1].force, side[0].force, per);
        slope->moment[axis] = difference(side[1].moment, side[0].moment, per);
        slope->point[axis] = difference(side[1].point, side[0].point, per);
        slope->area[axis] = per * (side[1].area - side[0].area);
        slope->radius[axis] = per * (side[1].radius - side[0].radius);
        slope->deepest[axis] = per * (side[1].deepest - side[0].deepest);
    }
    return true;
}

tl_press_slope tl_press_slope_of(const tl_press *at, const tl_field_slope *field)
{
    tl_press_slope out = {.known = field->known};
    for (int k = 0; k < 3; k++) {
        const tl_vec3 axis = {k == 0, k == 1, k == 2}, way = tl_v3_cross(at->point, axis);
        const double by[] = {way.x, way.y, way.z}; /* of a turn about the point, beside one about zero */
        out.point[k] = tl_v3_scale(0.5, axis);
        out.force[k] = field->force[k];
        out.moment[k] = field->moment[k];
        out.force[3 + k] = field->force[3 + k];
        out.moment[3 + k] = field->moment[3 + k];
        for (int j = 0; j < 3; j++) {
            out.force[3 + k] = tl_v3_madd(out.force[3 + k], by[j], field->force[j]);
            out.moment[3 + k] = tl_v3_madd(out.moment[3 + k], by[j], field->moment[j]);
        }
    }
    return out;
}

static bool is_same(const tl_pair_pose *a, const tl_pair_pose *b)
{
    bool same = a->shift.x == b->shift.x && a->shift.y == b->shift.y && a->shift.z == b->shift.z;
    for (int k = 0; k < 9; k++)
        same = same && a->turn.m[k / 3][k % 3] == b->turn.m[k / 3][k % 3];
    return same;
}

bool tl_press_near(const tl_press *at, const tl_press_slope *slope, const tl_pair_pose *from, const tl_pair_pose *to,
                   double reach, tl_press *out)
{
    if (is_same(from, to)) { /* to the last digit */
        *out = *at;
        return true;
    }
    const motion by = motion_between(at->point, from, to);
    const double x[] = {by.way.x, by.way.y, by.way.z, by.turn.x, by.turn.y, by.turn.z};
    if (!(over_depth(at, &by) <= reach))
        return false;
    *out = *at;
    for (int k = 0; k < 6; k++) {
        out->force = tl_v3_madd(out->force, x[k], slope->force[k]);
        out->moment = tl_v3_madd(out->moment, x[k], slope->moment[k]);
        out->point = tl_v3_madd(out->point, x[k], slope->point[k]);
        out->area += x[k] * slope->area[k];
        out->radius += x[k] * slope->radius[k];
        out->deepest += x[k] * slope->deepest[k];
    }
    /* minus the work of the mean force, and of its mean moment about the point */
    tl_vec3 force = tl_v3_scale(0.5, tl_v3_add(at->force, out->force));
    tl_vec3 moment = tl_v3_scale(0.5, tl_v3_add(at->moment, out->moment));
    moment = tl_v3_sub(moment, tl_v3_cross(at->point, force));
    out->energy -= tl_v3_dot(force, by.way) + tl_v3_dot(moment, by.turn);
    double size = tl_v3_norm(out->force);
    out->normal = tl_v3_scale(1 / size, out->force);
    out->overlap = 2 * size / out->area;
    return true;
}
