/* import_solid.c - generator "import": a block of each closed convex solid in an STL or OBJ file. */
#include "mesh.h"

#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    const char *file;
    double scale;
    tl_vec3 translate;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, file, "", "file of solids, ending in .stl or .obj",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_FILE),
    TL_PARAM(TL_PARAM_REAL, params, scale, "", "factor on coordinates: 0.001 for millimetres", .def = {1},
             .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_VEC3, params, translate, "m", "added to the scaled coordinates", .def = {0, 0, 0}),
    TL_PARAMS_ROCK(params, "blocks"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    mesh m = {.host = host, .file = p->file};
    tl_status status = mesh_read(&m);
    if (status == TL_OK)
        status = mesh_close(&m);
    if (status == TL_OK)
        status = solids_create(&m, p->scale, p->translate, p->density, p->group);
    mesh_free(&m);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(
    generate, .name = "import", .doc = "Creates a block of each closed convex solid in an STL or OBJ file.",
    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.import_solid", .version = TALUS_VERSION, .doc = "Import of closed convex solids.",
          .licence = "BSD-3-Clause");
