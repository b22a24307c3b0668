/* side.c - normals of sides of segments, and what couples do to them, for those who ask for few (act.c has all).
 *
 * With the in-plane slopes g of the weights of its corners, how these have moved, d, and its normal m a triangle turns
 * by
 *
 *     turn = m (sum g x d) . m / 2 + sum (m . d) (g x m)
 *
 * A couple acts on the corners by the transpose of that. */
#include "segment/side.h"

#include "contact/contacts.h"

tl_side_now tl_side_now_of(const tl_model *m, const tl_segment_side *side, tl_vec3 normal)
{
    tl_side_now out = {.rigid = tl_side_is_rigid(side)};
    if (out.rigid) {
        out.normal = tl_m3_mul(&m->bodies.pose[side->at[0]].r, normal);
        return out;
    }
    const tl_gridpoints *g = &m->zones->points;
    const tl_vec3 x = tl_gridpoint_place(g, side->at[0]), a = tl_v3_sub(tl_gridpoint_place(g, side->at[1]), x);
    const tl_vec3 b = tl_v3_sub(tl_gridpoint_place(g, side->at[2]), x), area = tl_v3_cross(a, b);
    const double size = tl_v3_norm(area);
    out.normal = tl_v3_scale(1 / size, area);
    out.slope[1] = tl_v3_scale(1 / size, tl_v3_cross(b, out.normal));
    out.slope[2] = tl_v3_scale(1 / size, tl_v3_cross(out.normal, a));
    out.slope[0] = tl_v3_neg(tl_v3_add(out.slope[1], out.slope[2]));
    return out;
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
