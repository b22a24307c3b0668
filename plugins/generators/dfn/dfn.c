/* dfn.c - generator "dfn": a network of discs that cut the visible blocks, drawn or of a file.
 *
 * Discs are those of Baecher, Lanney and Einstein (1977). Centres are uniform in the bounds of the visible blocks grown
 * by the largest radius on every side. Orientations are drawn after Fisher, or of measured poles. Radii go by a power
 * law, are lognormal, or all the same. With n discs in the grown volume V' the expected intensity is (Dershowitz and
 * Herda 1992)
 *
 *     P32 = n / V' pi <r^2>,   m2 of discs in a m3 of rock
 *
 * With p32 discs are added one after the other until their area in the bounds reaches it, so the last one goes beyond.
 * What a disc draws hangs on the model's seed, the joint's name and the disc's number. They cut from the largest to the
 * smallest. A block is cut through when the disc reaches into its section. The summary tells, of the volume V of the
 * bounds, with A the area of a disc inside them:
 *
 *     P32 = sum A / V,   P10 = sum A |n . m| / V,   P21 = sum A |n x z| / V
 *
 * P10 is the mean number of discs on a metre of the lines along the mean pole m. P21 is the mean length of traces on a
 * m2 of horizontal planes. */
#include "discs.h"

#include <talus/version.h>

#define PI 3.141592653589793

/* Limit: standard deviations of its logarithm at which a lognormal radius ends unless size_max is given. */
#define LOGNORMAL_END 4.0

enum { POWER_LAW, LOGNORMAL, FIXED };
static const char *const sizes[] = {"power_law", "lognormal", "fixed", NULL};

typedef struct params {
    const char *joint;
    double p32;
    int64_t number;
    double dip, dip_direction, fisher_k;
    const char *poles;
    int32_t size;
    double exponent, size_mean, size_dev, size_min, size_max;
    const char *file;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, joint, "", "name of the joint set", .flags = TL_PARAM_REQUIRED),
    TL_PARAM_POSITIVE_OR_NONE(params, p32, "1/m",
                              "intensity: area of discs in a volume, m2/m3; or give number, or file"),
    TL_PARAM(TL_PARAM_INT, params, number, "", "number of discs in the bounds grown by the largest radius; 0: by p32",
             .def = {0}, .min = 0, .max = MOST_DISCS),
    TL_PARAM(TL_PARAM_REAL, params, dip, "deg", "mean dip below horizontal", .flags = TL_PARAM_OPTIONAL, .min = 0,
             .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction, "deg", "mean dip direction, clockwise from north (+y)",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = 360),
    TL_PARAM(TL_PARAM_REAL, params, fisher_k, "", "concentration of the poles about the mean; all parallel without it",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_MIN_OPEN, .min = 0, .max = 1e9),
    TL_PARAM(TL_PARAM_STRING, params, poles, "",
             "table of measured planes with the columns dip and dip_direction, in the place of dip and dip_direction",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_FILE),
    TL_PARAM(TL_PARAM_ENUM, params, size, "", "distribution of the radius", .def = {FIXED}, .choices = sizes),
    TL_PARAM_POSITIVE_OR_NONE(params, exponent, "",
                              "a of power_law: the density of radii is proportional to r^-(1 + a)"),
    TL_PARAM_POSITIVE_OR_NONE(params, size_mean, "m", "mean radius of lognormal; the radius of fixed"),
    TL_PARAM_POSITIVE_OR_NONE(params, size_dev, "m", "standard deviation of the radius of lognormal"),
    TL_PARAM_POSITIVE_OR_NONE(params, size_min, "m", "smallest radius of power_law and lognormal"),
    TL_PARAM_POSITIVE_OR_NONE(params, size_max, "m", "largest radius of power_law and lognormal"),
    TL_PARAM(TL_PARAM_STRING, params, file, "",
             "discs in the place of drawn ones: a table with x, y, z, dip, dip_direction, radius; or .fab of FracMan",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_FILE),
};

/* What is known before the first disc is drawn. */
typedef struct network {
    const tl_host *host;
    const params *p;
    uint32_t joint;
    tl_bounds box;    /* of the visible blocks */
    double volume;    /* of the box */
    double farthest;  /* the largest radius */
    double low, high; /* shares of the lognormal distribution below the ends */
    tl_lognormal lognormal;
    tl_vec3 mean;
    tl_poles poles;
    discs all;
    double area; /* of all discs in the box */
} network;

