/* box.c - generator "box": one block, an axis-aligned box. */
#include <talus/kit.h>
#include <talus/version.h>

#include <math.h>

typedef struct params {
    tl_vec3 min, max;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_VEC3, params, min, "m", "lowest corner", .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_VEC3, params, max, "m", "highest corner", .flags = TL_PARAM_REQUIRED),
    TL_PARAMS_ROCK(params, "block"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    const double low[3] = {p->min.x, p->min.y, p->min.z}, high[3] = {p->max.x, p->max.y, p->max.z};
    static const char axis[3] = {'x', 'y', 'z'};
    for (int k = 0; k < 3; k++)
        if (!(low[k] < high[k]))
            return host->fail(host, TL_E_ARGUMENT, "max.%c = %g m must be > min.%c = %g m", axis[k], high[k], axis[k],
                              low[k]);
    return host->create_box(host, p->min, p->max, p->density, p->group);
}

static const tl_kind kind = TL_GENERATOR_KIND(generate, .name = "box", .doc = "Creates one block, an axis-aligned box.",
                                              TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.box", .version = TALUS_VERSION, .doc = "Box generator.", .licence = "BSD-3-Clause");
