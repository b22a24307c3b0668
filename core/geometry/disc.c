/* disc.c - how far a point of a face's plane lies from the face: the look a joint of finite extent takes at
 * a section of a block.
 *
 * A face is a convex polygon given counter-clockwise about its normal n. A point is over it when it lies
 * on the left of every edge, n x edge . (point - a) >= 0; otherwise the nearest point of the face is on one
 * of the edges. Distances are measured in the plane: the part along n is left out. */
#include "geometry/polyhedron.h"

#include <math.h>
#include <talus/vmath.h>

/* Square of the distance of a point from the edge a + t along, 0 <= t <= 1, with the part along n left
 * out. */
static double edge_distance2(tl_vec3 along, tl_vec3 arm, tl_vec3 n)
{
    tl_vec3 flat = tl_v3_madd(arm, -tl_v3_dot(arm, n), n);
    double length2 = tl_v3_norm2(along);
    double t = length2 > 0 ? tl_v3_dot(flat, along) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    return tl_v3_norm2(tl_v3_madd(flat, -t, along));
}

double tl_poly_face_distance(const tl_poly *p, uint32_t face, tl_vec3 point)
{
    const uint16_t *loop = p->loop + p->start[face];
    uint32_t count = tl_poly_face_size(p, face);
    tl_vec3 n = p->plane[face].normal;
    bool over = true;
    double nearest2 = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        tl_vec3 a = p->vertex[loop[i]], b = p->vertex[loop[(i + 1) % count]];
        tl_vec3 along = tl_v3_sub(b, a), arm = tl_v3_sub(point, a);
        over = over && tl_v3_dot(tl_v3_cross(n, along), arm) >= 0;
        nearest2 = fmin(nearest2, edge_distance2(along, arm, n));
    }
    return over ? 0 : sqrt(nearest2);
}
