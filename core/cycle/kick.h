/* kick.h - how forces change velocities in a step: (23) of Hart, Cundall and Lemos (1988). */
#ifndef TL_CYCLE_KICK_H
#define TL_CYCLE_KICK_H

#include "base/inline.h"
#include <talus/vmath.h>

/* A velocity, or an angular momentum, after a kick of `span` s: v <- (D1 v + per F) D2, D1 = 1 - alpha span / 2,
 * D2 = 1 / (1 + alpha span / 2). `per`: the span over the inertia that the force F meets. */
TL_INLINE tl_vec3 tl_kick(tl_vec3 v, tl_vec3 force, double per, double alpha, double span)
{
    double d1 = 1 - 0.5 * alpha * span, d2 = 1 / (1 + 0.5 * alpha * span);
    return tl_v3_scale(d2, tl_v3_madd(tl_v3_scale(d1, v), per, force));
}

#endif
