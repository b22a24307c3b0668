/* import_solid.c - generator "import": a block of each closed convex solid in an STL or OBJ file. */
#include "mesh.h"
#include "text.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>
#include <talus/version.h>
#include <talus/vmath.h>

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
    TL_PARAM(TL_PARAM_REAL, params, scale, "", "factor on coordinates: 0.001 for millimetres",
             .def = {1}, .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_VEC3, params, translate, "m", "added to the scaled coordinates",
             .def = {0, 0, 0}),
    TL_PARAMS_ROCK(params, "blocks"),
};

/* Whether a file's name ends in `ending`, in letters of any case. */
static bool ends_in(const char *file, const char *ending)
{
    size_t length = strlen(file), tail = strlen(ending);
    if (length < tail)
        return false;
    for (size_t i = 0; i < tail; i++)
        if (text_small(file[length - tail + i]) != ending[i])
            return false;
    return true;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    bool stl = ends_in(p->file, ".stl");
    if (!stl && !ends_in(p->file, ".obj"))
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s' does not end in .stl or .obj",
                          p->file);
    bytes data;
    tl_status status = file_read(host, p->file, &data);
    if (status != TL_OK)
        return status;
    mesh m = {.host = host, .file = p->file};
    status = stl ? stl_read(&m, &data) : obj_read(&m, &data);
    free(data.at);
    if (status == TL_OK)
        status = mesh_close(&m);
    if (status == TL_OK)
        status = solids_create(&m, p->scale, p->translate, p->density, p->group);
    mesh_free(&m);
    return status;
}

static const tl_kind kind =
    TL_GENERATOR_KIND(generate, .name = "import",
                      .doc = "Creates a block of each closed convex solid in an STL or OBJ file.",
                      TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.import_solid", .version = TALUS_VERSION,
          .doc = "Import of closed convex solids.", .licence = "BSD-3-Clause");
