/* spot.c - where the sides of a contact were against each other. Odometers count the motion of both together, as of
 * blocks that ride side by side on others; against each other these may not have moved at all. */
#include "contact/spot.h"

#include <float.h>
#include <talus/vmath.h>

/* Tolerance: half the spacing of the floats at 1: no number is rounded by a larger share. */
#define ROUNDED (FLT_EPSILON / 2)

typedef struct tl_relative {
    tl_vec3 centroid;
    tl_quat turn;
} tl_relative;

static tl_relative relative(const tl_model *m, tl_sides sides)
{
    return (tl_relative){tl_m3_tmul(tl_side_rotation(m, sides.a), tl_sides_apart(m, sides)),
                         tl_q_mul(tl_q_conj(tl_side_quaternion(m, sides.a)), tl_side_quaternion(m, sides.b))};
}

tl_spot tl_spot_of(const tl_model *m, tl_sides sides, double remaining)
{
    tl_relative s = relative(m, sides);
    return (tl_spot){{(float)s.centroid.x, (float)s.centroid.y, (float)s.centroid.z},
                     {(float)s.turn.w, (float)s.turn.x, (float)s.turn.y, (float)s.turn.z},
                     (float)remaining};
}

/* The difference of two unit quaternions is 2 sin of a quarter of the angle between them. A quaternion and its negative
 * are the same rotation. */
double tl_spot_moved(const tl_model *m, const tl_spot *then, tl_sides sides, double radius)
{
    tl_relative now = relative(m, sides);
    tl_vec3 centroid = {then->centroid[0], then->centroid[1], then->centroid[2]};
    tl_quat p = {then->turn[0], then->turn[1], then->turn[2], then->turn[3]}, q = now.turn;
    double sign = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -1 : 1;
    double w = q.w - sign * p.w, x = q.x - sign * p.x, y = q.y - sign * p.y, z = q.z - sign * p.z;
    double angle = 2 * (sqrt(w * w + x * x + y * y + z * z) + ROUNDED);
    return tl_v3_norm(tl_v3_sub(now.centroid, centroid)) + ROUNDED * tl_v3_norm(centroid) + angle * radius;
}
