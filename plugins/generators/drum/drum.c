/* drum.c - generator "drum": one block, an upright prism whose ends are regular polygons inscribed in
 * circles about an axis. Its volume is sides/2 radius^2 sin(360 deg / sides) height. */
#include <talus/kit.h>
#include <talus/version.h>
#include <talus/vmath.h>

/* Most sides: more would make edges that no time step likes. */
#define MOST_SIDES 1000

typedef struct params {
    tl_vec3 center, axis;
    double radius, height;
    int64_t sides;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_VEC3, params, center, "m", "middle of the drum", .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_VEC3, params, axis, "", "direction of its axis, of any length", .def = {0, 0, 1}),
    TL_PARAM_POSITIVE(params, radius, "m", "from the axis to the corners"),
    TL_PARAM_POSITIVE(params, height, "m", "along the axis"),
    TL_PARAM(TL_PARAM_INT, params, sides, "", "number of flat sides", .def = {12}, .min = 3, .max = MOST_SIDES),
    TL_PARAMS_ROCK(params, "block"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    double length = tl_v3_norm(p->axis);
    if (!(length > 0) || !isfinite(length))
        return host->fail(host, TL_E_ARGUMENT, "axis = {%g, %g, %g} has no direction: give one such as {0, 0, 1}",
                          p->axis.x, p->axis.y, p->axis.z);
    tl_vec3 n = tl_v3_scale(1 / length, p->axis);
    tl_vec3 e = tl_v3_perpendicular(n), f = tl_v3_cross(n, e), corner[2 * MOST_SIDES];
    size_t sides = (size_t)p->sides;
    for (size_t i = 0; i < sides; i++) {
        double angle = 360 * (double)i / (double)sides;
        tl_vec3 arm =
            tl_v3_madd(tl_v3_scale(p->radius * tl_cos_degrees(angle), e), p->radius * tl_sin_degrees(angle), f);
        tl_vec3 point = tl_v3_add(p->center, arm);
        corner[i] = tl_v3_madd(point, -0.5 * p->height, n);
        corner[sides + i] = tl_v3_madd(point, 0.5 * p->height, n);
    }
    return host->create_hull(host, corner, 2 * sides, p->density, p->group);
}

static const tl_kind kind =
    TL_GENERATOR_KIND(generate, .name = "drum", .doc = "Creates one block: a cylinder of flat sides.",
                      TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.drum", .version = TALUS_VERSION, .doc = "Drum generator.", .licence = "BSD-3-Clause");
