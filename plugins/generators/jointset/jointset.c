/* jointset.c - generator "jointset": a set of nearly parallel planes, placed symmetrically about a
 * point, that cut the visible blocks.
 *
 * The planes are numbered from the lowest to the highest along the mean upward normal n. An odd number
 * has its middle plane through the origin, an even one its middle gap about it. Plane j passes through
 * origin + offset_j n with its own attitude:
 *
 *     dip = mean + deviation u1,  dip direction = mean + deviation u2       u uniform in [-1, 1)
 *     gap between two planes = spacing + spacing_dev u3
 *
 * A gap belongs to the plane on its far side from the middle; the middle gap of an even set to the
 * plane above. Draws are keyed by model seed, set and plane number (Hart, Cundall and Lemos, Int. J.
 * Rock Mech. Min. Sci. 25 (1988) 117-125, section on model generation, for the six parameters). */
#include <talus/plugin.h>
#include <talus/vmath.h>

/* Draws of one plane. */
enum { DRAW_DIP, DRAW_DIRECTION, DRAW_GAP };

typedef struct params {
    const char *joint;
    double dip, dip_dev, dip_direction, dip_direction_dev, spacing, spacing_dev;
    int64_t number;
    tl_vec3 origin;
    double persistence;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, joint, "", "name of the joint set",
             .flags = TL_PARAM_REQUIRED),
    TL_PARAM(TL_PARAM_REAL, params, dip, "deg", "mean dip below horizontal",
             .flags = TL_PARAM_REQUIRED, .min = 0, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_dev, "deg", "largest deviation of the dip", .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction, "deg",
             "mean dip direction, clockwise from north (+y)", .flags = TL_PARAM_REQUIRED, .min = 0,
             .max = 360),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction_dev, "deg",
             "largest deviation of the dip direction", .min = 0, .max = 180),
    TL_PARAM(TL_PARAM_REAL, params, spacing, "m", "mean distance between planes",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_REAL, params, spacing_dev, "m",
             "largest deviation of the spacing; less than the spacing", .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_INT, params, number, "", "number of planes", .def = {1}, .min = 1,
             .max = 1e4),
    TL_PARAM(TL_PARAM_VEC3, params, origin, "m", "point the planes lie symmetrically about",
             .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_REAL, params, persistence, "",
             "probability that a block in a plane's path is cut", .def = {1}, .min = 0, .max = 1),
};

/* Where the draws of this call are found: planes of an earlier call of the same set come first. */
typedef struct draws {
    const tl_host *host;
    uint32_t joint, first;
} draws;

/* Uniform in [-1, 1) for plane `index` (from 0) of this call. */
static double deviation(const draws *d, int64_t index, uint32_t draw)
{
    return 2 * d->host->random(d->host, d->joint, d->first + index, draw) - 1;
}

/* Distance of plane `index` from the origin along the mean normal. The mean part is a product, so a set
 * without deviation is placed without accumulated rounding. */
static double offset_of(const draws *d, const params *p, int64_t index)
{
    int64_t n = p->number, middle = n / 2;
    double mean = ((double)index - 0.5 * (double)(n - 1)) * p->spacing;
    if (!(p->spacing_dev > 0))
        return mean;
    double sum = n % 2 == 0 ? 0.5 * deviation(d, middle, DRAW_GAP) : 0;
    int64_t low = n % 2 == 0 ? middle - 1 : middle;
    for (int64_t i = middle + 1; i <= index; i++)
        sum += deviation(d, i, DRAW_GAP);
    for (int64_t i = low - 1; i >= index; i--)
        sum += deviation(d, i, DRAW_GAP);
    return index >= middle ? mean + p->spacing_dev * sum : mean - p->spacing_dev * sum;
}

static tl_status cut_plane(const draws *d, const params *p, tl_vec3 mean, int64_t index)
{
    tl_tag tag = {d->joint, d->first + (uint32_t)index};
    double dip = p->dip + p->dip_dev * deviation(d, index, DRAW_DIP);
    double direction =
        p->dip_direction + p->dip_direction_dev * deviation(d, index, DRAW_DIRECTION);
    tl_vec3 point = tl_v3_madd(p->origin, offset_of(d, p, index), mean);
    return d->host->cut(d->host, tl_plane_normal(dip, direction), point, tag, p->persistence);
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    if (!(p->spacing_dev < p->spacing))
        return host->fail(host, TL_E_ARGUMENT, "spacing_dev = %g m must be < spacing = %g m",
                          p->spacing_dev, p->spacing);
    draws d = {.host = host};
    tl_status status = host->joint(host, p->joint, &d.joint);
    if (status != TL_OK)
        return status;
    d.first = host->next_plane(host, d.joint);
    for (int64_t i = 1; i < p->number; i++)
        host->next_plane(host, d.joint);
    tl_vec3 mean = tl_plane_normal(p->dip, p->dip_direction);
    for (int64_t i = 0; i < p->number && status == TL_OK; i++) {
        status = cut_plane(&d, p, mean, i);
        if (status == TL_OK)
            status = host->progress(host, (double)(i + 1) / (double)p->number);
    }
    return status;
}

static const tl_generator_ops ops = {.size = sizeof ops, .generate = generate};

static const tl_kind kind = {
    .size = sizeof kind,
    .type = TL_KIND_GENERATOR,
    .name = "jointset",
    .doc = "Cuts the visible blocks by a set of nearly parallel planes.",
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
    .id = "talus.jointset",
    .version = "0.1.0",
    .doc = "Joint set generator.",
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
