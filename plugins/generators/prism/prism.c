/* prism.c - generator "prism": one body between two polygons. The second is the first moved by a vector, or given by
 * itself with as many points. Between convex polygons it is one block, the convex hull of both. A polygon that is not convex
 * is divided, and moved by a vector only (extrude.c).
 *
 * A convex polygon is sound when its points lie in one plane, no two neighbours coincide, and every point lies on
 * the inner side of every edge. Its normal follows from the fan of triangles about its first point, whichever way round it
 * is given. */
#include "prism.h"

#include <talus/vmath.h>

#include <stdbool.h>

/* Points may miss a polygon's plane, or an edge its line, by this times the polygon's extent: what is lost
 * when coordinates are written with seven digits. */
#define FLAT 1e-6

typedef struct params {
    tl_points base, top;
    tl_vec3 axis;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, base, "m",
             "corners of a polygon, in order; with top a convex one", .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_POINTS, params, top, "m", "corners of the other end, as many; or give axis",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, params, axis, "m", "from the base to the other end; or give top",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAMS_ROCK(params, "block"),
};

/* A sound polygon. */
typedef struct polygon {
    const char *name;
    tl_points points;
    tl_vec3 normal;
    double extent; /* largest distance from the first point */
} polygon;

static tl_status measure(const tl_host *host, polygon *g)
{
    size_t count = g->points.count;
    const tl_vec3 *at = g->points.at;
    if (count < 3 || count > MOST_SIDES)
        return host->fail(host, TL_E_ARGUMENT, "%s: %zu points, but a polygon has 3 to %d", g->name,
                          count, MOST_SIDES);
    tl_vec3 area = {0, 0, 0};
    g->extent = 0;
    for (size_t i = 1; i < count; i++) {
        tl_vec3 arm = tl_v3_sub(at[i], at[0]);
        g->extent = fmax(g->extent, tl_v3_norm(arm));
        area = tl_v3_add(area, tl_v3_cross(tl_v3_sub(at[i - 1], at[0]), arm));
    }
    if (!(tl_v3_norm(area) > FLAT * g->extent * g->extent))
        return host->fail(
            host, TL_E_GEOMETRY,
            "%s: its %zu points enclose no area; give the corners of a convex polygon "
            "in order",
            g->name, count);
    g->normal = tl_v3_unit(area);
    return TL_OK;
}

/* The points lie in one plane, and no two neighbours coincide. */
static tl_status check_points(const tl_host *host, const polygon *g)
{
    size_t count = g->points.count;
    const tl_vec3 *at = g->points.at;
    double tolerance = FLAT * g->extent;
    for (size_t i = 0; i < count; i++) {
        double off = tl_v3_dot(g->normal, tl_v3_sub(at[i], at[0]));
        if (fabs(off) > tolerance)
            return host->fail(host, TL_E_GEOMETRY,
                              "%s: point %zu lies %.3g m outside the plane of the others; the "
                              "points must lie in one plane",
                              g->name, i + 1, fabs(off));
        if (tl_v3_norm(tl_v3_sub(at[(i + 1) % count], at[i])) <= tolerance)
            return host->fail(host, TL_E_GEOMETRY, "%s: points %zu and %zu coincide; leave one out",
                              g->name, i + 1, (i + 1) % count + 1);
    }
    return TL_OK;
}

/* Whether no point lies outside an edge; else the point and the edge. */
static bool is_convex(const polygon *g, size_t *point, size_t *edge)
{
    size_t count = g->points.count;
    const tl_vec3 *at = g->points.at;
    for (size_t i = 0; i < count; i++) {
        tl_vec3 inward = tl_v3_unit(tl_v3_cross(g->normal, tl_v3_sub(at[(i + 1) % count], at[i])));
        for (size_t j = 0; j < count; j++)
            if (tl_v3_dot(inward, tl_v3_sub(at[j], at[i])) < -FLAT * g->extent) {
                *point = j;
                *edge = i;
                return false;
            }
    }
    return true;
}

