/* fracture.c - planes of finite extent, and which sections of blocks they reach.
 *
 * A face is a convex polygon given counter-clockwise about its normal n. A point is over it when it lies
 * on the left of every edge, n x edge . (point - a) >= 0; otherwise the nearest point of the face is on one
 * of the edges. Distances are measured in the plane: the part along n is left out. A disc reaches a face when its
 * centre is nearer than its radius.
 *
 * Two convex polygons of one plane are apart when a line along one of their edges parts them. The depth to which they
 * overlap is the least of all edges' directions d: min(max_A - min_B, max_B - min_A) of d . x. */
#include "generate/fracture.h"

#include <math.h>
#include <talus/vmath.h>

/* Tolerance: corners are given with seven digits. So a polygon may miss its plane by this times its size. One that
 * reaches into a section by less ends at its border. Test: lua/test_fracture. */
#define FIT 1e-6

/* Limit: corners of a polygon, whose work grows with the square of their number. */
#define MOST_CORNERS 1000

/* ---------------------------------------------------------------- a polygon -------------- */

/* The sum of the cross products of neighbouring corners, twice the area along the normal. */
static tl_vec3 twice_area(const tl_vec3 *corner, size_t count, tl_vec3 middle)
{
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        sum = tl_v3_add(sum, tl_v3_cross(tl_v3_sub(corner[i], middle), tl_v3_sub(corner[(i + 1) % count], middle)));
    return sum;
}

/* Whether a normal points up or, of a vertical plane, north or else east. So it does not depend on the way round. */
static bool is_upward(tl_vec3 normal)
{
    if (normal.z != 0)
        return normal.z > 0;
    return normal.y != 0 ? normal.y > 0 : normal.x > 0;
}

/* Neighbouring corners differ, all lie in the plane, and none is outside an edge. */
static tl_status check_corners(const tl_fracture *f, tl_vec3 around, tl_error *error)
{
    const size_t n = f->corner_count;
    const double fit = FIT * f->radius;
    for (size_t i = 0; i < n; i++) {
        const size_t next = (i + 1) % n;
        const tl_vec3 edge = tl_v3_sub(f->corner[next], f->corner[i]);
        const double off = tl_v3_dot(f->normal, tl_v3_sub(f->corner[i], f->point));
        if (tl_v3_norm(edge) <= fit)
            return tl_fail(error, TL_E_GEOMETRY, "corners %zu and %zu of the polygon coincide; leave one out", i + 1,
                           next + 1);
        if (fabs(off) > fit)
            return tl_fail(error, TL_E_GEOMETRY,
                           "corner %zu of the polygon lies %.3g m off its plane, more than %.3g m; give corners in one "
                           "plane",
                           i + 1, fabs(off), fit);
        const tl_vec3 inward = tl_v3_unit(tl_v3_cross(around, edge));
        for (size_t k = 0; k < n; k++)
            if (tl_v3_dot(inward, tl_v3_sub(f->corner[k], f->corner[i])) < -fit)
                return tl_fail(error, TL_E_GEOMETRY,
                               "the polygon is not convex or crosses itself: corner %zu lies outside the edge from "
                               "corner %zu to %zu; give the corners of a convex polygon in order, or several polygons",
                               k + 1, i + 1, next + 1);
    }
    return TL_OK;
}

tl_status tl_fracture_polygon(const tl_vec3 *corner, size_t count, tl_fracture *made, tl_error *error)
{
    if (count < 3 || count > MOST_CORNERS)
        return tl_fail(error, TL_E_ARGUMENT, "the polygon has %zu corners; it needs 3 to %d", count, MOST_CORNERS);
    *made = (tl_fracture){.corner = corner, .corner_count = count};
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 1; i < count; i++)
        sum = tl_v3_add(sum, tl_v3_sub(corner[i], corner[0]));
    made->point = tl_v3_madd(corner[0], 1 / (double)count, sum);
    for (size_t i = 0; i < count; i++)
        made->radius = fmax(made->radius, tl_v3_norm(tl_v3_sub(corner[i], made->point)));
    const tl_vec3 area = twice_area(corner, count, made->point);
    if (!(tl_v3_norm(area) > FIT * made->radius * made->radius))
        return tl_fail(error, TL_E_GEOMETRY, "the %zu corners of the polygon enclose no area: give them in order",
                       count);
    const tl_vec3 around = tl_v3_unit(area);
    made->normal = is_upward(around) ? around : tl_v3_neg(around);
    return check_corners(made, around, error);
}

