/* joint.c - generator "joint": one plane through a point that cuts the visible blocks.
 *
 * The plane's upward normal is (sin dip sin dd, sin dip cos dd, cos dip), dd clockwise from north. Each block in its
 * path is cut with the probability `persistence`. The plane gets the next number of its joint set. */
#include <talus/kit.h>
#include <talus/version.h>
#include <talus/vmath.h>

typedef struct params {
    const char *joint;
    double dip, dip_direction;
    tl_vec3 origin;
    double persistence, radius;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, joint, "", "name of the joint set the plane belongs to",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, params, dip, "deg", "dip below horizontal", .flags = TL_PARAM_REQUIRED, .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction, "deg", "dip direction, clockwise from north (+y)",
             .flags = TL_PARAM_REQUIRED, .min = 0, .max = 360),
    TL_PARAM(TL_PARAM_VEC3, params, origin, "m", "point on the plane", .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_REAL, params, persistence, "", "probability that a block in the plane's path is cut", .def = {1},
             .min = 0, .max = 1),
    TL_PARAM_POSITIVE_OR_NONE(params, radius, "m",
                              "of a disc about the origin in the place of the plane: a block is in its path when the "
                              "disc meets its section"),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    tl_tag tag;
    tl_status status = host->joint(host, p->joint, &tag.joint);
    if (status != TL_OK)
        return status;
    tag.plane = host->next_plane(host, tag.joint);
    tl_vec3 normal = tl_plane_normal(p->dip, p->dip_direction);
    size_t met = 0;
    status = host->cut_disc(host, normal, p->origin, p->radius > 0 ? p->radius : INFINITY, tag, p->persistence, &met);
    if (status == TL_OK && met == 0)
        host->log(host, "joint '%s': its plane meets no visible block", p->joint);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(generate, .name = "joint", .doc = "Cuts the visible blocks by one plane.",
                                              TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.joint", .version = TALUS_VERSION, .doc = "Joint generator.", .licence = "BSD-3-Clause");
