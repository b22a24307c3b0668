/* facing.h - facets in the present place of their blocks.
 *
 * The gap comes from the planes of the faces (or the normal of two edges), carried with their bodies, never from
 * the axis. Of tilted faces each point has a normal of its own: see tl_lean.
 *
 * What is here is for a step, which works on eight contacts at a time (follow.c), and for the others, one by one
 * (places.c): with the same operations in the same order, so that they agree to the bit. */
#ifndef TL_CONTACT_FACING_H
#define TL_CONTACT_FACING_H

#include "base/inline.h"
#include "narrow/facet.h"

/* Sine of the angle of two edges up to which they have no common normal of their own. */
#define TL_PARALLEL 1e-12

/* A facet in its present place: its normals, and the plane a point's gap is measured to. */
typedef struct tl_facing {
    tl_vec3 n;    /* A to B, unit; of a patch the bisector's */
    tl_vec3 mean; /* n; of a tilted patch the mean of the faces' normals ... */
    tl_vec3 lean; /* ... and from it to the normal of A's face, and against it to B's; else 0 */
    double mean2; /* squares of their lengths, or 1 and 0 */
    double l2;
    tl_vec3
        plane; /* overlap of a point at an arm: offset - plane . arm. The outward normal of the face, or the */
    double offset; /* sum of those of both; 0 for edges, whose gap is the same everywhere */
} tl_facing;

/* 1 / sqrt(1 + e) without a root or a division: the first terms of its series, and those of what they leave. To rounding for
 * patches: of the normals of faces tilted by up to 15 degrees e is between -0.02 and 0.07. 1 for 0. */
TL_INLINE double tl_unit_scale(double e)
{
    double y = 1 - e * (0.5 - 0.375 * e);
    double left = 1 - (1 + e) * (y * y);
    return y + y * left * (0.5 + left * (0.375 + left * 0.3125));
}

/* Of a patch, from the normals of its faces in the present place. A point's gap is what it lies above B's face and
 * above A's: less exact than from one plane by nothing, for where the faces lie flush nA + nB is next to 0. */
TL_INLINE tl_facing tl_facing_patch(tl_vec3 na, tl_vec3 nb, tl_vec3 d, double offset)
{
    tl_facing out = {.plane = tl_v3_add(na, nb), .offset = offset + tl_v3_dot(nb, d)};
    tl_vec3 mean = tl_v3_scale(0.5, tl_v3_sub(na, nb)), lean = tl_v3_scale(0.5, tl_v3_add(na, nb));
    double mean2 = tl_v3_norm2(mean), l2 = tl_v3_norm2(lean);
    double tilted = l2 > TL_FLUSH * TL_FLUSH ? 1 : 0;
    out.n = tl_v3_scale(tl_unit_scale(mean2 - 1), mean);
    out.mean = tl_v3(tilted > 0 ? mean.x : out.n.x, tilted > 0 ? mean.y : out.n.y,
                     tilted > 0 ? mean.z : out.n.z);
    out.lean = tl_v3_scale(tilted, lean);
    out.mean2 = tilted > 0 ? mean2 : 1;
    out.l2 = tilted * l2;
    return out;
}

/* Of a facet whose points have one normal. */
TL_INLINE tl_facing tl_facing_level(tl_vec3 n, tl_vec3 plane, double offset)
{
    return (tl_facing){.n = n, .mean = n, .mean2 = 1, .plane = plane, .offset = offset};
}

/* Normal of two edges that cross, to the side of `side`; that itself where they have none of their own. */
TL_INLINE tl_vec3 tl_facing_edges(tl_vec3 a, tl_vec3 b, tl_vec3 side)
{
    tl_vec3 c = tl_v3_cross(a, b);
    double a2 = tl_v3_norm2(a), b2 = tl_v3_norm2(b), c2 = tl_v3_norm2(c);
    double crosses = c2 > TL_PARALLEL * TL_PARALLEL * a2 * b2 ? 1 : 0;
    double per_a = 1 / (crosses > 0 ? a2 : 1), per_b = 1 / (crosses > 0 ? b2 : 1);
    /* the cross product of nearly parallel edges has a component along them: take it out */
    c = tl_v3_madd(c, -per_a * tl_v3_dot(c, a), a);
    c = tl_v3_madd(c, -per_b * tl_v3_dot(c, b), b);
    c = tl_v3_madd(c, -per_a * tl_v3_dot(c, a), a);
    c = tl_v3_madd(c, -per_b * tl_v3_dot(c, b), b);
    c2 = tl_v3_norm2(c);
    double scale = (tl_v3_dot(c, side) < 0 ? -1 : 1) / sqrt(crosses > 0 ? c2 : 1);
    return tl_v3(crosses > 0 ? scale * c.x : side.x, crosses > 0 ? scale * c.y : side.y,
                 crosses > 0 ? scale * c.z : side.z);
}

/* The unit normal of a point that leans by `face` and `edge` (tl_lean), from the mean, the lean and the product of both; m2
 * and l2 are the squares of the first two. */
TL_INLINE tl_vec3 tl_leaning(tl_vec3 mean, tl_vec3 lean, tl_vec3 across, double m2, double l2,
                             double face, double edge)
{
    tl_vec3 n = tl_v3_madd(tl_v3_madd(mean, face, lean), edge, across);
    return tl_v3_scale(tl_unit_scale(m2 + l2 * (face * face + edge * edge * m2) - 1), n);
}

/* Whether a facet's points are kept in B's frame, not in A's. */
TL_INLINE bool tl_facet_in_b(const tl_facet *f)
{
    return f->kind == TL_FACET_FACE_A;
}

#endif
