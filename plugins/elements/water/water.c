/* water.c - element "water": water presses on the walls of joints.
 *
 * An element is the polygon in which a face of one block faces one of another, a wet joint. With the pressure p at a
 * place, each wall of area A and outward normal n bears
 *
 *     f = -int p n dA
 *
 * whether its points touch or not. So water knows nothing of contacts, and laws see the effective forces that are left.
 * Sources: a table gives p = factor unit_weight h, h the vertical depth below it and 0 above; `uniform` the same p
 * everywhere; `field` a number for each node. A polygon that a table crosses is cut there, so p is linear on it.
 *
 * Three points of weight A / 3 integrate p n and its moments exactly. Let c be the centroid of the polygon and C its
 * second moments per area. The points are x = c + sqrt(2) L y for L L^t = C and three unit vectors y at 120 degrees. Of
 * any convex polygon they lie inside.
 *
 * A joint keeps its water until its mean opening passes `drain_gap`; then it is dry and stays so. What water does on
 * blocks comes from outside. */
#include "flow.h"
#include "joints.h"

#include <talus/version.h>

enum { TABLE, UNIFORM, FIELD, NONE };

static const char *const sources[] = {"table", "uniform", "field", "none", NULL};

typedef struct params {
    int32_t source;
    double level, dip, dip_direction;
    tl_vec3 origin;
    double unit_weight, factor, pressure, drain_gap;
    const char *joints;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, source, "", "Where the pressure comes from.", .choices = sources,
             .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, params, level, "m", "Of a level table: its height z.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, params, dip, "deg", "Of a table that dips.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE | TL_PARAM_MAX_OPEN, .max = 90),
    TL_PARAM(TL_PARAM_REAL, params, dip_direction, "deg", "Of a table that dips.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE, .min = -360, .max = 360),
    TL_PARAM(TL_PARAM_VEC3, params, origin, "m", "A point of a table that dips.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, params, unit_weight, "N/m3", "Of the water under a table.", .def = {9810.0},
             .flags = TL_PARAM_MIN_OPEN, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, factor, "", "Of the pressure under a table: the part that is not drained.",
             .def = {1.0}, .max = 1e6),
    TL_PARAM(TL_PARAM_REAL, params, pressure, "Pa", "Uniform pressure.", .flags = TL_PARAM_OPTIONAL, .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, drain_gap, "m", "Mean opening beyond which a joint is dry.", .def = {0.05},
             .flags = TL_PARAM_MIN_OPEN | TL_PARAM_PLACE, .max = 1e50),
    TL_PARAM(TL_PARAM_STRING, params, joints, "", "Joints, sets or planes of them, separated by commas.",
             .def_text = "*", .flags = TL_PARAM_PLACE)};

enum { PRESSURE, SOURCE };   /* of a node */
enum { AREA, OPENING, DRY }; /* of the whole */

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "pressure", "Pa", "that acts at the node"),
    TL_STATE(TL_STATE_SCALAR, "source", "Pa", "of a field: that was given for the node"),
    TL_STATE(TL_STATE_WHOLE, "area", "m2", "of the wet polygon"),
    TL_STATE(TL_STATE_WHOLE, "opening", "m", "mean distance of the walls at the nodes"),
    TL_STATE(TL_STATE_WHOLE, "dry", "", "1: it has run dry")};

/* ---------------------------------------------------------------- the table -------------- */

/* The plane of a table: upward normal, and a point. */
typedef struct table {
    tl_vec3 normal, origin;
} table;

static table table_of(const params *p)
{
    if (!isnan(p->level))
        return (table){{0, 0, 1}, {0, 0, p->level}};
    const double dip = p->dip * TL_DEGREE, way = p->dip_direction * TL_DEGREE;
    return (table){{tl_sin(dip) * tl_sin(way), tl_sin(dip) * tl_cos(way), tl_cos(dip)}, p->origin};
}

/* Vertical depth of a point below it, m. */
static double depth_of(const table *t, tl_vec3 x)
{
    return tl_v3_dot(t->normal, tl_v3_sub(t->origin, x)) / t->normal.z;
}

/* ---------------------------------------------------------------- polygons --------------- */

