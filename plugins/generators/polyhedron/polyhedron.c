/* make.c - generator "polyhedron": one block, the convex hull of its vertices. The host refuses
 * vertices that span no volume, and a vertex that is no corner of the hull because it lies inside. */
#include <talus/kit.h>
#include <talus/version.h>

#include <math.h>

typedef struct params {
    tl_points vertices;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, vertices, "m", "corners of the block, in any order", .flags = TL_PARAM_REQUIRED),
    TL_PARAMS_ROCK(params, "block"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    return host->create_hull(host, p->vertices.at, p->vertices.count, p->density, p->group);
}

static const tl_kind kind =
    TL_GENERATOR_KIND(generate, .name = "polyhedron", .doc = "Creates one convex block from its vertices.",
                      TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.polyhedron", .version = TALUS_VERSION, .doc = "Polyhedron generator.",
          .licence = "BSD-3-Clause");
