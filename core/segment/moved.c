/* moved.c - how the walls of a segment have moved along each other.
 *
 * As act.c measures it, one point at a time: formulas are there. */
#include "segment/moved.h"

/* A point of a side now, its last motion, and the turn of the side in that. */
typedef struct side_motion {
    tl_vec3 place, way, turn;
} side_motion;

static side_motion rigid_motion(const tl_model *m, uint32_t body, tl_vec3 at)
{
    const tl_pose *pose = &m->bodies.pose[body];
    const tl_vec3 arm = tl_m3_mul(&pose->r, at), turn = tl_v3_scale(m->dt, pose->w_moved);
    const tl_vec3 way = tl_v3_madd(tl_v3_cross(turn, arm), m->dt, pose->v_moved);
    return (side_motion){tl_v3_add(tl_body_place(&m->bodies, body), arm), way, turn};
}

static side_motion motion_of(const tl_model *m, const tl_segment_side *side, tl_vec3 at)
{
    if (tl_side_is_rigid(side))
        return rigid_motion(m, side->at[0], at);
    tl_vec3 x[3], d[3];
    for (int k = 0; k < 3; k++) {
        tl_gridpoint_now now;
        tl_gridpoint_put(&now, &m->zones->points, side->at[k], m->zones->moved_dt);
        x[k] = tl_v3(now.place[0], now.place[1], now.place[2]);
        d[k] = tl_v3(now.way[0], now.way[1], now.way[2]);
    }
    const tl_vec3 a = tl_v3_sub(x[1], x[0]), b = tl_v3_sub(x[2], x[0]), da = tl_v3_sub(d[1], d[0]);
    const tl_vec3 db = tl_v3_sub(d[2], d[0]), area = tl_v3_cross(a, b);
    const double per = 1 / tl_v3_norm(area);
    const tl_vec3 n = tl_v3_scale(per, area);
    const double spin = 0.5 * (tl_v3_dot(b, da) - tl_v3_dot(a, db));
    const tl_vec3 sum = tl_v3_madd(tl_v3_scale(spin, n), tl_v3_dot(n, db), a);
    return (side_motion){tl_v3_madd(tl_v3_madd(x[0], at.y, a), at.z, b),
                         tl_v3_madd(tl_v3_madd(d[0], at.y, da), at.z, db),
                         tl_v3_scale(per, tl_v3_madd(sum, -tl_v3_dot(n, da), b))};
}

tl_vec3 tl_segment_moved(const tl_model *m, const tl_segment *of, double share, tl_vec3 n, tl_vec3 at_a, tl_vec3 at_b)
{
    const side_motion a = motion_of(m, &of->a, at_a), b = motion_of(m, &of->b, at_b);
    const tl_vec3 turn = tl_v3_madd(tl_v3_scale(share, a.turn), 1 - share, b.turn);
    const tl_vec3 du = tl_v3_sub(tl_v3_sub(b.way, a.way), tl_v3_cross(turn, tl_v3_sub(b.place, a.place)));
    return tl_v3_madd(du, -tl_v3_dot(du, n), n);
}
