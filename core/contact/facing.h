/* facing.h - facets in the present place of their blocks.
 *
 * The gap of a patch comes from the planes of its faces, carried with their bodies. The overlap of a field contact is
 * the same at both its points.
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
    tl_vec3 n;    /* A to B, unit */
    tl_vec3 push; /* force on B of a normal force of 1 */
    tl_vec3 plane;
    double offset;
} tl_facing;

/* Of a patch, from the normals of its faces in the present place. A point's gap is what it lies above B's face and
 * above A's: less exact than from one plane by nothing, for where the faces lie flush nA + nB is next to 0. The overlap
 * of a point that goes along with the share `ride` of B's motion u against A changes by -push . u: the force is the
 * gradient of the energy of that overlap. */
TL_INLINE tl_facing tl_facing_patch(tl_vec3 na, tl_vec3 nb, tl_vec3 d, double offset, double ride)
{
    tl_vec3 mean = tl_v3_sub(tl_v3_scale(ride, na), tl_v3_scale(1 - ride, nb));
    return (tl_facing){.n = tl_v3_scale(1 / sqrt(tl_v3_norm2(mean)), mean),
                       .push = mean,
                       .plane = tl_v3_add(na, nb),
                       .offset = offset + tl_v3_dot(nb, d)};
}

/* Where a point of A's frame is, seen from A's centroid in the model's axes: to p + at. */
typedef struct tl_facing_place {
    tl_mat3 to;
    tl_vec3 at;
} tl_facing_place;

/* Of the points of a patch: between where A and where B have carried them, nearer to B by the share `ride`. They were
 * laid when B was at `turn` and `shift` in A's frame. `d` is the way from A's centroid to B's. */
TL_INLINE tl_facing_place tl_facing_ride(const tl_mat3 *ra, const tl_mat3 *rb, tl_vec3 d, const tl_mat3 *turn,
                                         tl_vec3 shift, double ride)
{
    tl_mat3 g = tl_m3_product_t(rb, turn);
    tl_vec3 carried = tl_m3_mul(&g, shift);
    tl_facing_place out;
    out.to = (tl_mat3){{{ra->m[0][0] + ride * (g.m[0][0] - ra->m[0][0]), ra->m[0][1] + ride * (g.m[0][1] - ra->m[0][1]),
                         ra->m[0][2] + ride * (g.m[0][2] - ra->m[0][2])},
                        {ra->m[1][0] + ride * (g.m[1][0] - ra->m[1][0]), ra->m[1][1] + ride * (g.m[1][1] - ra->m[1][1]),
                         ra->m[1][2] + ride * (g.m[1][2] - ra->m[1][2])},
                        {ra->m[2][0] + ride * (g.m[2][0] - ra->m[2][0]), ra->m[2][1] + ride * (g.m[2][1] - ra->m[2][1]),
                         ra->m[2][2] + ride * (g.m[2][2] - ra->m[2][2])}}};
    out.at = tl_v3_scale(ride, tl_v3_sub(d, carried));
    return out;
}

/* Of a field contact, from its normal. */
TL_INLINE tl_facing tl_facing_field(tl_vec3 n, double overlap)
{
    return (tl_facing){.n = n, .push = n, .plane = tl_v3(0, 0, 0), .offset = overlap};
}

/* A unit vector perpendicular to one (Duff and others, "Building an orthonormal basis, revisited", 2017). */
TL_INLINE tl_vec3 tl_facing_aside(tl_vec3 n)
{
    double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z);
    return tl_v3(1 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x);
}

#endif
