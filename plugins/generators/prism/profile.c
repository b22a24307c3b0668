/* profile.c - generator "profile": a section in a coordinate plane, moved along the third axis. A slope, a dam or a wall as
 * an engineer draws it, in one call. The section need not be convex (extrude.c). */
#include "prism.h"

#include <talus/vmath.h>

typedef struct params {
    tl_points section;
    int32_t plane;
    double from, to, density;
    const char *group;
} params;

/* The plane's letters name the two numbers of a point, in their order. */
static const char *const planes[] = {"xz", "yz", "xy", "zx", "zy", "yx", NULL};
/* Of the first number, the second, and the axis across the plane: 0 x, 1 y, 2 z. */
static const unsigned char axes[][3] = {{0, 2, 1}, {1, 2, 0}, {0, 1, 2},
                                        {2, 0, 1}, {2, 1, 0}, {1, 0, 2}};

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, section, "m",
             "corners of the section, in order, two numbers each",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_FLAT, .alias = "points"),
    TL_PARAM(TL_PARAM_ENUM, params, plane, "",
             "plane of the section: its letters say what the two numbers of a corner are",
             .choices = planes),
    TL_PARAM(TL_PARAM_REAL, params, from, "m",
             "where the section begins on the axis across its plane", .def = {0}),
    TL_PARAM(TL_PARAM_REAL, params, to, "m", "where it ends there, > from",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAMS_ROCK(params, "block"),
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

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    const unsigned char *axis = axes[p->plane];
    size_t count = p->section.count;
    if (count < 3 || count > MOST_SIDES)
        return host->fail(host, TL_E_ARGUMENT, "section: %zu points, but a polygon has 3 to %d",
                          count, MOST_SIDES);
    if (!(p->from < p->to))
        return host->fail(host, TL_E_ARGUMENT, "from = %g m must be < to = %g m: they are along %c",
                          p->from, p->to, "xyz"[axis[2]]);
    flat at[MOST_SIDES];
    tl_vec3 corner[MOST_SIDES];
    for (size_t i = 0; i < count; i++) {
        tl_vec3 given_at = p->section.at[i];
        at[i] = (flat){given_at.x, given_at.y};
        corner[i] = point_of(axis, given_at.x, given_at.y, p->from);
    }
    return prism_extrude(host, "section", (tl_points){corner, count}, at,
                         point_of(axis, 0, 0, p->to - p->from), p->density, p->group);
}

const tl_kind profile_kind = TL_GENERATOR_KIND(
    generate, .name = "profile",
    .doc = "Creates one body of a section in a plane, moved across it: a slope, a dam, a wall.",
    TL_KIND_PARAMS(params, param_table));
