/* plane_turn.h - vectors of a common plane that turns: from the normal of the last step to that of this one, and about
 * it. */
#ifndef TL_CONTACT_PLANE_TURN_H
#define TL_CONTACT_PLANE_TURN_H

#include "base/inline.h"

#include <talus/vmath.h>

/* The turn that swings the plane of normal `from` into that of `to`, then by twice the angle whose tangent
 * is `twist` about it: axis times the tangent of half its angle, no trigonometry. */
TL_INLINE tl_vec3 tl_turn_between(tl_vec3 from, tl_vec3 to, double twist)
{
    double c = 1 + tl_v3_dot(from, to);
    double swings = c > 0 ? 1 / (c > 0 ? c : 1) : 0;
    tl_vec3 swing = tl_v3_scale(swings, tl_v3_cross(from, to));
    /* swing is perpendicular to `to`: the product of the two half turns has no scalar part to divide by */
    return tl_v3_madd(tl_v3_madd(swing, twist, to), twist, tl_v3_cross(to, swing));
}

/* Turns a vector by g, of which `scale` is 2 / (1 + g^2), into the plane of normal n. What has not turned stays as it
 * is, to the bit; `turns` is 0 then, else 1. */
TL_INLINE tl_vec3 tl_turn_into(tl_vec3 v, tl_vec3 g, double scale, double turns, tl_vec3 n)
{
    tl_vec3 t = tl_v3_cross(g, v);
    t = tl_v3_madd(v, scale, tl_v3_add(t, tl_v3_cross(g, t)));
    return tl_v3_madd(t, -turns * tl_v3_dot(t, n), n);
}

/* Turns one vector of the old common plane of a point into its new one. */
TL_INLINE tl_vec3 tl_turn_one(tl_vec3 v, tl_vec3 from, tl_vec3 n, tl_vec3 half)
{
    tl_vec3 g = tl_turn_between(from, n, tl_v3_dot(half, n));
    double g2 = tl_v3_norm2(g);
    return tl_turn_into(v, g, 2 / (1 + g2), g2 > 0 ? 1 : 0, n);
}

#endif