/* ---------------------------------------------------------------- what is given ---------- */

static tl_status check_sizes(const tl_host *host, const params *p)
{
    const bool power = p->size == POWER_LAW, lognormal = p->size == LOGNORMAL;
    const struct {
        const char *name;
        double value;
        bool needed, may;
    } rules[] = {{"exponent", p->exponent, power, power},
                 {"size_mean", p->size_mean, !power, !power},
                 {"size_dev", p->size_dev, lognormal, lognormal},
                 {"size_min", p->size_min, power, !(p->size == FIXED)},
                 {"size_max", p->size_max, power, !(p->size == FIXED)}};
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        if (rules[i].needed && !(rules[i].value > 0))
            return host->fail(host, TL_E_ARGUMENT, "size = '%s' needs %s", sizes[p->size], rules[i].name);
        if (!rules[i].may && rules[i].value > 0)
            return host->fail(host, TL_E_ARGUMENT, "%s = %g does not go with size = '%s': leave it out", rules[i].name,
                              rules[i].value, sizes[p->size]);
    }
    if (p->size_min > p->size_max)
        return host->fail(host, TL_E_ARGUMENT, "size_min = %g m is above size_max = %g m", p->size_min, p->size_max);
    return TL_OK;
}

static tl_status check(const tl_host *host, const params *p)
{
    const int ways = (p->p32 > 0) + (p->number > 0) + (p->file != NULL);
    if (ways != 1)
        return host->fail(host, TL_E_ARGUMENT, "give one of p32, number and file: there %s %s",
                          ways == 0 ? "is" : "are",
                          ways == 0   ? "none"
                          : ways == 2 ? "two"
                                      : "three");
    if (p->file) {
        const bool sized = p->size != FIXED || p->exponent > 0 || p->size_mean > 0 || p->size_dev > 0 ||
                           p->size_min > 0 || p->size_max > 0;
        if (p->poles || !isnan(p->dip) || !isnan(p->dip_direction) || p->fisher_k > 0 || sized)
            return host->fail(
                host, TL_E_ARGUMENT,
                "file '%.200s' has orientations and sizes: leave out dip, dip_direction, fisher_k, poles, "
                "size, exponent, size_mean, size_dev, size_min and size_max",
                p->file);
        return TL_OK;
    }
    if (p->poles && (!isnan(p->dip) || !isnan(p->dip_direction) || p->fisher_k > 0))
        return host->fail(host, TL_E_ARGUMENT,
                          "poles give the orientations: leave out dip, dip_direction and fisher_k");
    if (!p->poles && (isnan(p->dip) || isnan(p->dip_direction)))
        return host->fail(host, TL_E_ARGUMENT, "%s is missing: give dip and dip_direction, poles, or file",
                          isnan(p->dip) ? "dip" : "dip_direction");
    return check_sizes(host, p);
}

/* The range of radii. */
static tl_status prepare_sizes(network *n)
{
    const params *p = n->p;
    n->high = 1;
    n->farthest = p->size == FIXED ? p->size_mean : p->size_max;
    if (p->size != LOGNORMAL)
        return TL_OK;
    n->lognormal = tl_lognormal_of(p->size_mean, p->size_dev);
    if (!(p->size_max > 0))
        n->farthest = tl_lane_exp(n->lognormal.mean + LOGNORMAL_END * n->lognormal.dev);
    n->low = p->size_min > 0 ? tl_lognormal_below(n->lognormal, p->size_min) : 0;
    n->high = tl_lognormal_below(n->lognormal, n->farthest);
    if (n->high - n->low < TL_LEAST_SHARE)
        return n->host->fail(n->host, TL_E_ARGUMENT,
                             "fewer than 1 in 1000 radii of mean %g m and deviation %g m are in [size_min, size_max]",
                             p->size_mean, p->size_dev);
    return TL_OK;
}

static tl_status prepare_box(network *n)
{
    const size_t count = n->host->block_count(n->host);
    for (size_t i = 0; i < count; i++) {
        tl_block_info info = {.size = sizeof info};
        n->host->block_info(n->host, i, &info);
        n->box.min = i == 0 ? info.bounds.min : tl_v3_min(n->box.min, info.bounds.min);
        n->box.max = i == 0 ? info.bounds.max : tl_v3_max(n->box.max, info.bounds.max);
    }
    if (count == 0)
        return n->host->fail(n->host, TL_E_STATE, "there is no visible block: create blocks first");
    const tl_vec3 size = tl_v3_sub(n->box.max, n->box.min);
    n->volume = size.x * size.y * size.z;
    return TL_OK;
}