static void put_between(joint_polygon *to, const joint_polygon *p, size_t i, size_t j, double part)
{
    for (int k = 0; k < 2; k++)
        to->at[k][to->count] = tl_v3_madd(p->at[k][i], part, tl_v3_sub(p->at[k][j], p->at[k][i]));
    to->count++;
}

/* What lies below a table. */
static void cut(const joint_polygon *p, const table *t, joint_polygon *wet)
{
    wet->count = 0;
    for (size_t i = 0; i < p->count; i++) {
        const size_t j = i + 1 < p->count ? i + 1 : 0;
        const double h = depth_of(t, joint_middle(p, i)), g = depth_of(t, joint_middle(p, j));
        if (h > 0)
            put_between(wet, p, i, j, 0);
        if ((h > 0) != (g > 0))
            put_between(wet, p, i, j, h / (h - g));
    }
}

/* ---------------------------------------------------------------- placing ---------------- */

static tl_status place_wall(const tl_element_host *host, const params *p, const tl_element_wall *w, uint32_t which)
{
    joint_polygon all, wet;
    all.count = w->corner_count;
    if (all.count >= MOST_CORNERS)
        return host->fail(host, TL_E_ARGUMENT,
                          "blocks %u and %u face each other in a polygon of %zu corners: at most %d", w->block[0],
                          w->block[1], w->corner_count, MOST_CORNERS - 1);
    for (int k = 0; k < 2; k++)
        memcpy(all.at[k], w->corners[k], all.count * sizeof **all.at);
    const joint_polygon *of = &all;
    if (p->source == TABLE) {
        const table t = table_of(p);
        cut(&all, &t, &wet);
        of = wet.count >= 3 ? &wet : &all;
    }
    const bool above = p->source == NONE || (p->source == TABLE && wet.count < 3);
    const tl_vec3 n = tl_v3_unit(tl_v3_sub(w->normal[0], w->normal[1]));
    const joint_moments m = joint_moments_of(of, n);
    const int points = above || p->source == UNIFORM ? 1 : 3;
    tl_element_node nodes[6];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < points; i++) {
            static const double y[3][2] = {{1, 0}, {-0.5, 0.86602540378443864676}, {-0.5, -0.86602540378443864676}};
            const double far = points == 3 ? sqrt(2) : 0;
            const tl_vec3 x = tl_v3_madd(tl_v3_madd(m.centroid, far * y[i][0], m.a), far * y[i][1], m.b);
            nodes[points * k + i] = (tl_element_node){w->block[k], joint_on_wall(w, k, n, x), w->normal[k],
                                                      above ? 0 : m.area / fabs(tl_v3_dot(n, w->normal[k])) / points};
        }
    const double state[] = {above ? 0 : m.area, w->opening, w->opening > p->drain_gap};
    return host->add(host, &(tl_new_element){.size = sizeof(tl_new_element),
                                             .nodes = nodes,
                                             .count = 2 * (size_t)points,
                                             .state = state,
                                             .key = joint_key(w, which)});
}

/* Refuses what does not make a source. */
static tl_status check(const tl_element_host *host, const params *p)
{
    const bool dips = !isnan(p->dip) || !isnan(p->dip_direction) || !isnan(p->origin.x);
    const bool whole = !isnan(p->dip) && !isnan(p->dip_direction) && !isnan(p->origin.x);
    if (p->source == TABLE && isnan(p->level) && !whole)
        return host->fail(host, TL_E_ARGUMENT, "a table needs level, or dip, dip_direction and origin");
    if (p->source == TABLE && !isnan(p->level) && dips)
        return host->fail(host, TL_E_ARGUMENT, "give a table level, or dip, dip_direction and origin, not both");
    if (p->source != TABLE && (!isnan(p->level) || dips))
        return host->fail(host, TL_E_ARGUMENT,
                          "level, dip, dip_direction and origin are of a table: leave them out of source '%s'",
                          sources[p->source]);
    if (p->source != UNIFORM && !isnan(p->pressure))
        return host->fail(host, TL_E_ARGUMENT, "pressure is of a uniform source: leave it out of source '%s'",
                          sources[p->source]);
    if (p->joints[0] == '\0')
        return host->fail(host, TL_E_ARGUMENT, "joints = '' names none: name joints, or leave it out for all");
    if (p->source == UNIFORM && isnan(p->pressure))
        return host->fail(host, TL_E_ARGUMENT, "a uniform source needs pressure, Pa");
    return TL_OK;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const params *p = given;
    const tl_wall_filter filter = {sizeof filter, p->joints, p->drain_gap * FORGOTTEN, MOST_TILT};
    const tl_element_wall *walls;
    size_t count, placed = 0;
    tl_status status = check(host, p);
    if (status == TL_OK)
        status = host->walls(host, &filter, &walls, &count);
    for (size_t i = 0, which = 0; status == TL_OK && i < count; i++) {
        const tl_element_wall *w = &walls[i];
        which = i && joint_same_faces(w - 1, w) ? which + 1 : 0;
        if (!host->again && w->opening > p->drain_gap)
            continue;
        status = place_wall(host, p, w, (uint32_t)which);
        placed++;
    }
    if (status == TL_OK && placed == 0 && !host->again)
        return host->fail(host, TL_E_NOT_FOUND,
                          "no joint of '%s' has water: no two blocks face each other there within drain_gap = %g m",
                          p->joints, p->drain_gap);
    return status;
}

