/* spot.c - where the blocks of a pair were against each other. Odometers count the motion of both together, as of blocks that
 * ride side by side on others; against each other these may not have moved at all. */
#include "contact/spot.h"

#include "model/model.h"

#include <talus/vmath.h>

tl_spot tl_spot_of(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    const tl_bodies *bodies = &m->bodies;
    uint32_t a = m->blocks.body[block_a], b = m->blocks.body[block_b];
    return (tl_spot){tl_m3_tmul(&bodies->pose[a].r, tl_body_apart(bodies, a, b)),
                     tl_q_mul(tl_q_conj(bodies->q[a]), bodies->q[b])};
}

tl_rough_spot tl_spot_roughly(const tl_spot *s)
{
    return (tl_rough_spot){
        {(float)s->way.x, (float)s->way.y, (float)s->way.z},
        {(float)s->turn.w, (float)s->turn.x, (float)s->turn.y, (float)s->turn.z}};
}

tl_spot tl_spot_from(const tl_rough_spot *s)
{
    return (tl_spot){
        {(double)s->way[0], (double)s->way[1], (double)s->way[2]},
        {(double)s->turn[0], (double)s->turn[1], (double)s->turn[2], (double)s->turn[3]}};
}

/* The difference of two unit quaternions is 2 sin of a quarter of the angle between them; a quaternion and its negative are the same
 * rotation. */
double tl_spot_moved(const tl_spot *from, const tl_spot *to, double radius)
{
    const tl_quat p = from->turn, q = to->turn;
    double sign = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -1 : 1;
    double w = q.w - sign * p.w, x = q.x - sign * p.x, y = q.y - sign * p.y, z = q.z - sign * p.z;
    double angle = 2 * sqrt(w * w + x * x + y * y + z * z);
    return tl_v3_norm(tl_v3_sub(to->way, from->way)) + angle * radius;
}