/* ---------------------------------------------------------------- discs ------------------ */

static double mean_square(const network *n)
{
    const params *p = n->p;
    if (p->size == POWER_LAW)
        return tl_power_law_moment(p->exponent, p->size_min, p->size_max, 2);
    if (p->size == LOGNORMAL)
        return tl_lognormal_moment(n->lognormal, fmax(p->size_min, 0), n->farthest, 2);
    return p->size_mean * p->size_mean;
}

/* More than MOST_DISCS would be needed. */
static tl_status check_number(const network *n)
{
    const tl_vec3 size = tl_v3_sub(n->box.max, n->box.min);
    const double grown = (size.x + 2 * n->farthest) * (size.y + 2 * n->farthest) * (size.z + 2 * n->farthest);
    const double expected = n->p->p32 * grown / (PI * mean_square(n));
    if (expected <= 0.5 * MOST_DISCS)
        return TL_OK;
    return n->host->fail(n->host, TL_E_ARGUMENT,
                         "p32 = %g 1/m takes some %.3g discs, more than %g: make the smallest ones larger, or the "
                         "model smaller",
                         n->p->p32, expected, 0.5 * MOST_DISCS);
}

static double draw_radius(const network *n, double u)
{
    const params *p = n->p;
    switch (p->size) {
    case POWER_LAW: return tl_power_law_quantile(p->exponent, p->size_min, p->size_max, u);
    case LOGNORMAL: return fmin(tl_lognormal_quantile(n->lognormal, tl_within(u, n->low, n->high)), n->farthest);
    default: return p->size_mean;
    }
}

/* A draw in (0, 1). */
static double draw(const network *n, uint32_t plane, uint32_t k)
{
    return fmin(n->host->random(n->host, n->joint, plane, k) + 0x1p-54, 1 - 0x1p-53);
}

/* Draws the next disc. */
static tl_status add_disc(network *n)
{
    const uint32_t plane = n->host->next_plane(n->host, n->joint);
    const double *u = (const double[]){draw(n, plane, 0), draw(n, plane, 1), draw(n, plane, 2),
                                       draw(n, plane, 3), draw(n, plane, 4), draw(n, plane, 5)};
    const tl_vec3 grown = tl_v3_sub(n->box.max, n->box.min);
    const tl_vec3 center = {n->box.min.x - n->farthest + u[0] * (grown.x + 2 * n->farthest),
                            n->box.min.y - n->farthest + u[1] * (grown.y + 2 * n->farthest),
                            n->box.min.z - n->farthest + u[2] * (grown.z + 2 * n->farthest)};
    tl_vec3 normal = n->mean;
    if (n->p->poles)
        normal = tl_poles_pick(&n->poles, u[3]);
    else if (n->p->fisher_k > 0)
        normal = tl_fisher_direction(n->mean, n->p->fisher_k, u[3], u[4]);
    tl_status status = discs_add(n->host, &n->all, center, normal, draw_radius(n, u[5]));
    if (status == TL_OK) {
        disc *made = &n->all.at[n->all.count - 1];
        made->number = plane;
        made->area = disc_area_in_box(made, &n->box);
        n->area += made->area;
    }
    return status;
}

static tl_status draw_discs(network *n)
{
    const params *p = n->p;
    tl_status status = TL_OK;
    if (p->poles)
        status = tl_poles_read(n->host, p->poles, &n->poles);
    if (status == TL_OK)
        status = prepare_sizes(n);
    if (status == TL_OK && p->p32 > 0)
        status = check_number(n);
    if (status == TL_OK)
        n->mean = p->poles ? tl_poles_mean_of(n->poles.normal, n->poles.weight, n->poles.count).mean
                           : tl_plane_normal(p->dip, p->dip_direction);
    while (status == TL_OK && n->all.count < MOST_DISCS &&
           (p->number > 0 ? n->all.count < (size_t)p->number : n->area < p->p32 * n->volume)) {
        status = add_disc(n);
        if (status == TL_OK && n->all.count % 1000 == 0)
            status = n->host->progress(n->host, 0);
    }
    return status;
}

