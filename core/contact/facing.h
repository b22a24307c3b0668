/* facing.h - facets in the present place of their blocks.
 *
 * The gap of a patch comes from the planes of its faces, carried with their bodies. The overlap of a field contact is the
 * same at both its points.
 *
 * What is here is for a step, which works on eight contacts at a time (follow.c), and for the others, one by one
 * (places.c): with the same operations in the same order, so that they agree to the bit. */
#ifndef TL_CONTACT_FACING_H
#define TL_CONTACT_FACING_H

#include "base/inline.h"
#include "narrow/facet.h"

#include <math.h>

/* A facet in its present place: its normal, and the overlap of a point at an arm, offset - plane . arm. */
typedef struct tl_facing {
    tl_vec3 n; /* A to B, unit */
    tl_vec3 plane;
    double offset;
} tl_facing;

/* Of a patch, from the normals of its faces in the present place. A point's gap is what it lies above B's face and
 * above A's: less exact than from one plane by nothing, for where the faces lie flush nA + nB is next to 0. */
TL_INLINE tl_facing tl_facing_patch(tl_vec3 na, tl_vec3 nb, tl_vec3 d, double offset)
{
    tl_vec3 mean = tl_v3_scale(0.5, tl_v3_sub(na, nb));
    return (tl_facing){.n = tl_v3_scale(1 / sqrt(tl_v3_norm2(mean)), mean),
                       .plane = tl_v3_add(na, nb),
                       .offset = offset + tl_v3_dot(nb, d)};
}

/* Of a field contact, from its normal. */
TL_INLINE tl_facing tl_facing_field(tl_vec3 n, double overlap)
{
    return (tl_facing){.n = n, .plane = tl_v3(0, 0, 0), .offset = overlap};
}

/* A unit vector perpendicular to one (Duff and others, "Building an orthonormal basis, revisited", 2017). */
TL_INLINE tl_vec3 tl_facing_aside(tl_vec3 n)
{
    double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z);
    return tl_v3(1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}

#endif
