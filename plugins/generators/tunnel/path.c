/* path.c - a profile that follows a path: where the corners of both ends of each leg lie.
 *
 * The profile stands upright on each leg, in a frame of three unit vectors:
 *     way    w   along the leg
 *     right  r = w x z / |w x z|, horizontal, with z = {0, 0, 1}
 *     up     u = r x w, in the vertical plane of the leg
 * Corner {y, z} of the profile runs along the line p + y r + z u + t w, where the leg begins at the point p.
 *
 * A leg ends in the plane that bisects the legs at a point of the path, with the normal n = w1 + w2. At the two ends of
 * an open path n = w. The corner lies in that plane at t = n . (q - p - y r - z u) / n . w, with the point q.
 *
 * The ends of two legs coincide where the path turns in a horizontal or a vertical plane. Elsewhere the one profile is
 * rolled against the other, and their outlines in the plane differ by a step. Plane sides that stand upright on both
 * legs have no common outline: floors of two legs of one slope meet along the way, not across it. A profile that did
 * not roll would lean more with each turn of a ramp. Each leg is on its own side of the plane. */
#include "path.h"

#include <talus/vmath.h>

/* Tolerance: sine of the angle between a leg and the vertical, up to which the leg has no upright profile. Two legs
 * fold back up to the same half of the cosine of half their turn. Test: lua/test_tunnel_path. */
#define UPRIGHT 1e-6

typedef struct leg {
    tl_vec3 from, way, right, up;
    tl_vec3 bisector[2]; /* normals of the planes at its ends; not of unit length */
    tl_vec3 to;
} leg;

static tl_status frame_leg(const tl_host *host, const tl_points *points, size_t k, double near, leg *l)
{
    l->from = points->at[k];
    l->to = points->at[k + 1];
    tl_vec3 along = tl_v3_sub(l->to, l->from);
    if (!(tl_v3_norm(along) > near))
        return host->fail(host, TL_E_GEOMETRY, "path has the same place {%g, %g, %g} as points %zu and %zu", l->from.x,
                          l->from.y, l->from.z, k + 1, k + 2);
    l->way = tl_v3_unit(along);
    tl_vec3 across = tl_v3_cross(l->way, tl_v3(0, 0, 1));
    if (!(tl_v3_norm(across) > UPRIGHT))
        return host->fail(host, TL_E_GEOMETRY,
                          "path: its leg from point %zu {%g, %g, %g} to %zu {%g, %g, %g} is vertical, and the profile "
                          "cannot stand upright on it; make a shaft of face1 and face2",
                          k + 1, l->from.x, l->from.y, l->from.z, k + 2, l->to.x, l->to.y, l->to.z);
    l->right = tl_v3_unit(across);
    l->up = tl_v3_cross(l->right, l->way);
    l->bisector[0] = l->bisector[1] = l->way;
    return TL_OK;
}

/* The plane between two legs that meet at point `at` of the path. */
static tl_status bisect(const tl_host *host, leg *before, leg *after, size_t at)
{
    tl_vec3 normal = tl_v3_add(before->way, after->way);
    if (!(tl_v3_norm(normal) > 2 * UPRIGHT))
        return host->fail(host, TL_E_GEOMETRY,
                          "path folds back on itself at point %zu {%g, %g, %g}; end one tunnel there and begin another",
                          at + 1, after->from.x, after->from.y, after->from.z);
    before->bisector[1] = after->bisector[0] = normal;
    return TL_OK;
}

/* Way along the leg at which a corner of the profile meets the plane at one end, m. */
static double way_to(const leg *l, int end, tl_vec3 corner)
{
    tl_vec3 n = l->bisector[end], q = end == 0 ? l->from : l->to;
    return tl_v3_dot(n, tl_v3_sub(q, corner)) / tl_v3_dot(n, l->way);
}

static tl_status lay_leg(const tl_host *host, const leg *l, const tl_points *profile, size_t k, double near,
                         tl_vec3 *corners)
{
    for (size_t i = 0; i < profile->count; i++) {
        tl_vec3 corner = tl_v3_madd(l->from, profile->at[i].x, l->right);
        corner = tl_v3_madd(corner, profile->at[i].y, l->up);
        double begin = way_to(l, 0, corner), end = way_to(l, 1, corner);
        if (!(end - begin > 4 * near))
            return host->fail(host, TL_E_GEOMETRY,
                              "path: its leg from point %zu {%g, %g, %g} to %zu {%g, %g, %g} is too short for the "
                              "turns at its ends: corner %zu of the profile would go %g m along it; turn less, or put "
                              "the points further apart",
                              k + 1, l->from.x, l->from.y, l->from.z, k + 2, l->to.x, l->to.y, l->to.z, i + 1,
                              end - begin);
        corners[i] = tl_v3_madd(corner, begin, l->way);
        corners[profile->count + i] = tl_v3_madd(corner, end, l->way);
    }
    return TL_OK;
}

tl_status tunnel_path_lay(const tl_host *host, const tl_points *profile, const tl_points *points, double near,
                          tunnel_path *made)
{
    const size_t legs = points->count - 1, each = 2 * profile->count;
    leg *of = calloc(legs, sizeof *of);
    made->corners = calloc(legs * each, sizeof *made->corners);
    made->legs = legs;
    made->closed = legs > 2 && tl_v3_norm(tl_v3_sub(points->at[legs], points->at[0])) <= near;
    tl_status status = of && made->corners ? TL_OK : host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t k = 0; k < legs && status == TL_OK; k++)
        status = frame_leg(host, points, k, near, &of[k]);
    for (size_t k = 1; k < legs && status == TL_OK; k++)
        status = bisect(host, &of[k - 1], &of[k], k);
    if (status == TL_OK && made->closed)
        status = bisect(host, &of[legs - 1], &of[0], 0);
    for (size_t k = 0; k < legs && status == TL_OK; k++)
        status = lay_leg(host, &of[k], profile, k, near, made->corners + k * each);
    free(of);
    return status;
}