static tl_status read_discs(network *n)
{
    tl_status status = discs_read(n->host, n->p->file, &n->all);
    for (size_t i = 0; i < n->all.count && status == TL_OK; i++) {
        disc *one = &n->all.at[i];
        one->number = n->host->next_plane(n->host, n->joint);
        one->area = disc_area_in_box(one, &n->box);
        n->area += one->area;
    }
    return status;
}

/* ---------------------------------------------------------------- cuts ------------------- */

/* The largest first; of equal ones that of the lower number. */
static int by_size(const void *left, const void *right)
{
    const disc *a = (const disc *)left, *b = (const disc *)right;
    if (a->radius != b->radius)
        return a->radius > b->radius ? -1 : 1;
    return (a->number > b->number) - (a->number < b->number);
}

static tl_status cut(network *n, size_t *inside, size_t *met)
{
    tl_status status = TL_OK;
    *inside = *met = 0;
    qsort(n->all.at, n->all.count, sizeof *n->all.at, by_size);
    for (size_t i = 0; i < n->all.count && status == TL_OK; i++) {
        const disc *d = &n->all.at[i];
        if (!(d->area > 0))
            continue;
        ++*inside;
        status = n->host->cut_disc(n->host, d->normal, d->center, d->radius, (tl_tag){n->joint, (uint32_t)d->number}, 1,
                                   met);
        if (status == TL_OK)
            status = n->host->progress(n->host, (double)(i + 1) / (double)n->all.count);
    }
    return status;
}

static tl_status tell(const network *n, size_t inside)
{
    double p10 = 0, p21 = 0;
    for (size_t i = 0; i < n->all.count; i++) {
        const disc *d = &n->all.at[i];
        p10 += d->area / n->volume * fabs(tl_v3_dot(d->normal, n->mean));
        p21 += d->area / n->volume * sqrt(d->normal.x * d->normal.x + d->normal.y * d->normal.y);
    }
    const struct {
        const char *key;
        double number;
    } notes[] = {{"discs", (double)n->all.count},
                 {"inside", (double)inside},
                 {"p32", n->area / n->volume},
                 {"p10", p10},
                 {"p21", p21}};
    tl_status status = TL_OK;
    for (size_t i = 0; i < sizeof notes / sizeof *notes && status == TL_OK; i++)
        status = n->host->note(n->host, NULL, notes[i].key, notes[i].number, NULL);
    if (status == TL_OK && n->all.polygons > 0)
        status = n->host->note(n->host, NULL, "polygons", 0, "each became the disc of its area about its centroid");
    return status;
}

/* The mean pole of discs that were not drawn about one: by their area. */
static tl_status find_mean(network *n)
{
    const size_t count = n->all.count;
    tl_vec3 *normal = (tl_vec3 *)malloc((count + 1) * sizeof *normal);
    double *weight = (double *)malloc((count + 1) * sizeof *weight);
    for (size_t i = 0; normal && weight && i < count; i++) {
        normal[i] = n->all.at[i].normal;
        weight[i] = n->all.at[i].area;
    }
    if (normal && weight)
        n->mean = tl_poles_axis(normal, weight, count);
    const bool lacks = !normal || !weight;
    free(normal);
    free(weight);
    return lacks ? n->host->fail(n->host, TL_E_MEMORY, "out of memory for %zu discs", count) : TL_OK;
}

static tl_status generate(const tl_host *host, const void *given)
{
    network n = {.host = host, .p = given};
    size_t inside = 0, met = 0;
    tl_status status = check(host, n.p);
    if (status == TL_OK)
        status = prepare_box(&n);
    if (status == TL_OK)
        status = host->joint(host, n.p->joint, &n.joint);
    if (status == TL_OK)
        status = n.p->file ? read_discs(&n) : draw_discs(&n);
    if (status == TL_OK)
        status = cut(&n, &inside, &met);
    if (status == TL_OK && n.p->file)
        status = find_mean(&n);
    if (status == TL_OK)
        status = tell(&n, inside);
    if (status == TL_OK && met == 0)
        host->log(host, "network '%s': none of its %zu discs meets a visible block", n.p->joint, n.all.count);
    tl_poles_free(&n.poles);
    free(n.all.at);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(
    generate, .name = "dfn", .doc = "Cuts the visible blocks by a network of discs, drawn or of a file.",
    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(11, kind, .id = "talus.dfn", .version = TALUS_VERSION, .doc = "Discrete fracture network generator.",
                .licence = "BSD-3-Clause");
