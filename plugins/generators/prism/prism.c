/* prism.c - generators "prism" and "profile": one body between two polygons, or of a section moved across its plane.
 *
 * The second polygon of a prism is the first moved by a vector, or given by itself with as many points. Between convex
 * polygons it is one block, the convex hull of both. A polygon that is not convex is divided, and moved by a vector
 * only: into a block for each of its convex parts, joined. The faces in which the parts meet are no joints: nothing
 * slides there, and no contact is looked for.
 *
 * A convex polygon is sound when its points lie in one plane and no two neighbours coincide. Every point lies on the
 * inner side of every edge. Its normal follows from the fan of triangles about its first point, whichever way round it
 * is given.
 *
 * The section of a profile lies in a coordinate plane: a slope, a dam or a wall as an engineer draws it, in one
 * call. */
#include "convex.h"

#include <stdbool.h>
#include <stdlib.h>
#include <talus/kit.h>
#include <talus/version.h>
#include <talus/vmath.h>

#define MOST_SIDES 1000
/* Points may miss a polygon's plane, or an edge its line, by this times the polygon's extent: what is lost
 * when coordinates are written with seven digits. */
#define FLAT 1e-6

/* ---------------------------------------------------------------- a body of parts -------- */

static tl_status refuse(const tl_host *host, const char *name, convex_status why, size_t one, size_t other,
                        size_t count)
{
    switch (why) {
    case CONVEX_MEMORY: return host->fail(host, TL_E_MEMORY, "out of memory");
    case CONVEX_COINCIDE:
        return host->fail(host, TL_E_GEOMETRY, "%s: points %zu and %zu coincide; leave one out", name, one + 1,
                          other + 1);
    case CONVEX_CROSSES:
        return host->fail(host, TL_E_GEOMETRY,
                          "%s crosses or touches itself: the edge from point %zu to %zu meets the one "
                          "from point %zu to %zu; a section with a hole is given as several without",
                          name, one + 1, (one + 1) % count + 1, other + 1, (other + 1) % count + 1);
    case CONVEX_EMPTY:
        return host->fail(host, TL_E_GEOMETRY,
                          "%s: its %zu points enclose no area; give the corners of a polygon in order", name, count);
    case CONVEX_DONE:
    case CONVEX_FAILED:
    default:
        return host->fail(host, TL_E_GEOMETRY, "%s could not be divided into convex parts; give it in several pieces",
                          name);
    }
}

/* Creates the block of one part. */
static tl_status create_part(const tl_host *host, tl_points points, const size_t *corner, size_t count, tl_vec3 axis,
                             double density, const char *group)
{
    tl_vec3 *ends = malloc(2 * count * sizeof *ends);
    if (!ends)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++) {
        ends[i] = points.at[corner[i]];
        ends[count + i] = tl_v3_add(ends[i], axis);
    }
    tl_status status = host->create_hull(host, ends, 2 * count, density, group);
    free(ends);
    return status;
}

/* Makes one body of the blocks from `first` on. */
static tl_status join_from(const tl_host *host, size_t first, size_t count)
{
    size_t *index = malloc(count * sizeof *index);
    if (!index)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++)
        index[i] = first + i;
    tl_status status = host->join(host, index, count);
    free(index);
    return status;
}

/* Makes one body of the convex parts of a plane polygon, each with the same moved by `axis`. `points` are its corners,
 * at[i] where points.at[i] lies in its plane; `name` is its name in messages. */
static tl_status extrude(const tl_host *host, const char *name, tl_points points, const tl_flat *at, tl_vec3 axis,
                         double density, const char *group)
{
    convex_parts parts;
    size_t one = 0, other = 0;
    convex_status divided = convex_divide(at, points.count, &parts, &one, &other);
    if (divided != CONVEX_DONE)
        return refuse(host, name, divided, one, other, points.count);
    size_t first = parts.parts > 1 ? host->block_count(host) : 0;
    tl_status status = TL_OK;
    for (size_t p = 0; p < parts.parts && status == TL_OK; p++)
        status = create_part(host, points, parts.corner + parts.start[p], parts.start[p + 1] - parts.start[p], axis,
                             density, group);
    if (status == TL_OK && parts.parts > 1)
        status = join_from(host, first, parts.parts);
    free(parts.corner);
    free(parts.start);
    return status;
}

/* ---------------------------------------------------------------- prism ------------------ */

typedef struct prism {
    tl_points base, top;
    tl_vec3 axis;
    double density;
    const char *group;
} prism;

