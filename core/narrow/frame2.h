/* frame2.h - the plane of a patch: what patch.c and patch_batch.c share, which lay patches one by one and several at a
 * time. What is computed for each stands here once, so that both give the same bits. */
#ifndef TL_NARROW_FRAME2_H
#define TL_NARROW_FRAME2_H

#include "base/inline.h"
#include "geometry/polyhedron.h"
#include "narrow/corner.h"

#include <talus/vmath.h>

/* Tolerance: turning angles, rad, below which a corner is none, and from which it is a full one. Test:
 * lua/test_cut_corners. */
#define TL_STRAIGHT 0.02
#define TL_CORNER 0.2

/* The plane of the patch: origin, two directions in it, its normal (A to B). */
typedef struct tl_frame2 {
    tl_vec3 o, t1, t2, n;
    double secant;               /* of its tilt against either face */
    double rest, rest_x, rest_y; /* distance from A's face over it */
} tl_frame2;

/* The plane between faces of these normals, through a point of A's. Its directions: Duff et al. (2017), Building an
 * orthonormal basis, revisited. */
TL_INLINE tl_frame2 tl_frame2_of(tl_vec3 na, tl_vec3 nb, tl_vec3 through)
{
    tl_vec3 apart = tl_v3_sub(na, nb);
    double inverse = 1 / sqrt(tl_v3_norm2(apart));
    tl_vec3 n = tl_v3_scale(inverse, apart);
    double sign = n.z < 0 ? -1 : 1, s = -1 / (sign + n.z), xy = n.x * n.y * s;
    tl_frame2 f = {.o = through, .n = n, .secant = 2 * inverse};
    f.t1 = tl_v3(1 + sign * n.x * n.x * s, sign * xy, -sign * n.x);
    f.t2 = tl_v3(xy, sign + n.y * n.y * s, -n.y);
    return f;
}

/* Square of the sine between the faces. */
TL_INLINE double tl_tilt2(tl_vec3 na, tl_vec3 nb)
{
    double up2 = tl_v3_norm2(tl_v3_add(na, nb));
    return up2 * (1 - 0.25 * up2);
}

TL_INLINE tl_point2 tl_frame2_project(const tl_frame2 *f, tl_vec3 x)
{
    tl_vec3 d = tl_v3_sub(x, f->o);
    return (tl_point2){tl_v3_dot(d, f->t1), tl_v3_dot(d, f->t2)};
}

TL_INLINE tl_vec3 tl_frame2_point(const tl_frame2 *f, tl_point2 at)
{
    return tl_v3(f->o.x + at.x * f->t1.x + at.y * f->t2.x, f->o.y + at.x * f->t1.y + at.y * f->t2.y,
                 f->o.z + at.x * f->t1.z + at.y * f->t2.z);
}

/* Moves the plane into the middle between the two faces at the centroid, and notes how far A's face is from it. */
TL_INLINE void tl_frame2_move(tl_frame2 *f, tl_plane a, tl_plane b, tl_point2 centroid)
{
    tl_vec3 x = tl_v3_madd(tl_v3_madd(f->o, centroid.x, f->t1), centroid.y, f->t2);
    double up = tl_v3_dot(b.normal, x) - b.offset, down = tl_v3_dot(a.normal, x) - a.offset;
    double way = 0.5 * (up - down) * f->secant;
    f->o.x += way * f->n.x;
    f->o.y += way * f->n.y;
    f->o.z += way * f->n.z;
    f->rest = tl_v3_dot(a.normal, f->o) - a.offset;
    f->rest_x = tl_v3_dot(a.normal, f->t1);
    f->rest_y = tl_v3_dot(a.normal, f->t2);
}

/* The gap at a place of the patch's plane is at + x along t1 + y along t2. */
typedef struct tl_patch_gap {
    double at, x, y;
} tl_patch_gap;

TL_INLINE tl_patch_gap tl_patch_gap_of(const tl_frame2 *f, tl_plane b)
{
    return (tl_patch_gap){f->rest + tl_v3_dot(b.normal, f->o) - b.offset, f->rest_x + tl_v3_dot(b.normal, f->t1),
                          f->rest_y + tl_v3_dot(b.normal, f->t2)};
}

TL_INLINE double tl_gap_at(tl_patch_gap gap, tl_point2 at)
{
    return gap.at + at.x * gap.x + at.y * gap.y;
}

/* Where the points of a patch lie, and their areas. Of the fan triangle of an edge, the share of each end, of its
 * middle and of the centroid. Corners lie at `reach` of the way out from the centroid, middles at `out`. */
typedef struct tl_point_rule {
    double corner, middle, centroid, reach, out;
} tl_point_rule;

/* Points at the corners only, or the rule of patch.c. */
static inline tl_point_rule tl_point_rule_of(bool corners)
{
    return corners ? (tl_point_rule){.corner = 0.5, .reach = 1, .out = 1}
                   : (tl_point_rule){16. / 75, 12. / 25, 7. / 75, 5. / 8, 5. / 6};
}

/* A number at `reach` of the way out from the centroid, where it is `from`, to where it is `to`. */
TL_INLINE double tl_drawn_in(double reach, double from, double to)
{
    return (1 - reach) * from + reach * to;
}

/* B's plane in A's frame. */
TL_INLINE tl_plane tl_plane_placed(const tl_mat3 *turn, tl_vec3 shift, tl_plane plane)
{
    tl_vec3 n = tl_m3_mul(turn, plane.normal);
    return (tl_plane){n, plane.offset + tl_v3_dot(n, shift)};
}

#endif
