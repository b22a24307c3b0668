/* wedge.c - generators "wedge" and "roof_wedge": a tetrahedron that joints and free faces part from the rock.
 *
 * A slope wedge lies above two joints A and B. Their line of intersection begins at the toe O, on the slope face,
 * and rises by u = +-(n_A x n_B) to the upper slope. It daylights when u runs into the rock at the face and out of
 * it at the upper slope: n_F . u < 0 < n_U . u. The crest c = n_F x n_U crosses A and B in the other two corners.
 *
 * A roof wedge lies below three joints. Its edges from the apex are the lines of intersection, run downward. They meet
 * a horizontal roof in a triangle whose shape is that of the orientations. Its size is given by its extent across
 * the tunnel, or by the height of the apex.
 *
 * The rock is a box about the wedge. Each joint takes what is behind it off the rest, and these parts are joined. */
#include <stdbool.h>
#include <talus/kit.h>
#include <talus/version.h>

/* Lines and planes nearer to parallel than this, rad, make no wedge: their angles are given to some digits. */
#define PARALLEL 1e-6

/* A joint: its name, its plane and the side on which the wedge is (1: along the normal, -1: against it). */
typedef struct side {
    const char *joint;
    tl_vec3 normal, point;
    int wedge;
} side;

/* ---------------------------------------------------------------- the rock --------------- */

typedef struct rock {
    double density, margin;
    const char *group, *wedge_group;
} rock;

static tl_status take_above(const tl_host *host, size_t block, tl_vec3 normal, tl_vec3 point)
{
    size_t above;
    tl_status status = host->cut_block(host, block, normal, point, &above);
    return status == TL_OK && above != SIZE_MAX ? host->remove(host, above) : status;
}

/* Cuts the only visible block by a joint, and hides what lies behind it. */
static tl_status take_behind(const tl_host *host, const side *of)
{
    tl_tag tag;
    tl_status status = host->joint(host, of->joint, &tag.joint);
    if (status != TL_OK)
        return status;
    tag.plane = host->next_plane(host, tag.joint);
    status = host->cut_disc(host, of->normal, of->point, INFINITY, tag, 1, NULL);
    if (status == TL_OK && host->block_count(host) != 2)
        status = host->fail(host, TL_E_GEOMETRY, "joint '%s' cannot cut the rock: the wedge is too thin", of->joint);
    return status == TL_OK ? host->hide(host, of->wedge > 0 ? 0 : 1) : status;
}

/* Makes the rock about the corners of a wedge, below free planes, and parts the wedge from it. */
static tl_status make(const tl_host *host, const rock *r, const tl_vec3 corner[4], const tl_half_space *free_planes,
                      size_t free_count, const side *sides, size_t count)
{
    const size_t first = host->block_count(host);
    const double m = r->margin;
    size_t behind[3];
    tl_vec3 min = corner[0], max = corner[0];
    for (size_t i = 1; i < 4; i++) {
        min = tl_v3_min(min, corner[i]);
        max = tl_v3_max(max, corner[i]);
    }
    tl_status status =
        host->create_box(host, tl_v3_sub(min, tl_v3(m, m, m)), tl_v3_add(max, tl_v3(m, m, m)), r->density, r->group);
    for (size_t i = 0; i < free_count && status == TL_OK; i++)
        status = take_above(host, first, free_planes[i].normal, free_planes[i].point);
    for (size_t i = 0; i < first && status == TL_OK; i++) /* no other block is cut */
        status = host->hide(host, 0);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        status = take_behind(host, &sides[i]);
    if (status == TL_OK)
        status = host->set_group(host, 0, r->wedge_group);
    if (status == TL_OK)
        status = host->show(host);
    /* a cut leaves the part below in its place and puts the one above last: the wedge is last or in the place of the
     * last part that was below */
    size_t parts = 0, wedge = first;
    for (size_t i = 0; i < count; i++) {
        const size_t above = first + i + 1;
        behind[parts++] = sides[i].wedge > 0 ? wedge : above;
        wedge = sides[i].wedge > 0 ? above : wedge;
    }
    return status == TL_OK ? host->join(host, behind, parts) : status;
}

static double volume_of(const tl_vec3 corner[4])
{
    const tl_vec3 a = tl_v3_sub(corner[1], corner[0]), b = tl_v3_sub(corner[2], corner[0]);
    return fabs(tl_v3_dot(tl_v3_cross(a, b), tl_v3_sub(corner[3], corner[0]))) / 6;
}

/* ---------------------------------------------------------------- a slope wedge ---------- */

