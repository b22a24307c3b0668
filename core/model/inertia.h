/* inertia.h - inertia about another point, and the turning that goes with a moment. */
#ifndef TL_MODEL_INERTIA_H
#define TL_MODEL_INERTIA_H

#include <talus/vmath.h>

/* inertia + mass (|d|^2 1 - d d): the tensor about a point at distance d, m, from the centroid */
static inline tl_sym3 tl_inertia_about(tl_sym3 inertia, double mass, tl_vec3 d)
{
    double dd = tl_v3_norm2(d);
    return (tl_sym3){inertia.xx + mass * (dd - d.x * d.x), inertia.yy + mass * (dd - d.y * d.y),
                     inertia.zz + mass * (dd - d.z * d.z), inertia.xy - mass * d.x * d.y,
                     inertia.yz - mass * d.y * d.z,        inertia.zx - mass * d.z * d.x};
}

/* The solution of a tensor with the columns x, y, z and the right side b, by Cramer's rule; not finite where it is
 * singular. */
static inline tl_vec3 tl_solve3(tl_vec3 x, tl_vec3 y, tl_vec3 z, tl_vec3 b)
{
    double det = tl_v3_dot(x, tl_v3_cross(y, z));
    return tl_v3(tl_v3_dot(b, tl_v3_cross(y, z)) / det, tl_v3_dot(x, tl_v3_cross(b, z)) / det,
                 tl_v3_dot(x, tl_v3_cross(y, b)) / det);
}

#endif
