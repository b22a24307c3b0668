/* side.c - the sides of segments in the present place, how they move, and what forces and couples do to them.
 *
 * A side carries the three points of a segment with it. Let x be the places of the corners of its triangle, and d how
 * they have moved in the last step. A point of weights w lies at sum w x and has moved by sum w d. With the in-plane
 * slopes g of the weights and the normal m of the triangle it turns by
 *
 *     turn = m (sum g x d) . m / 2 + sum (m . d) (g x m)
 *
 * A force on a point acts on the corners by the weights, and a couple by the transpose of the turn. */
#include "segment/side.h"

#include "base/columns.h"
#include "contact/contacts.h"

#include <talus/elementary.h>

/* What a point has moved beside the centroid as the body turned by w, as it acts on its arm now (force/follow.c). */
static tl_mat3 turned_back(tl_vec3 w)
{
    const double a = tl_v3_norm(w);
    const tl_vec3 h = tl_v3_scale(a > 0 ? tl_tan(0.5 * a) / a : 0.5, w), s = tl_v3_scale(2 / (1 + tl_v3_norm2(h)), h);
    return (tl_mat3){{{s.y * h.y + s.z * h.z, -s.x * h.y - s.z, -s.x * h.z + s.y},
                      {-s.y * h.x + s.z, s.z * h.z + s.x * h.x, -s.y * h.z - s.x},
                      {-s.z * h.x - s.y, -s.z * h.y + s.x, s.x * h.x + s.y * h.y}}};
}

tl_side_now tl_side_now_of(const tl_model *m, const tl_segment_side *side, tl_vec3 normal)
{
    tl_side_now out = {.rigid = tl_side_is_rigid(side), .body = side->at[0]};
    if (out.rigid) {
        const tl_pose *pose = &m->bodies.pose[out.body];
        out.shift = tl_v3_scale(m->dt, pose->v_moved);
        out.turn = tl_v3_scale(m->dt, pose->w_moved);
        out.back = turned_back(out.turn);
        out.normal = tl_m3_mul(&pose->r, normal);
        return out;
    }
    const tl_gridpoints *g = &m->zones->points;
    for (int k = 0; k < 3; k++) {
        out.x[k] = tl_gridpoint_place(g, side->at[k]);
        out.d[k] = tl_v3_scale(m->zones->moved_dt, tl_columns_get(g->moved, side->at[k]));
    }
    const tl_vec3 a = tl_v3_sub(out.x[1], out.x[0]), b = tl_v3_sub(out.x[2], out.x[0]), area = tl_v3_cross(a, b);
    const double size = tl_v3_norm(area);
    out.normal = tl_v3_scale(1 / size, area);
    out.slope[1] = tl_v3_scale(1 / size, tl_v3_cross(b, out.normal));
    out.slope[2] = tl_v3_scale(1 / size, tl_v3_cross(out.normal, a));
    out.slope[0] = tl_v3_neg(tl_v3_add(out.slope[1], out.slope[2]));
    double spin = 0;
    for (int k = 0; k < 3; k++) {
        const tl_vec3 d = tl_v3_sub(out.d[k], out.d[0]);
        spin += 0.5 * tl_v3_dot(out.normal, tl_v3_cross(out.slope[k], d));
        out.turn = tl_v3_madd(out.turn, tl_v3_dot(out.normal, d), tl_v3_cross(out.slope[k], out.normal));
    }
    out.turn = tl_v3_madd(out.turn, spin, out.normal);
    return out;
}

tl_vec3 tl_side_now_place(const tl_model *m, const tl_side_now *s, tl_vec3 at)
{
    if (s->rigid)
        return tl_body_point(&m->bodies, s->body, at);
    return tl_v3_madd(tl_v3_madd(tl_v3_scale(at.x, s->x[0]), at.y, s->x[1]), at.z, s->x[2]);
}

tl_vec3 tl_side_now_motion(const tl_model *m, const tl_side_now *s, tl_vec3 at, tl_vec3 off, tl_vec3 place)
{
    if (s->rigid)
        return tl_v3_add(s->shift, tl_m3_mul(&s->back, tl_v3_sub(place, tl_body_place(&m->bodies, s->body))));
    const tl_vec3 d = tl_v3_madd(tl_v3_madd(tl_v3_scale(at.x, s->d[0]), at.y, s->d[1]), at.z, s->d[2]);
    return tl_v3_add(d, tl_v3_cross(s->turn, off));
}

static void add(double *sum, tl_vec3 v)
{
    sum[0] += v.x;
    sum[1] += v.y;
    sum[2] += v.z;
}

void tl_side_turn(const tl_side_now *s, tl_vec3 couple, double sum[9])
{
    if (s->rigid) {
        add(sum + 3, couple);
        return;
    }
    const double spin = 0.5 * tl_v3_dot(couple, s->normal);
    for (int k = 0; k < 3; k++) {
        const tl_vec3 f = tl_v3_scale(spin, tl_v3_cross(s->normal, s->slope[k]));
        add(sum + 3 * k, tl_v3_madd(f, tl_v3_dot(couple, tl_v3_cross(s->slope[k], s->normal)), s->normal));
    }
}

void tl_side_push(const tl_model *m, const tl_segment_side *side, tl_vec3 at, tl_vec3 force, double sum[9])
{
    if (tl_side_is_rigid(side)) {
        add(sum, force);
        add(sum + 3, tl_v3_cross(tl_m3_mul(&m->bodies.pose[side->at[0]].r, at), force));
        return;
    }
    add(sum, tl_v3_scale(at.x, force));
    add(sum + 3, tl_v3_scale(at.y, force));
    add(sum + 6, tl_v3_scale(at.z, force));
}
