/* overlay.c - the polygon that two faces have in common, and three points that integrate over it.
 *
 * Both faces are projected along n = p / |p|, p = s n_A - (1 - s) n_B. The share s is 1 where the outline of what they
 * have in common is B's, and 0 where it is A's. Then the polygon keeps to the face with the outline, however the other
 * one tilts. Its area A is measured on that face. With the centroid c and the second moments
 * S = int (x - c)(x - c)^T dA / A = L L^T (Cholesky) the points
 *
 *     c + sqrt(2) L e_k,    e_k = (cos a, sin a),    a = 0, 120, 240 degrees
 *
 * with a third of the area each integrate every function of the second degree exactly, and lie in the polygon. The axes
 * of the plane go by an edge of the face, so the same polygon has the same points. */
#include "narrow/overlay.h"

#include <math.h>

/* Tolerance: common area, of the smaller face, below which two faces have none: it is rounding. */
#define NO_AREA 1e-14

/* sqrt(2) times cos and sin of 0, 120 and 240 degrees. */
static const double around[3][2] = {{1.4142135623730950488, 0},
                                    {-0.70710678118654752440, 1.2247448713915890491},
                                    {-0.70710678118654752440, -1.2247448713915890491}};

/* The vector area of a face. */
static tl_vec3 area_of(const tl_outer_face *f)
{
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 1; i + 1 < f->count; i++)
        sum = tl_v3_add(sum,
                        tl_v3_cross(tl_v3_sub(f->corner[i], f->corner[0]), tl_v3_sub(f->corner[i + 1], f->corner[0])));
    return tl_v3_scale(0.5, sum);
}

/* Area, centroid and second moments of a polygon, from its first corner. */
typedef struct moments {
    double area, x, y, xx, xy, yy;
} moments;

static moments moments_of(const tl_point2 *p, size_t count)
{
    moments m = {0};
    for (size_t i = 1; i + 1 < count; i++) {
        const tl_point2 a = tl_from_to(p[0], p[i]), b = tl_from_to(p[0], p[i + 1]);
        const double area = 0.5 * (a.x * b.y - a.y * b.x), sx = a.x + b.x, sy = a.y + b.y;
        m.area += area;
        m.x += area * sx / 3;
        m.y += area * sy / 3;
        m.xx += area * (sx * sx + a.x * a.x + b.x * b.x) / 12;
        m.xy += area * (sx * sy + a.x * a.y + b.x * b.y) / 12;
        m.yy += area * (sy * sy + a.y * a.y + b.y * b.y) / 12;
    }
    if (!(m.area > 0))
        return m;
    m.x /= m.area;
    m.y /= m.area;
    m.xx = m.xx / m.area - m.x * m.x;
    m.xy = m.xy / m.area - m.x * m.y;
    m.yy = m.yy / m.area - m.y * m.y;
    return m;
}

/* The place on a face's plane that lies over a point of the bisecting plane, along n. */
static tl_vec3 raised(tl_vec3 at, tl_vec3 n, tl_vec3 corner, tl_vec3 area)
{
    return tl_v3_madd(at, tl_v3_dot(area, tl_v3_sub(corner, at)) / tl_v3_dot(area, n), n);
}

static void project(const tl_outer_face *f, tl_vec3 from, tl_vec3 e, tl_vec3 g, tl_point2 *out)
{
    for (size_t i = 0; i < f->count; i++) {
        const tl_vec3 d = tl_v3_sub(f->corner[i], from);
        out[i] = (tl_point2){tl_v3_dot(d, e), tl_v3_dot(d, g)};
    }
}

/* Tolerance: share of the outline from which on the points are laid along an edge of B: far from those of outlines that
 * are one side's or both's. */
#define RIDES_ON_B 0.75

/* The direction of the first edge of a face, across n. Points laid by it keep to the face. */
static tl_vec3 first_edge(const tl_outer_face *f, tl_vec3 n)
{
    const tl_vec3 edge = tl_v3_sub(f->corner[1], f->corner[0]);
    return tl_v3_unit(tl_v3_madd(edge, -tl_v3_dot(edge, n), n));
}

bool tl_overlay_find(const tl_outer_face *a, const tl_outer_face *b, double share, tl_overlay_room *room,
                     tl_overlay *out)
{
    const tl_vec3 area_a = area_of(a), area_b = area_of(b), origin = a->corner[0];
    const tl_vec3 na = tl_v3_unit(area_a), nb = tl_v3_unit(area_b);
    const tl_vec3 n = tl_v3_unit(tl_v3_madd(tl_v3_scale(share, na), share - 1, nb));
    if (!(tl_v3_dot(area_a, n) > 0) || !(tl_v3_dot(area_b, n) < 0))
        return false;
    const tl_vec3 e = first_edge(share > RIDES_ON_B ? b : a, n), g = tl_v3_cross(n, e);
    project(a, origin, e, g, room->now);
    project(b, origin, e, g, room->by);
    const size_t count = tl_polygon_common(&room->now, &room->next, a->count, room->by, b->count);
    const moments m = moments_of(room->now, count);
    if (!(m.area > NO_AREA * fmin(tl_v3_norm(area_a), tl_v3_norm(area_b))))
        return false;
    const double l11 = sqrt(fmax(m.xx, 0)), l21 = l11 > 0 ? m.xy / l11 : 0, l22 = sqrt(fmax(m.yy - l21 * l21, 0));
    out->area = m.area * ((1 - share) / tl_v3_dot(na, n) - share / tl_v3_dot(nb, n));
    out->n = n;
    const tl_point2 first = room->now[0];
    for (int k = 0; k < 3; k++) {
        const double x = first.x + m.x + l11 * around[k][0];
        const double y = first.y + m.y + l21 * around[k][0] + l22 * around[k][1];
        const tl_vec3 at = tl_v3_madd(tl_v3_madd(origin, x, e), y, g);
        out->on_a[k] = raised(at, n, a->corner[0], area_a);
        out->on_b[k] = raised(at, n, b->corner[0], area_b);
    }
    out->outline = room->now;
    out->corners = l11 > 0 && l22 > 0 ? count : 0;
    for (size_t i = 0; i < out->corners; i++) {
        const double x = (room->now[i].x - first.x - m.x) / l11;
        room->now[i] = (tl_point2){x, (room->now[i].y - first.y - m.y - l21 * x) / l22};
    }
    return true;
}
