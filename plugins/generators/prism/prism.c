/* prism.c - generator "prism": one block between two convex polygons. The second is the first moved by
 * a vector, or given by itself with as many points; the block is the convex hull of both.
 *
 * A polygon is sound when its points lie in one plane, no two neighbours coincide, and every point lies on
 * the inner side of every edge, which also refuses one that crosses itself. Its normal follows from the
 * fan of triangles about its first point, whichever way round it is given. */
#include <talus/plugin.h>
#include <talus/version.h>
#include <talus/vmath.h>

#include <stdbool.h>

/* Points may miss a polygon's plane, or an edge its line, by this times the polygon's extent: what is lost
 * when coordinates are written with seven digits. */
#define FLAT 1e-6
#define MOST_SIDES 1000

typedef struct params {
    tl_points base, top;
    tl_vec3 axis;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, base, "m", "corners of a convex polygon, in order",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_POINTS, params, top, "m", "corners of the other end, as many; or give axis",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, params, axis, "m", "from the base to the other end; or give top",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_REAL, params, density, "kg/m3", "density of the block",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_STRING, params, group, "", "group of the block", .def_text = "rock"),
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

static tl_status check_shape(const tl_host *host, const polygon *g)
{
    size_t count = g->points.count;
    const tl_vec3 *at = g->points.at;
    double tolerance = FLAT * g->extent;
    for (size_t i = 0; i < count; i++) {
        double off = tl_v3_dot(g->normal, tl_v3_sub(at[i], at[0]));
        tl_vec3 edge = tl_v3_sub(at[(i + 1) % count], at[i]);
        double length = tl_v3_norm(edge);
        if (fabs(off) > tolerance)
            return host->fail(host, TL_E_GEOMETRY,
                              "%s: point %zu lies %.3g m outside the plane of the others; the "
                              "points must lie in one plane",
                              g->name, i + 1, fabs(off));
        if (length <= tolerance)
            return host->fail(host, TL_E_GEOMETRY, "%s: points %zu and %zu coincide; leave one out",
                              g->name, i + 1, (i + 1) % count + 1);
        tl_vec3 inward = tl_v3_scale(1 / length, tl_v3_cross(g->normal, edge));
        for (size_t j = 0; j < count; j++)
            if (tl_v3_dot(inward, tl_v3_sub(at[j], at[i])) < -tolerance)
                return host->fail(host, TL_E_GEOMETRY,
                                  "%s is not convex or crosses itself: point %zu lies outside the "
                                  "edge from point %zu to %zu; give a convex polygon in order",
                                  g->name, j + 1, i + 1, (i + 1) % count + 1);
    }
    return TL_OK;
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

static const tl_generator_ops ops = {.size = sizeof ops, .generate = generate};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_GENERATOR,
    .name = "prism",
    .doc = "Creates one block between two polygons.",
    .params_size = sizeof(params),
    .params = param_table,
    .param_count = sizeof param_table / sizeof *param_table,
    .param_stride = sizeof *param_table,
    .ops = &ops,
};

static const tl_plugin plugin = {
    .size = sizeof plugin,
    .abi_major = TL_ABI_MAJOR,
    .abi_minor = TL_ABI_MINOR,
    .id = "talus.prism",
    .version = TALUS_VERSION,
    .doc = "Prism generator.",
    .licence = "BSD-3-Clause",
    .kinds = &kind,
    .kind_count = 1,
    .kind_stride = sizeof kind,
};

TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)
{
    (void)host_minor;
    return host_major == TL_ABI_MAJOR ? &plugin : NULL;
}
