/* spring.c - element "spring": a spring and a dashpot between two points, of blocks or of the ground.
 *
 * Along the line between the points, of length L now and L0 when installed, with tension positive:
 *
 *     N = N0 + k (L - L0 - s) + c dL/dt,    |N0 + k (L - L0 - s)| <= strength
 *
 * s is the plastic elongation. The spring holds (N0 + k (L - L0 - s))^2 / (2 k); yield and the dashpot make heat. The
 * points turn freely, so the spring bears no shear. */
#include <talus/kit.h>
#include <talus/version.h>

typedef struct params {
    tl_vec3 from, to;
    double stiffness, damping, pretension, strength;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_VEC3, params, from, "m", "One end: on the block that it lies in, or on the ground.",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_VEC3, params, to, "m", "The other end.", .flags = TL_PARAM_REQUIRED | TL_PARAM_PLACE),
    TL_PARAM(TL_PARAM_REAL, params, stiffness, "N/m", "Stiffness.", .flags = TL_PARAM_REQUIRED | TL_PARAM_MIN_OPEN,
             .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, damping, "N s/m", "Of the dashpot beside it.", .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, pretension, "N", "Tension when installed; below 0 it presses.", .min = -1e50,
             .max = 1e50),
    TL_PARAM(TL_PARAM_REAL, params, strength, "N", "Force at which the spring yields; without it, it never does.",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH, .max = 1e50)};

enum { AXIAL, SLIP, DAMPER };

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_WHOLE, "axial", "N", "force in spring and dashpot, tension positive"),
    TL_STATE(TL_STATE_WHOLE, "slip", "m", "plastic elongation"),
    TL_STATE(TL_STATE_WHOLE, "damper", "N", "part of the force that the dashpot bears")};

static tl_status place(const tl_element_host *host, const void *given)
{
    const params *p = given;
    const tl_vec3 way = tl_v3_sub(p->to, p->from);
    const tl_element_node nodes[] = {{host->block_at(host, p->from), p->from, {0, 0, 0}, 1},
                                     {host->block_at(host, p->to), p->to, {0, 0, 0}, 1}};
    if (!(tl_v3_norm(way) > 0))
        return host->fail(host, TL_E_ARGUMENT, "from and to are the same point (%g, %g, %g)", p->from.x, p->from.y,
                          p->from.z);
    if (nodes[0].block == 0 && nodes[1].block == 0)
        return host->fail(host, TL_E_ARGUMENT, "neither end lies in a block: from (%g, %g, %g) to (%g, %g, %g)",
                          p->from.x, p->from.y, p->from.z, p->to.x, p->to.y, p->to.z);
    if (nodes[0].block == nodes[1].block)
        host->log(host, "both ends lie in block %u, so it holds nothing", nodes[0].block);
    const double limit = isnan(p->strength) ? INFINITY : p->strength;
    if (fabs(p->pretension) > limit)
        return host->fail(host, TL_E_ARGUMENT, "pretension = %g N is above strength = %g N", p->pretension, limit);
    const double state[] = {p->pretension, 0, 0};
    return host->add(host,
                     &(tl_new_element){.size = sizeof(tl_new_element), .nodes = nodes, .count = 2, .state = state});
}

/* Element e: how long it is, less its length when installed, and along which way it pulls. */
static double elongation(const tl_element_batch *b, uint32_t e, tl_vec3 *along)
{
    const uint32_t i = b->start[e], j = i + 1;
    const tl_vec3 rest = {b->rest[0][j] - b->rest[0][i], b->rest[1][j] - b->rest[1][i], b->rest[2][j] - b->rest[2][i]};
    const tl_vec3 moved = {b->u[0][j] - b->u[0][i], b->u[1][j] - b->u[1][i], b->u[2][j] - b->u[2][i]};
    const tl_vec3 now = tl_v3_add(rest, moved);
    const double before = tl_v3_norm(rest), length = tl_v3_norm(now);
    *along = length > 0 ? tl_v3_scale(1 / length, now) : tl_v3(0, 0, 0);
    /* L^2 - L0^2 = d . (2 r + d) keeps the digits of a small d */
    return tl_v3_dot(moved, tl_v3_add(tl_v3_add(rest, rest), moved)) / (length + before);
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const params *p = self;
    const double limit = isnan(p->strength) ? INFINITY : p->strength;
    for (uint32_t e = 0; e < b->count; e++) {
        const uint32_t i = b->start[e], j = i + 1;
        double *axial = &b->element_state[AXIAL][e], *slip = &b->element_state[SLIP][e];
        double *damper = &b->element_state[DAMPER][e];
        if (b->weight[i] == 0 || b->weight[j] == 0) { /* an end has gone, and with it what was held */
            b->lost[e] = b->stored[e];
            b->stored[e] = *axial = *damper = 0;
            for (int k = 0; k < 3; k++)
                b->force[k][i] = b->force[k][j] = 0;
            continue;
        }
        tl_vec3 along;
        const double long_by = elongation(b, e, &along), trial = p->pretension + p->stiffness * (long_by - *slip);
        const double force = fmax(-limit, fmin(limit, trial)), yields = (trial - force) / p->stiffness;
        const double rate = along.x * (b->v[0][j] - b->v[0][i]) + along.y * (b->v[1][j] - b->v[1][i]) +
                            along.z * (b->v[2][j] - b->v[2][i]);
        const double drag = p->damping * rate;
        /* by the mean of the forces before and after, as the work of the bodies is booked */
        b->lost[e] = 0.5 * (*axial - *damper + force) * yields + 0.5 * (*damper + drag) * rate * b->dt;
        *slip += yields;
        *damper = drag;
        *axial = force + drag;
        b->stored[e] = 0.5 * force * force / p->stiffness;
        b->flags[e] |= yields != 0 ? (uint32_t)TL_ELEMENT_YIELDED : 0;
        const double pull[] = {along.x * *axial, along.y * *axial, along.z * *axial};
        for (int k = 0; k < 3; k++) {
            b->force[k][i] = pull[k];
            b->force[k][j] = -pull[k];
        }
    }
    return TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const params *p = self;
    for (uint32_t i = 0; i < b->start[b->count]; i++) {
        k[i] = p->stiffness;
        c[i] = p->damping;
    }
}

static const tl_element_ops ops = {
    .size = sizeof ops, .place = place, .update = update, .stiffness = stiffness, .never_fails = 1};

static const tl_kind kind = TL_KIND(TL_KIND_ELEMENT, ops, .name = "spring",
                                    .doc = "A spring and a dashpot between two points, of blocks or of the ground.",
                                    TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(13, kind, .id = "talus.spring", .version = TALUS_VERSION, .doc = "Springs and dashpots.",
                .licence = "BSD-3-Clause");