static const tl_param prism_params[] = {
    TL_PARAM(TL_PARAM_POINTS, prism, base, "m", "corners of a polygon, in order; with top a convex one",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_POINTS, prism, top, "m", "corners of the other end, as many; or give axis",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_VEC3, prism, axis, "m", "from the base to the other end; or give top",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAMS_ROCK(prism, "block"),
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
        return host->fail(host, TL_E_ARGUMENT, "%s: %zu points, but a polygon has 3 to %d", g->name, count, MOST_SIDES);
    tl_vec3 area = {0, 0, 0};
    g->extent = 0;
    for (size_t i = 1; i < count; i++) {
        tl_vec3 arm = tl_v3_sub(at[i], at[0]);
        g->extent = fmax(g->extent, tl_v3_norm(arm));
        area = tl_v3_add(area, tl_v3_cross(tl_v3_sub(at[i - 1], at[0]), arm));
    }
    if (!(tl_v3_norm(area) > FLAT * g->extent * g->extent))
        return host->fail(host, TL_E_GEOMETRY,
                          "%s: its %zu points enclose no area; give the corners of a convex polygon in order", g->name,
                          count);
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
            return host->fail(host, TL_E_GEOMETRY, "%s: points %zu and %zu coincide; leave one out", g->name, i + 1,
                              (i + 1) % count + 1);
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
    return host->fail(host, TL_E_GEOMETRY,
                      "%s is not convex or crosses itself: point %zu lies outside the edge from "
                      "point %zu to %zu; give a convex polygon in order, or axis in the place of top",
                      g->name, point + 1, edge + 1, (edge + 1) % g->points.count + 1);
}

/* Makes the parts of a base that is not convex, moved by the axis. */
static tl_status divide(const tl_host *host, const prism *p, const polygon *base)
{
    tl_flat at[MOST_SIDES];
    tl_vec3 t1 = tl_v3_perpendicular(base->normal), t2 = tl_v3_cross(base->normal, t1);
    if (fabs(tl_v3_dot(base->normal, p->axis)) <= FLAT * base->extent)
        return host->fail(host, TL_E_GEOMETRY, "the ends meet or cross: axis lies in the plane of the base");
    for (size_t i = 0; i < base->points.count; i++) {
        tl_vec3 arm = tl_v3_sub(base->points.at[i], base->points.at[0]);
        at[i] = (tl_flat){tl_v3_dot(arm, t1), tl_v3_dot(arm, t2)};
    }
    return extrude(host, "base", base->points, at, p->axis, p->density, p->group);
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
static tl_status other_end(const tl_host *host, const prism *p, tl_vec3 *corner)
{
    size_t count = p->base.count;
    bool moved = !isnan(p->axis.x);
    if (moved == (p->top.count > 0))
        return host->fail(host, TL_E_ARGUMENT,
                          moved ? "axis and top both say where the other end is: give one of them"
                                : "give axis (a vector) or top (points): where the other end is");
    if (!moved && p->top.count != count)
        return host->fail(host, TL_E_ARGUMENT, "top has %zu points and base %zu: a prism has as many at both ends",
                          p->top.count, count);
    for (size_t i = 0; i < count; i++)
        corner[i] = moved ? tl_v3_add(p->base.at[i], p->axis) : p->top.at[i];
    return TL_OK;
}

static tl_status generate_prism(const tl_host *host, const void *given)
{
    const prism *p = given;
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
    polygon top = {.name = isnan(p->axis.x) ? "top" : "the moved base", .points = {corner + count, count}};
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

/* ---------------------------------------------------------------- profile ---------------- */

typedef struct profile {
    tl_points section;
    int32_t plane;
    double from, to, density;
    const char *group;
} profile;

/* The plane's letters name the two numbers of a point, in their order. */
static const char *const planes[] = {"xz", "yz", "xy", "zx", "zy", "yx", NULL};
/* Of the first number, the second, and the axis across the plane: 0 x, 1 y, 2 z. */
static const unsigned char axes[][3] = {{0, 2, 1}, {1, 2, 0}, {0, 1, 2}, {2, 0, 1}, {2, 1, 0}, {1, 0, 2}};

static const tl_param profile_params[] = {
    TL_PARAM(TL_PARAM_POINTS, profile, section, "m", "corners of the section, in order, two numbers each",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_FLAT, .alias = "points"),
    TL_PARAM(TL_PARAM_ENUM, profile, plane, "",
             "plane of the section: its letters say what the two numbers of a corner are", .choices = planes),
    TL_PARAM(TL_PARAM_REAL, profile, from, "m", "where the section begins on the axis across its plane", .def = {0}),
    TL_PARAM(TL_PARAM_REAL, profile, to, "m", "where it ends there, > from", .flags = TL_PARAM_REQUIRED),
    TL_PARAMS_ROCK(profile, "block"),
};

/* The point of three coordinates given by the numbers of their axes. */
static tl_vec3 point_of(const unsigned char axis[3], double first, double second, double across)
{
    double at[3];
    at[axis[0]] = first;
    at[axis[1]] = second;
    at[axis[2]] = across;
    return (tl_vec3){at[0], at[1], at[2]};
}

static tl_status generate_profile(const tl_host *host, const void *given)
{
    const profile *p = given;
    const unsigned char *axis = axes[p->plane];
    size_t count = p->section.count;
    if (count < 3 || count > MOST_SIDES)
        return host->fail(host, TL_E_ARGUMENT, "section: %zu points, but a polygon has 3 to %d", count, MOST_SIDES);
    if (!(p->from < p->to))
        return host->fail(host, TL_E_ARGUMENT, "from = %g m must be < to = %g m: they are along %c", p->from, p->to,
                          "xyz"[axis[2]]);
    tl_flat at[MOST_SIDES];
    tl_vec3 corner[MOST_SIDES];
    for (size_t i = 0; i < count; i++) {
        tl_vec3 given_at = p->section.at[i];
        at[i] = (tl_flat){given_at.x, given_at.y};
        corner[i] = point_of(axis, given_at.x, given_at.y, p->from);
    }
    return extrude(host, "section", (tl_points){corner, count}, at, point_of(axis, 0, 0, p->to - p->from), p->density,
                   p->group);
}

static const tl_kind kinds[] = {
    TL_GENERATOR_KIND(generate_prism, .name = "prism", .doc = "Creates one body between two polygons.",
                      TL_KIND_PARAMS(prism, prism_params)),
    TL_GENERATOR_KIND(generate_profile, .name = "profile",
                      .doc = "Creates one body of a section in a plane, moved across it: a slope, a dam, a wall.",
                      TL_KIND_PARAMS(profile, profile_params)),
};

TL_PLUGIN(kinds, .id = "talus.prism", .version = TALUS_VERSION,
          .doc = "Generators of prisms and of sections moved across their plane.", .licence = "BSD-3-Clause");