/* ---------------------------------------------------------------- acting ----------------- */

/* The pressure at a node, from the present place. */
static double pressure_at(const params *p, const table *t, const tl_element_batch *b, uint32_t i)
{
    switch (p->source) {
    case UNIFORM: return p->pressure;
    case FIELD: return b->state[SOURCE][i];
    case TABLE: {
        const tl_vec3 x = {b->rest[0][i] + b->u[0][i], b->rest[1][i] + b->u[1][i], b->rest[2][i] + b->u[2][i]};
        return fmax(0, p->factor * p->unit_weight * depth_of(t, x));
    }
    default: return 0;
    }
}

/* Mean distance of the walls of element e, along the normal of the first one. */
static double opening_of(const tl_element_batch *b, uint32_t e)
{
    const uint32_t first = b->start[e], half = (b->start[e + 1] - first) / 2;
    double sum = 0;
    for (uint32_t i = first; i < first + half; i++)
        for (int k = 0; k < 3; k++)
            sum += b->normal[k][i] * ((b->rest[k][i + half] - b->rest[k][i]) + (b->u[k][i + half] - b->u[k][i]));
    return sum / half;
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const params *p = self;
    table t = table_of(p);
    t.origin = tl_v3_sub(t.origin, b->origin);
    for (uint32_t e = 0; e < b->count; e++) {
        double given = 0;
        b->element_state[OPENING][e] = opening_of(b, e);
        if (b->element_state[OPENING][e] > p->drain_gap)
            b->element_state[DRY][e] = 1;
        const bool dry = b->element_state[DRY][e] != 0;
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++) {
            const double pressure = dry || b->weight[i] == 0 ? 0 : pressure_at(p, &t, b, i);
            b->state[PRESSURE][i] = pressure;
            for (int k = 0; k < 3; k++) {
                const double force = -pressure * b->weight[i] * b->normal[k][i];
                given += 0.5 * (b->force[k][i] + force) * b->du[k][i];
                b->force[k][i] = force;
            }
        }
        b->given[e] = given;
    }
    return TL_OK;
}

/* Under a table a wall that goes deeper is pressed more. */
static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const params *p = self;
    (void)c;
    for (uint32_t i = 0; p->source == TABLE && i < b->start[b->count]; i++)
        k[i] = p->factor * p->unit_weight * b->weight[i];
}

static const tl_element_ops ops = {.size = sizeof ops,
                                   .place = place,
                                   .update = update,
                                   .stiffness = stiffness,
                                   .never_fails = 1,
                                   .lays_again = 1,
                                   .steady = 1};

static const tl_kind kinds[] = {
    TL_KIND(TL_KIND_ELEMENT, ops, .name = "water", .doc = "Water that presses on the walls of joints: model:water.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table)),
    TL_KIND(TL_KIND_ELEMENT, flow_ops, .name = "flow", .doc = "Water that flows in joints: model:water(\"flow\").",
            TL_KIND_PARAMS(flow_params, flow_param_table), TL_KIND_STATES(flow_state_table))};

TL_PLUGIN_SINCE(15, kinds, .id = "talus.water", .version = TALUS_VERSION, .doc = "Water in joints.",
                .licence = "BSD-3-Clause");