typedef struct wedge {
    const char *joint_a, *joint_b;
    double dip_a, dip_direction_a, dip_b, dip_direction_b;
    double slope_dip, slope_dip_direction, upper_dip, upper_dip_direction;
    double height, margin;
    tl_vec3 origin;
    double density;
    const char *group, *rock_group;
} wedge;

#define DIP(owner, member, doc_, ...)                                                                                  \
    TL_PARAM(TL_PARAM_REAL, owner, member, "deg", doc_, .min = 0, .max = 90, __VA_ARGS__)
#define DIRECTION(owner, member, doc_, ...)                                                                            \
    TL_PARAM(TL_PARAM_REAL, owner, member, "deg", doc_, .min = 0, .max = 360, __VA_ARGS__)
#define A_JOINT(owner, letter, name)                                                                                   \
    TL_PARAM(TL_PARAM_STRING, owner, joint_##letter, "", "name of the joint " name, .def_text = name),                 \
        DIP(owner, dip_##letter, "its dip below horizontal", .flags = TL_PARAM_REQUIRED),                              \
        DIRECTION(owner, dip_direction_##letter, "its dip direction, clockwise from north (+y)",                       \
                  .flags = TL_PARAM_REQUIRED)
#define ROCK(owner)                                                                                                    \
    TL_PARAM_POSITIVE_OR_NONE(owner, margin, "m", "rock beside, behind and below the wedge; half its height"),         \
        TL_PARAM_POSITIVE(owner, density, "kg/m3", "density of wedge and rock"),                                       \
        TL_PARAM(TL_PARAM_STRING, owner, group, "", "group of the wedge", .def_text = "wedge"),                        \
        TL_PARAM(TL_PARAM_STRING, owner, rock_group, "", "group of the rock", .def_text = "rock")

static const tl_param wedge_params[] = {
    A_JOINT(wedge, a, "A"),
    A_JOINT(wedge, b, "B"),
    DIP(wedge, slope_dip, "dip of the slope face", .flags = TL_PARAM_REQUIRED),
    DIRECTION(wedge, slope_dip_direction, "dip direction of the slope face", .flags = TL_PARAM_REQUIRED),
    DIP(wedge, upper_dip, "dip of the upper slope", .def = {0}),
    DIRECTION(wedge, upper_dip_direction, "dip direction of the upper slope; that of the face",
              .flags = TL_PARAM_OPTIONAL),
    TL_PARAM_POSITIVE(wedge, height, "m", "of the crest over the toe of the wedge, up the slope from it"),
    TL_PARAM(TL_PARAM_VEC3, wedge, origin, "m", "the toe: where the joints' line of intersection daylights",
             .def = {0, 0, 0}),
    ROCK(wedge),
};

/* The toe, where the line of intersection ends behind, and where the crest crosses A and B. */
static tl_status wedge_corners(const tl_host *host, const wedge *w, const tl_half_space free_planes[2],
                               const side sides[2], tl_vec3 corner[4])
{
    const tl_vec3 face = free_planes[0].normal, upper = free_planes[1].normal;
    const tl_vec3 line = tl_v3_cross(sides[0].normal, sides[1].normal);
    if (!(tl_v3_norm(line) > PARALLEL))
        return host->fail(host, TL_E_GEOMETRY, "joints '%s' and '%s' are parallel: they make no wedge", w->joint_a,
                          w->joint_b);
    const tl_vec3 u = tl_v3_unit(line.z < 0 ? tl_v3_neg(line) : line);
    const double trend = tl_atan2(-u.x, -u.y) / TL_DEGREE,
                 plunge = tl_atan2(u.z, sqrt(u.x * u.x + u.y * u.y)) / TL_DEGREE;
    if (!(tl_v3_dot(face, u) < -PARALLEL))
        return host->fail(host, TL_E_GEOMETRY,
                          "no wedge can be removed: the joints' line of intersection plunges %.4g deg toward %.4g deg "
                          "and does not daylight in the slope face (dip %g, dip direction %g deg)",
                          plunge, trend < 0 ? trend + 360 : trend, w->slope_dip, w->slope_dip_direction);
    if (!(tl_v3_dot(upper, u) > PARALLEL))
        return host->fail(
            host, TL_E_GEOMETRY,
            "no wedge forms: the joints' line of intersection plunges %.4g deg toward %.4g deg, and going "
            "up it does not reach the upper slope (dip %g deg)",
            plunge, trend < 0 ? trend + 360 : trend, w->upper_dip);
    const tl_vec3 crest = free_planes[1].point, along = tl_v3_unit(tl_v3_cross(face, upper));
    double at[2], rise[2];
    for (int i = 0; i < 2; i++) {
        rise[i] = tl_v3_dot(sides[i].normal, along);
        at[i] = -tl_v3_dot(sides[i].normal, tl_v3_sub(crest, w->origin)) / rise[i];
    }
    /* above A and above B are the points of the crest between the two */
    if (!(fabs(rise[0]) > PARALLEL && fabs(rise[1]) > PARALLEL && rise[0] * rise[1] < 0 &&
          (rise[0] > 0 ? at[0] < at[1] : at[1] < at[0])))
        return host->fail(host, TL_E_GEOMETRY,
                          "no wedge forms: what lies above joints '%s' and '%s' at the crest is not bounded by one on "
                          "either side",
                          w->joint_a, w->joint_b);
    corner[0] = w->origin;
    corner[1] = tl_v3_madd(w->origin, tl_v3_dot(upper, tl_v3_sub(crest, w->origin)) / tl_v3_dot(upper, u), u);
    corner[2] = tl_v3_madd(crest, at[0], along);
    corner[3] = tl_v3_madd(crest, at[1], along);
    return TL_OK;
}

static tl_status generate_wedge(const tl_host *host, const void *given)
{
    const wedge *w = given;
    const double upper_direction = isnan(w->upper_dip_direction) ? w->slope_dip_direction : w->upper_dip_direction;
    const tl_vec3 face = tl_plane_normal(w->slope_dip, w->slope_dip_direction);
    const tl_vec3 upper = tl_plane_normal(w->upper_dip, upper_direction);
    /* up the face from the toe: against its dip, by height / sin dip */
    const double sine = tl_sin_degrees(w->slope_dip), cosine = tl_cos_degrees(w->slope_dip);
    const tl_vec3 up =
        tl_v3(-cosine * tl_sin_degrees(w->slope_dip_direction), -cosine * tl_cos_degrees(w->slope_dip_direction), sine);
    if (!(sine > PARALLEL && tl_v3_norm(tl_v3_cross(face, upper)) > PARALLEL && tl_v3_dot(upper, up) > 0))
        return host->fail(host, TL_E_GEOMETRY,
                          "the slope face (dip %g, dip direction %g deg) and the upper slope (dip %g, dip direction "
                          "%g deg) have no crest: the face must be the steeper one, seen down its dip",
                          w->slope_dip, w->slope_dip_direction, w->upper_dip, upper_direction);
    const tl_half_space free_planes[2] = {{face, w->origin}, {upper, tl_v3_madd(w->origin, w->height / sine, up)}};
    const side sides[2] = {{w->joint_a, tl_plane_normal(w->dip_a, w->dip_direction_a), w->origin, 1},
                           {w->joint_b, tl_plane_normal(w->dip_b, w->dip_direction_b), w->origin, 1}};
    tl_vec3 corner[4];
    tl_status status = wedge_corners(host, w, free_planes, sides, corner);
    if (status != TL_OK)
        return status;
    const rock r = {w->density, w->margin > 0 ? w->margin : 0.5 * w->height, w->rock_group, w->group};
    status = make(host, &r, corner, free_planes, 2, sides, 2);
    if (status == TL_OK)
        host->log(host, "wedge of %.6g m3, %.6g kg", volume_of(corner), w->density * volume_of(corner));
    return status;
}

/* ---------------------------------------------------------------- a roof wedge ----------- */

typedef struct roof {
    const char *joint_a, *joint_b, *joint_c;
    double dip_a, dip_direction_a, dip_b, dip_direction_b, dip_c, dip_direction_c;
    double trend, span, height, margin;
    tl_vec3 origin;
    double density;
    const char *group, *rock_group;
} roof;

static const tl_param roof_params[] = {
    A_JOINT(roof, a, "A"),
    A_JOINT(roof, b, "B"),
    A_JOINT(roof, c, "C"),
    DIRECTION(roof, trend, "of the tunnel's axis, clockwise from north (+y)", .def = {0}),
    TL_PARAM_POSITIVE(roof, span, "m", "width of the tunnel's flat roof, across its axis"),
    TL_PARAM_POSITIVE_OR_NONE(roof, height, "m", "of the apex over the roof; the largest that fits the span"),
    TL_PARAM(TL_PARAM_VEC3, roof, origin, "m", "on the roof: the wedge's middle, along and across the tunnel",
             .def = {0, 0, 0}),
    ROCK(roof),
};

/* The middle of the least and largest component of the wedge's edges along a direction; *extent is their distance. */
static double middle_along(tl_vec3 direction, const tl_vec3 edge[3], double *extent)
{
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < 3; i++) {
        least = fmin(least, tl_v3_dot(direction, edge[i]));
        most = fmax(most, tl_v3_dot(direction, edge[i]));
    }
    *extent = most - least;
    return 0.5 * (least + most);
}

/* The edges from the apex to a roof one metre below; edge i is not on joint i. */
static tl_status roof_edges(const tl_host *host, side sides[3], tl_vec3 edge[3])
{
    for (int i = 0; i < 3; i++) {
        const side *j = &sides[(i + 1) % 3], *k = &sides[(i + 2) % 3];
        const tl_vec3 line = tl_v3_cross(j->normal, k->normal);
        if (!(tl_v3_norm(line) > PARALLEL && fabs(line.z) > PARALLEL * tl_v3_norm(line)))
            return host->fail(host, TL_E_GEOMETRY,
                              "no wedge forms in the roof: joints '%s' and '%s' are parallel, or their line of "
                              "intersection is horizontal",
                              j->joint, k->joint);
        edge[i] = tl_v3_scale(-1 / line.z, line);
    }
    for (int i = 0; i < 3; i++) {
        const double off = tl_v3_dot(sides[i].normal, edge[i]) / tl_v3_norm(edge[i]);
        if (!(fabs(off) > PARALLEL))
            return host->fail(host, TL_E_GEOMETRY,
                              "no wedge forms in the roof: the three joints run along one line of intersection");
        sides[i].wedge = off > 0 ? 1 : -1;
    }
    return TL_OK;
}

static tl_status generate_roof(const tl_host *host, const void *given)
{
    const roof *r = given;
    side sides[3] = {{r->joint_a, tl_plane_normal(r->dip_a, r->dip_direction_a), {0, 0, 0}, 1},
                     {r->joint_b, tl_plane_normal(r->dip_b, r->dip_direction_b), {0, 0, 0}, 1},
                     {r->joint_c, tl_plane_normal(r->dip_c, r->dip_direction_c), {0, 0, 0}, 1}};
    tl_vec3 edge[3], corner[4];
    tl_status status = roof_edges(host, sides, edge);
    if (status != TL_OK)
        return status;
    const tl_vec3 axis = tl_v3(tl_sin_degrees(r->trend), tl_cos_degrees(r->trend), 0),
                  across = tl_v3(axis.y, -axis.x, 0);
    double width, length;
    const double beside = middle_along(across, edge, &width), along = middle_along(axis, edge, &length);
    const double largest = r->span / width, height = r->height > 0 ? r->height : largest;
    if (height > largest * (1 + PARALLEL))
        return host->fail(
            host, TL_E_ARGUMENT,
            "height = %g m: a wedge of these joints that fits the span of %g m has an apex of at most %.6g m", height,
            r->span, largest);
    corner[0] = tl_v3_madd(r->origin, -height, tl_v3_madd(tl_v3_scale(beside, across), along, axis));
    corner[0].z = r->origin.z + height;
    for (int i = 0; i < 3; i++) {
        corner[i + 1] = tl_v3_madd(corner[0], height, edge[i]);
        sides[i].point = corner[0];
    }
    const tl_half_space below = {{0, 0, -1}, r->origin};
    const rock of = {r->density, r->margin > 0 ? r->margin : 0.5 * height, r->rock_group, r->group};
    status = make(host, &of, corner, &below, 1, sides, 3);
    if (status == TL_OK)
        host->log(host, "roof wedge of %.6g m3, %.6g kg, apex %.6g m over the roof", volume_of(corner),
                  r->density * volume_of(corner), height);
    return status;
}

static const tl_kind kinds[] = {
    TL_GENERATOR_KIND(generate_wedge, .name = "wedge",
                      .doc = "Creates a slope with the wedge that two joints part from it.",
                      TL_KIND_PARAMS(wedge, wedge_params)),
    TL_GENERATOR_KIND(generate_roof, .name = "roof_wedge",
                      .doc = "Creates the rock over a tunnel's roof with the wedge that three joints part from it.",
                      TL_KIND_PARAMS(roof, roof_params)),
};

TL_PLUGIN_SINCE(1, kinds, .id = "talus.wedge", .version = TALUS_VERSION,
                .doc = "Generators of wedges in slopes and roofs.", .licence = "BSD-3-Clause");
