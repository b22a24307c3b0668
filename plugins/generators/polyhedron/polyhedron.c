/* polyhedron.c - generator "polyhedron": one block, the convex hull of its vertices. The host refuses
 * vertices that span no volume, and a vertex that is no corner of the hull because it lies inside. */
#include <talus/plugin.h>
#include <talus/version.h>

#include <math.h>

typedef struct params {
    tl_points vertices;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, vertices, "m", "corners of the block, in any order",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, params, density, "kg/m3", "density of the block",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_STRING, params, group, "", "group of the block", .def_text = "rock"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    return host->create_hull(host, p->vertices.at, p->vertices.count, p->density, p->group);
}

static const tl_generator_ops ops = {.size = sizeof ops, .generate = generate};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_GENERATOR,
    .name = "polyhedron",
    .doc = "Creates one convex block from its vertices.",
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
    .id = "talus.polyhedron",
    .version = TALUS_VERSION,
    .doc = "Polyhedron generator.",
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