static tl_status check_shape(const tl_host *host, const polygon *g)
{
    size_t point, edge;
    tl_status status = check_points(host, g);
    if (status != TL_OK || is_convex(g, &point, &edge))
        return status;
    return host->fail(
        host, TL_E_GEOMETRY,
        "%s is not convex or crosses itself: point %zu lies outside the edge from "
        "point %zu to %zu; give a convex polygon in order, or axis in the place of top",
        g->name, point + 1, edge + 1, (edge + 1) % g->points.count + 1);
}

/* Makes the parts of a base that is not convex, moved by the axis. */
static tl_status divide(const tl_host *host, const params *p, const polygon *base)
{
    flat at[MOST_SIDES];
    tl_vec3 t1 = tl_v3_perpendicular(base->normal), t2 = tl_v3_cross(base->normal, t1);
    if (fabs(tl_v3_dot(base->normal, p->axis)) <= FLAT * base->extent)
        return host->fail(host, TL_E_GEOMETRY,
                          "the ends meet or cross: axis lies in the plane of the base");
    for (size_t i = 0; i < base->points.count; i++) {
        tl_vec3 arm = tl_v3_sub(base->points.at[i], base->points.at[0]);
        at[i] = (flat){tl_v3_dot(arm, t1), tl_v3_dot(arm, t2)};
    }
    return prism_extrude(host, "base", base->points, at, p->axis, p->density, p->group);
}

/* The points of one end lie on one side of the plane of the other, and none in it. */
static tl_status check_apart(const tl_host *host, const polygon *g, const polygon *other)
{
    double side = 0;
    for (size_t i = 0; i < other->points.count; i++) {
        double off = tl_v3_dot(g->normal, tl_v3_sub(other->points.at[i], g->points.at[0]));
        if (side * off < 0 || fabs(off) <= FLAT * g->extent)
            return host->fail(host, TL_E_GEOMETRY,
                              "the ends meet or cross: point %zu of %s lies %s the plane of %s, "
                              "and all must lie on one side of it",
                              i + 1, other->name, side * off < 0 ? "across" : "in", g->name);
        side = off;
    }
    return TL_OK;
}

/* Fills in the other end: given, or moved by the axis. */
static tl_status other_end(const tl_host *host, const params *p, tl_vec3 *corner)
{
    size_t count = p->base.count;
    bool moved = !isnan(p->axis.x);
    if (moved == (p->top.count > 0))
        return host->fail(host, TL_E_ARGUMENT,
                          moved ? "axis and top both say where the other end is: give one of them"
                                : "give axis (a vector) or top (points): where the other end is");
    if (!moved && p->top.count != count)
        return host->fail(host, TL_E_ARGUMENT,
                          "top has %zu points and base %zu: a prism has as many at both ends",
                          p->top.count, count);
    for (size_t i = 0; i < count; i++)
        corner[i] = moved ? tl_v3_add(p->base.at[i], p->axis) : p->top.at[i];
    return TL_OK;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    polygon base = {.name = "base", .points = p->base};
    tl_status status = measure(host, &base);
    if (status == TL_OK)
        status = check_points(host, &base);
    if (status != TL_OK)
        return status;
    size_t point, edge;
    if (!is_convex(&base, &point, &edge) && p->top.count == 0 && !isnan(p->axis.x))
        return divide(host, p, &base);
    status = check_shape(host, &base);
    if (status != TL_OK)
        return status;
    tl_vec3 corner[2 * MOST_SIDES];
    size_t count = base.points.count;
    for (size_t i = 0; i < count; i++)
        corner[i] = base.points.at[i];
    status = other_end(host, p, corner + count);
    polygon top = {.name = isnan(p->axis.x) ? "top" : "the moved base",
                   .points = {corner + count, count}};
    if (status == TL_OK)
        status = measure(host, &top);
    if (status == TL_OK)
        status = check_shape(host, &top);
    if (status == TL_OK)
        status = check_apart(host, &base, &top);
    if (status == TL_OK)
        status = check_apart(host, &top, &base);
    if (status != TL_OK)
        return status;
    return host->create_hull(host, corner, 2 * count, p->density, p->group);
}

const tl_kind prism_kind =
    TL_GENERATOR_KIND(generate, .name = "prism", .doc = "Creates one body between two polygons.",
                      TL_KIND_PARAMS(params, param_table));
