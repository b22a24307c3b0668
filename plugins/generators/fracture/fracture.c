/* fracture.c - generator "fracture": a convex polygon in space that cuts the visible blocks in its path.
 *
 * A block is in its path when the polygon reaches into the polygon in which its plane cuts the block. It is cut
 * through, with the probability `persistence`. The polygon gets the next number of its joint set. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    const char *joint;
    tl_points vertices;
    double persistence;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, joint, "", "name of the joint set the fracture belongs to",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_POINTS, params, vertices, "m", "corners of a convex polygon in one plane, in order around it",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, params, persistence, "", "probability that a block in the fracture's path is cut",
             .def = {1}, .min = 0, .max = 1),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    tl_tag tag;
    tl_status status = host->joint(host, p->joint, &tag.joint);
    if (status != TL_OK)
        return status;
    tag.plane = host->next_plane(host, tag.joint);
    size_t met = 0;
    status = host->cut_polygon(host, p->vertices.at, p->vertices.count, tag, p->persistence, &met);
    if (status == TL_OK && met == 0)
        host->log(host, "fracture of joint '%s': it meets no visible block", p->joint);
    return status;
}

static const tl_kind kind =
    TL_GENERATOR_KIND(generate, .name = "fracture", .doc = "Cuts the visible blocks in the path of a convex polygon.",
                      TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(11, kind, .id = "talus.fracture", .version = TALUS_VERSION, .doc = "Fracture generator.",
                .licence = "BSD-3-Clause");
