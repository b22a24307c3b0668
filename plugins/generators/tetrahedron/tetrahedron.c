/* tetrahedron.c - generator "tetrahedron": one block from its four corners, in any order. The host refuses
 * corners that span no volume. */
#include <talus/kit.h>
#include <talus/version.h>

#include <math.h>

enum { CORNERS = 4 };

typedef struct params {
    tl_points vertices;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, vertices, "m", "the four corners, in any order", .flags = TL_PARAM_REQUIRED),
    TL_PARAMS_ROCK(params, "block"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    if (p->vertices.count != CORNERS)
        return host->fail(host, TL_E_ARGUMENT, "vertices: %zu points, but a tetrahedron has %d", p->vertices.count,
                          CORNERS);
    return host->create_hull(host, p->vertices.at, CORNERS, p->density, p->group);
}

static const tl_kind kind =
    TL_GENERATOR_KIND(generate, .name = "tetrahedron", .doc = "Creates one block from its four corners.",
                      TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.tetrahedron", .version = TALUS_VERSION, .doc = "Tetrahedron generator.",
          .licence = "BSD-3-Clause");
