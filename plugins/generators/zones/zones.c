/* zones.c - generator "zones": a block of each convex region of a mesh of tetrahedra. The host reads the mesh, and
 * refuses regions that are not convex. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    const char *file;
    double density;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, file, "", "mesh of tetrahedra, legacy VTK or gmsh 2.2",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_FILE),
    TL_PARAM_POSITIVE(params, density, "kg/m3", "density of the blocks"),
    TL_PARAM(TL_PARAM_STRING, params, group, "", "group of blocks whose regions have no name in the file",
             .def_text = "rock"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    const tl_mesh_part *parts;
    size_t count;
    tl_status status = host->read_mesh(host, p->file, &parts, &count);
    for (size_t k = 0; k < count && status == TL_OK; k++) {
        const char *group = parts[k].group[0] ? parts[k].group : p->group;
        status = host->create_hull(host, parts[k].corners, parts[k].corner_count, p->density, group);
        if (status == TL_OK)
            status = host->progress(host, (double)(k + 1) / (double)count);
    }
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(generate, .name = "zones",
                                              .doc = "Creates a block of each convex region of a mesh of tetrahedra.",
                                              TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.zones", .version = TALUS_VERSION, .doc = "Blocks of meshes.",
                .licence = "BSD-3-Clause");