/* ---------------------------------------------------------------- a disc ----------------- */

/* Square of the distance of a point from the edge a + t along, 0 <= t <= 1, with the part along n left out. */
static double edge_distance2(tl_vec3 along, tl_vec3 arm, tl_vec3 n)
{
    tl_vec3 flat = tl_v3_madd(arm, -tl_v3_dot(arm, n), n);
    double length2 = tl_v3_norm2(along);
    double t = length2 > 0 ? tl_v3_dot(flat, along) / length2 : 0;
    t = fmin(fmax(t, 0), 1);
    return tl_v3_norm2(tl_v3_madd(flat, -t, along));
}

/* Distance of a point from a face; 0 for a point over the face. */
static double face_distance(const tl_poly *p, uint32_t face, tl_vec3 point)
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

static bool disc_reaches(const tl_model *m, const tl_fracture *f, uint32_t body, const tl_poly *p, uint32_t face)
{
    tl_vec3 center = tl_v3_sub(f->point, m->origin);
    if (body != TL_NO_ROW) {
        const tl_pose *pose = &m->bodies.pose[body];
        center = tl_m3_tmul(&pose->r, tl_v3_sub(tl_v3_sub(center, pose->x_ref), pose->u));
    }
    return face_distance(p, face, center) < f->radius;
}

/* ---------------------------------------------------------------- a polygon's overlap ---- */

/* Where the corners of polygon and face lie, relative to the polygon's middle. */
typedef struct overlap {
    const tl_model *m;
    const tl_fracture *fracture;
    const tl_poly *shape;
    uint32_t body, face;
} overlap;

static tl_vec3 polygon_corner(const overlap *o, size_t i)
{
    return tl_v3_sub(o->fracture->corner[i % o->fracture->corner_count], o->fracture->point);
}

static tl_vec3 face_corner(const overlap *o, size_t i)
{
    const uint16_t *loop = o->shape->loop + o->shape->start[o->face];
    const tl_vec3 local = o->shape->vertex[loop[i % tl_poly_face_size(o->shape, o->face)]];
    const tl_vec3 x = o->body == TL_NO_ROW ? local : tl_body_point(&o->m->bodies, o->body, local);
    return tl_v3_sub(x, tl_v3_sub(o->fracture->point, o->m->origin));
}

/* How deep polygon and face overlap along a direction; negative: they are apart. */
static double depth_along(const overlap *o, tl_vec3 direction)
{
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < o->fracture->corner_count; i++) {
        const double x = tl_v3_dot(direction, polygon_corner(o, i));
        least[0] = fmin(least[0], x);
        most[0] = fmax(most[0], x);
    }
    for (size_t i = 0; i < tl_poly_face_size(o->shape, o->face); i++) {
        const double x = tl_v3_dot(direction, face_corner(o, i));
        least[1] = fmin(least[1], x);
        most[1] = fmax(most[1], x);
    }
    return fmin(most[0] - least[1], most[1] - least[0]);
}

/* The least depth across an edge, and no more than `depth`. */
static double depth_across(const overlap *o, tl_vec3 edge, double depth)
{
    const tl_vec3 across = tl_v3_cross(o->fracture->normal, edge);
    return tl_v3_is_zero(across) ? depth : fmin(depth, depth_along(o, tl_v3_unit(across)));
}

static bool polygon_reaches(const overlap *o)
{
    double depth = INFINITY;
    for (size_t i = 0; i < o->fracture->corner_count; i++)
        depth = depth_across(o, tl_v3_sub(polygon_corner(o, i + 1), polygon_corner(o, i)), depth);
    for (size_t i = 0; i < tl_poly_face_size(o->shape, o->face); i++)
        depth = depth_across(o, tl_v3_sub(face_corner(o, i + 1), face_corner(o, i)), depth);
    return depth > FIT * o->fracture->radius;
}

bool tl_fracture_reaches(const tl_model *m, const tl_fracture *fracture, uint32_t body, const tl_poly *p, uint32_t face)
{
    if (isinf(fracture->radius))
        return true;
    if (fracture->corner_count == 0)
        return disc_reaches(m, fracture, body, p, face);
    const overlap of = {m, fracture, p, body, face};
    return polygon_reaches(&of);
}
