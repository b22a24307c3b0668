/* my_element.c - element "my_element": a bar between two points, which bears tension and compression.
 *
 *     N = pretension + stiffness (L - L0),    U = N^2 / (2 stiffness)
 *
 * with the distance L of the points and L0 when installed. Change place() for where the nodes are, update() for what
 * acts between them, and stiffness() for how stiff that is at the most. */
#include <talus/kit.h>

typedef struct params {
    tl_vec3 from, to;
    double stiffness, pretension;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_VEC3, params, from, "m", "One end: on the block that it lies in, or on the ground.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_VEC3, params, to, "m", "The other end.", .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, params, stiffness, "N/m", "Stiffness.", .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN,
             .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, pretension, "N", "Tension when installed.", .min = -1e50, .max = 1e50)};

/* States of the whole have TL_STATE_WHOLE, those of each node TL_STATE_SCALAR; both in the order declared. */
enum { AXIAL };
static const tl_state state_table[] = {TL_STATE(TL_STATE_WHOLE, "axial", "N", "tension; below 0 it is pressed")};

static tl_status place(const tl_element_host *host, const void *given)
{
    const params *p = given;
    const tl_element_node nodes[] = {{host->block_at(host, p->from), p->from, {0, 0, 0}, 1},
                                     {host->block_at(host, p->to), p->to, {0, 0, 0}, 1}};
    if (nodes[0].block == nodes[1].block)
        return host->fail(host, TL_E_ARGUMENT, "both ends lie in block %u, so it would hold nothing", nodes[0].block);
    return host->add(host, &(tl_new_element){.size = sizeof(tl_new_element), .nodes = nodes, .count = 2});
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    const params *p = self;
    (void)report;
    for (uint32_t e = 0; e < b->count; e++) {
        const uint32_t i = b->start[e], j = i + 1;
        const tl_vec3 rest = {b->rest[0][j] - b->rest[0][i], b->rest[1][j] - b->rest[1][i],
                              b->rest[2][j] - b->rest[2][i]};
        const tl_vec3 moved = {b->u[0][j] - b->u[0][i], b->u[1][j] - b->u[1][i], b->u[2][j] - b->u[2][i]};
        const tl_vec3 now = tl_v3_add(rest, moved);
        const double before = tl_v3_norm(rest), length = tl_v3_norm(now);
        /* L - L0 from their squares keeps the digits of small motions */
        const double longer = tl_v3_dot(moved, tl_v3_add(tl_v3_add(rest, rest), moved)) / (length + before);
        /* weight is 0 where the block of a node has been deleted */
        const double holds = b->weight[i] > 0 && b->weight[j] > 0 ? 1 : 0;
        const double tension = holds * (p->pretension + p->stiffness * longer);
        const double pull[] = {tension * now.x / length, tension * now.y / length, tension * now.z / length};
        for (int k = 0; k < 3; k++) {
            b->force[k][i] = pull[k];
            b->force[k][j] = -pull[k];
        }
        b->element_state[AXIAL][e] = tension;
        b->stored[e] = 0.5 * tension * tension / p->stiffness;
    }
    return TL_OK;
}

/* Bounds for the time step, of each node. */
static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    (void)c;
    for (uint32_t i = 0; i < b->start[b->count]; i++)
        k[i] = ((const params *)self)->stiffness;
}

static const tl_element_ops ops = {
    .size = sizeof ops, .place = place, .update = update, .stiffness = stiffness, .never_fails = 1};

static const tl_kind kind = TL_KIND(TL_KIND_ELEMENT, ops, .name = "my_element", .doc = "A bar between two points.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(13, kind, .id = "example.my_element", .version = "1.0", .doc = "A bar.", .licence = "BSD-3-Clause");
