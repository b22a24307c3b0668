/* bolt.c - elements "bolt" and "anchor": a grouted steel bar with a plate, across joints.
 *
 * The bolt has no mass. With the axial displacement w of the steel, r of the rock and s, slip of the grout:
 *
 *     E A w'' = t,    t = kg (w - r - s),    |t| <= bond strength,    N = E A (w' - plastic strain),    |N| <= yield
 *
 * t is the force of the steel on the rock for each metre and N the tension. Nodes lie in the rock. The steel between
 * two of them is a spring E A / h. The grout at a node is a spring for the length that the node stands for. chain.c
 * finds w in each step. Source: St John & Van Dillen 1983.
 *
 * The plate is a spring at the first node that presses only. A pretension pulls the mouth against the plate, after the
 * grout has set.
 *
 * Two nodes that follow each other in different bodies are a crossing. The mean of the directions of both sides is its
 * axis a, and g the way between the nodes. The sides have parted by o = g.a - void and slid by d = g - (g.a) a. Over
 * the active length l (and the void) the steel is straight, so the rock gets longer there by
 *
 *     e = |(l + o) a + d| - l
 *
 * and turns the tension. The dowel bears q = k |d| against d. k is ks until ks |d| is the strength, and then
 * strength / (largest |d|), as the grout is crushed. Beyond the rupture displacement k is 0. Source: Lorig 1985.
 *
 * Forces on nodes are the gradient of the energy in their places, with the axes. So forces and moments add up to zero,
 * and turning with the rock costs nothing. Within a body the line of the bolt is that of its nodes. */
#include "chain.h"

#include <talus/kit.h>
#include <talus/version.h>

/* Tolerance: over how far two nodes have moved apart, an elongation that rounding explains. Test: `talus check`. */
#define NOISE 2e-15
/* Constant: over the diameter, the length of steel in a crossing without a void. */
#define SHORT 1e-3
/* Constant: over the diameter, the active length where none is given. */
#define ACTIVE 2.0
/* Constant: strain of steel up to which stiffness() counts the tension of a bolt that never yields. */
#define MOST_STRAIN 0.01

typedef struct params {
    tl_vec3 from, to;
    double diameter, young, yield, rupture_strain, grout_stiffness, grout_strength, grout_residual, grout_friction;
    double confining, grouted_from, grouted_to, plate_stiffness, plate_strength, pretension, dowel_stiffness;
    double dowel_strength, dowel_rupture, active_length, spacing;
} params;

/* Limit: of forces, N, and of forces for each metre; what is larger is a mistake of units. */
#define MOST 1e12
/* Limit: of stiffness, N/m and N/m2, for the same reason. */
#define STIFFEST 1e14
/* Limit: of lengths, in any unit. */
#define LONGEST 1e9
#define ABOVE TL_PARAM_MIN_OPEN
#define PLACED TL_PARAM_PLACE
/* Rows of reals: `more` are flags. */
#define REAL(member, unit, doc, least, most, more, ...)                                                                \
    TL_PARAM(TL_PARAM_REAL, params, member, unit, doc, .min = (least), .max = (most), .flags = (more), __VA_ARGS__)
#define STRONG(member, unit, doc, least, more, ...)                                                                    \
    REAL(member, unit, doc, least, MOST, TL_PARAM_STRENGTH | (more), __VA_ARGS__)
#define BOLT_PARAMS(begin)                                                                                             \
    {                                                                                                                  \
        TL_PARAM(TL_PARAM_VEC3, params, from, "m", "The mouth, where the plate is.",                                   \
                 .flags = TL_PARAM_REQUIRED | PLACED),                                                                 \
            TL_PARAM(TL_PARAM_VEC3, params, to, "m", "The far end.", .flags = TL_PARAM_REQUIRED | PLACED),             \
            REAL(diameter, "m", "Of the steel.", 0, LONGEST, ABOVE, .def = {0.025}),                                   \
            REAL(young, "Pa", "Young's modulus of the steel.", 0, STIFFEST, ABOVE, .def = {200e9}),                    \
            STRONG(yield, "N", "Tension and compression at which the steel yields.", 0, ABOVE, .def = {2.4e5}),        \
            REAL(rupture_strain, "", "Strain at which the steel breaks.", 1e-4, 1e6, 0, .def = {0.1}),                 \
            REAL(grout_stiffness, "N/m2", "Of the grout in shear, for each metre.", 0, STIFFEST, ABOVE, .def = {1e9}), \
            STRONG(grout_strength, "N/m", "Bond of the grout for each metre.", 0, 0, .def = {4e5}),                    \
            STRONG(grout_residual, "N/m", "What is left of the bond where it has slipped; without it, all.", 0,        \
                   TL_PARAM_OPTIONAL, .alias = NULL),                                                                  \
            REAL(grout_friction, "deg", "Of the bond under the confining pressure.", 0, 90,                            \
                 TL_PARAM_STRENGTH_ANGLE | TL_PARAM_MAX_OPEN, .alias = NULL),                                          \
            REAL(confining, "Pa", "Pressure on the bar, for the friction of the bond.", 0, MOST, 0, .alias = NULL),    \
            REAL(grouted_from, "", "Part of the length where the grout begins.", 0, 1, PLACED, .def = {begin}),        \
            REAL(grouted_to, "", "Part of the length where the grout ends.", 0, 1, PLACED, .def = {1}),                \
            REAL(plate_stiffness, "N/m", "Of the plate at the mouth; 0: there is none.", 0, STIFFEST, 0,               \
                 .def = {5e7}),                                                                                        \
            STRONG(plate_strength, "N", "Force at which the plate yields.", 0, 0, .def = {2e5}),                       \
            REAL(pretension, "N", "Pull at the mouth against the plate when installed.", 0, MOST, PLACED,              \
                 .alias = NULL),                                                                                       \
            REAL(dowel_stiffness, "N/m", "Of the dowel at each joint, across the bolt.", 0, STIFFEST, 0,               \
                 .alias = NULL),                                                                                       \
            STRONG(dowel_strength, "N", "Force that the dowel bears at most.", 0, 0, .alias = NULL),                   \
            REAL(dowel_rupture, "m", "Displacement across the bolt that cuts the dowel.", 0, LONGEST, ABOVE,           \
                 .def = {0.05}),                                                                                       \
            REAL(active_length, "m", "Length that turns where a joint shears; without it, two diameters.", 0, LONGEST, \
                 ABOVE | TL_PARAM_OPTIONAL, .alias = NULL),                                                            \
            REAL(spacing, "m", "Of the nodes, at most.", 0, LONGEST, ABOVE | PLACED, .def = {0.1})                     \
    }

static const tl_param bolt_params[] = BOLT_PARAMS(0);
static const tl_param anchor_params[] = BOLT_PARAMS(0.8);

enum { /* of a node */
       TENSION,
       GROUT,
       GROUT_SLIP,
       STEEL,
       ROCK,
       PLASTIC,
       GROUTED,
       CROSSES,
       DOWEL,
       DOWEL_PEAK,
       WORN,
       CUT,
       NODE_STATES
};
enum { AXIAL, SLIP, SHEAR, PLATE, SEAT, SLIPPED, BREAKS, WHOLE_STATES }; /* of the whole */

static const tl_state state_table[] = {
    TL_STATE(TL_STATE_SCALAR, "tension", "N", "in the steel from here to the next node"),
    TL_STATE(TL_STATE_SCALAR, "grout", "N", "force of the steel on the rock by the grout, towards the far end"),
    TL_STATE(TL_STATE_SCALAR, "grout_slip", "m", "slip of the grout"),
    TL_STATE(TL_STATE_SCALAR, "steel", "m", "displacement of the steel along the bolt"),
    TL_STATE(TL_STATE_SCALAR, "rock", "m", "displacement of the rock along the bolt"),
    TL_STATE(TL_STATE_SCALAR, "plastic", "m", "plastic elongation of the steel from here to the next node"),
    TL_STATE(TL_STATE_SCALAR, "grouted", "m", "length of grout that the node stands for"),
    TL_STATE(TL_STATE_SCALAR, "crosses", "", "1: a joint or a void lies between here and the next node"),
    TL_STATE(TL_STATE_SCALAR, "dowel", "N", "force across the bolt at that joint"),
    TL_STATE(TL_STATE_SCALAR, "dowel_peak", "m", "largest displacement across the bolt at that joint so far"),
    TL_STATE(TL_STATE_SCALAR, "worn", "", "1: the grout has slipped, so it bears its residual bond"),
    TL_STATE(TL_STATE_SCALAR, "cut", "", "1: the steel is broken between here and the next node"),
    TL_STATE(TL_STATE_WHOLE, "axial", "N", "largest tension, of either sign"),
    TL_STATE(TL_STATE_WHOLE, "slip", "m", "largest slip of the grout, of either sign"),
    TL_STATE(TL_STATE_WHOLE, "shear", "N", "largest force of a dowel"),
    TL_STATE(TL_STATE_WHOLE, "plate", "N", "force of the plate on the rock"),
    TL_STATE(TL_STATE_WHOLE, "seat", "m", "displacement of the mouth at which the plate bears nothing"),
    TL_STATE(TL_STATE_WHOLE, "slipped", "m", "length of the grout that has slipped"),
    TL_STATE(TL_STATE_WHOLE, "breaks", "", "places where steel is broken or a dowel is cut")};

/* ---------------------------------------------------------------- the bolt --------------- */

/* What follows from the parameters. */
typedef struct steel {
    double ea, active, bond, residual; /* N, m, N/m, N/m */
} steel;

static steel steel_of(const params *p)
{
    const double d = p->diameter, pi = 180 * TL_DEGREE, angle = p->grout_friction * TL_DEGREE;
    const double friction = pi * d * p->confining * (tl_sin(angle) / tl_cos(angle));
    return (steel){.ea = p->young * 0.25 * pi * d * d,
                   .active = isnan(p->active_length) ? ACTIVE * d : p->active_length,
                   .bond = p->grout_strength + friction,
                   .residual = (isnan(p->grout_residual) ? p->grout_strength : p->grout_residual) + friction};
}

/* Grout of `length` at node k that has not slipped. */
static void put_grout(chain *c, uint32_t k, const params *p, const steel *s, double length)
{
    c->hold[k] = p->grout_stiffness * length;
    c->bond[k] = s->bond * length;
    c->residual[k] = s->residual * length;
    c->bears[k] = c->bond[k];
}

/* Steel of the length h from node k on, whose strain counts over `gauge`. */
static void put_steel(chain *c, uint32_t k, const params *p, const steel *s, double h, double gauge)
{
    c->stiff[k] = s->ea / larger(h, SHORT * p->diameter);
    c->gauge[k] = gauge;
    c->limit[k] = p->yield;
}

/* ---------------------------------------------------------------- placing ---------------- */

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    if (!isnan(p->grout_residual) && p->grout_residual > p->grout_strength)
        return tl_refuse(report, "grout_residual = %g N/m is above grout_strength = %g N/m", p->grout_residual,
                         p->grout_strength);
    if (!(p->grouted_from < p->grouted_to))
        return tl_refuse(report, "grouted_from = %g must be below grouted_to = %g", p->grouted_from, p->grouted_to);
    return tl_keep(p, sizeof *p, self, report);
}

static double distance(tl_vec3 a, tl_vec3 b)
{
    return tl_v3_norm(tl_v3_sub(a, b));
}

/* Keeps the nodes of the ways through bodies that are at least as long as a diameter; `passes` becomes 1 where a joint
 * or a void follows. Gives how many, at most one more than an element may have. */
static size_t keep_ways(tl_line_node *to, const tl_line_node *line, size_t count, double least)
{
    size_t kept = 0;
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && !line[end].passes;)
            end++;
        end += end < count;
        for (size_t i = first; i < end && line[end - 1].at - line[first].at >= least; i++) {
            if (kept == TL_ELEMENT_NODES)
                return kept + 1;
            to[kept] = line[i];
            to[kept++].passes = i + 1 == end;
        }
    }
    if (kept > 0)
        to[kept - 1].passes = 0;
    return kept;
}

/* Says what a bolt cannot do. */
static void warn(const tl_element_host *host, const params *p, const tl_line_node *at, size_t count)
{
    double empty = 0;
    size_t crossings = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double gap = at[i + 1].at - at[i].at;
        crossings += at[i].passes;
        empty += at[i].passes && gap > p->diameter ? gap : 0;
    }
    if (crossings == 0)
        host->log(
            host,
            "the bolt from (%g, %g, %g) to (%g, %g, %g) lies in one body, so it holds nothing unless that deforms",
            p->from.x, p->from.y, p->from.z, p->to.x, p->to.y, p->to.z);
    if (empty > 0)
        host->log(host, "the bolt from (%g, %g, %g) to (%g, %g, %g) passes through a void of %g m: it is free there",
                  p->from.x, p->from.y, p->from.z, p->to.x, p->to.y, p->to.z, empty);
}

/* Length of steel that a segment from k to k + 1 strains over: of a crossing, half of the two beside it at least. */
static double gauge_of(double before, double h, double after, bool crosses)
{
    return crosses ? fmax(h, 0.5 * (before + after)) : h;
}

/* Fills the chain of a new bolt, at rest, from its nodes and their states. */
static void begin_chain(chain *c, const params *p, const tl_line_node *at, size_t count, double *state)
{
    const steel s = steel_of(p);
    const double begin = p->grouted_from * distance(p->from, p->to), end = p->grouted_to * distance(p->from, p->to);
    memset(c, 0, sizeof *c);
    c->count = (uint32_t)count;
    for (uint32_t k = 0; k < count; k++) {
        const bool first = k == 0 || at[k - 1].passes, last = k + 1 == count || at[k].passes;
        const double low = first ? at[k].at : 0.5 * (at[k - 1].at + at[k].at);
        const double high = last ? at[k].at : 0.5 * (at[k].at + at[k + 1].at);
        const double length = fmax(0, fmin(high, end) - fmax(low, begin));
        put_grout(c, k, p, &s, length);
        if (k + 1 < count) {
            const double h = at[k + 1].at - at[k].at, before = k ? at[k].at - at[k - 1].at : h;
            const double after = k + 2 < count ? at[k + 2].at - at[k + 1].at : h;
            put_steel(c, k, p, &s, h, gauge_of(before, h, after, at[k].passes));
        }
        state[k * NODE_STATES + GROUTED] = length;
        state[k * NODE_STATES + CROSSES] = at[k].passes;
    }
}

/* Pulls the mouth by the pretension and puts the plate under it. */
static tl_status tighten(const tl_element_host *host, const params *p, chain *c, double *state, double *whole)
{
    c->pull = p->pretension;
    if (!chain_solve(c))
        return host->fail(host, TL_E_ARGUMENT,
                          "pretension = %g N pulls the bolt out of its grout: lower it, or grout "
                          "more of the bolt",
                          p->pretension);
    for (uint32_t k = 0; k + 1 < c->count; k++)
        if (fabs(c->w[k + 1] - c->w[k]) >= p->rupture_strain * c->gauge[k])
            return host->fail(host, TL_E_ARGUMENT,
                              "pretension = %g N strains the steel by %g, and rupture_strain = %g: lower it, or take a "
                              "stiffer steel",
                              p->pretension, fabs(c->w[k + 1] - c->w[k]) / c->gauge[k], p->rupture_strain);
    double axial = 0;
    for (uint32_t k = 0; k < c->count; k++) {
        double *of = &state[k * NODE_STATES];
        of[STEEL] = c->w[k];
        of[GROUT] = c->grout[k];
        of[GROUT_SLIP] = c->hold[k] > 0 ? (c->grout_trial[k] - c->grout[k]) / c->hold[k] : 0;
        of[TENSION] = k + 1 < c->count ? c->tension[k] : 0;
        of[WORN] = c->worn[k];
        axial = fmax(axial, of[TENSION]);
    }
    whole[AXIAL] = axial;
    whole[PLATE] = p->pretension;
    whole[SEAT] = p->plate_stiffness > 0 ? c->w[0] - p->pretension / p->plate_stiffness : 0;
    return TL_OK;
}

static tl_status place(const tl_element_host *host, const void *given)
{
    const params *p = given;
    if (!(distance(p->from, p->to) > 0))
        return host->fail(host, TL_E_ARGUMENT, "from and to are the same point (%g, %g, %g)", p->from.x, p->from.y,
                          p->from.z);
    if (!(p->diameter < distance(p->from, p->to)))
        return host->fail(host, TL_E_ARGUMENT, "diameter = %g m must be below the length of the bolt, %g m",
                          p->diameter, distance(p->from, p->to));
    /* Strengths may be less later on: the bolt yields then. */
    const double plate = p->plate_stiffness > 0 ? p->plate_strength : 0;
    if (p->pretension > fmin(p->yield, plate))
        return host->fail(host, TL_E_ARGUMENT, "pretension = %g N is above what steel (%g N) and plate (%g N) bear",
                          p->pretension, p->yield, plate);
    const tl_line_node *line;
    tl_line_node at[TL_ELEMENT_NODES];
    tl_element_node nodes[TL_ELEMENT_NODES];
    size_t count;
    tl_status status = host->line(host, p->from, p->to, p->spacing, &line, &count);
    if (status != TL_OK)
        return status;
    count = keep_ways(at, line, count, p->diameter);
    if (count == 0)
        return host->fail(host, TL_E_ARGUMENT, "the bolt from (%g, %g, %g) to (%g, %g, %g) lies outside of all blocks",
                          p->from.x, p->from.y, p->from.z, p->to.x, p->to.y, p->to.z);
    if (count > TL_ELEMENT_NODES)
        return host->fail(
            host, TL_E_ARGUMENT,
            "the bolt from (%g, %g, %g) to (%g, %g, %g) has more than %d nodes: make spacing = %g m longer", p->from.x,
            p->from.y, p->from.z, p->to.x, p->to.y, p->to.z, TL_ELEMENT_NODES, p->spacing);
    double *state = calloc(count, NODE_STATES * sizeof *state), whole[WHOLE_STATES] = {0};
    if (!state)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    chain c;
    begin_chain(&c, p, at, count, state);
    status = tighten(host, p, &c, state, whole);
    for (size_t i = 0; i < count; i++)
        nodes[i] = (tl_element_node){at[i].block, at[i].place, {0, 0, 0}, at[i].length};
    if (status == TL_OK) {
        warn(host, p, at, count);
        status = host->add(
            host,
            &(tl_new_element){
                .size = sizeof(tl_new_element), .nodes = nodes, .count = count, .node_state = state, .state = whole});
    }
    free(state);
    return status;
}

/* ---------------------------------------------------------------- the rock --------------- */

/* A joint or a void between two nodes of the chain, as it is now. */
typedef struct crossing {
    uint32_t segment;
    uint32_t begin, end;              /* first node of the way before, last node of that after */
    tl_vec3 axis, slid;               /* unit vector of the bolt, and d */
    tl_vec3 side[2];                  /* unit vectors of the ways; 0: one node only */
    double side_length[2], sum, part; /* m; size of the sum of the sides; g.a */
    double turn;                      /* active length over that of the straight piece now */
    double shear, size;               /* q and |d| */
} crossing;

/* A bolt where its nodes are now. Node k of the chain is row[k] of the batch. */
typedef struct bolt {
    chain c;
    uint32_t row[CHAIN_ROOM];
    bool in_order;                        /* rows follow each other: no node is gone */
    double grouted[CHAIN_ROOM];           /* m */
    double h[CHAIN_ROOM];                 /* of segments, when installed */
    double along[3][CHAIN_ROOM];          /* unit vector of the tension */
    crossing cross[TL_ELEMENT_NODES / 2]; /* each has nodes of its own on either side */
    uint32_t crossings;
} bolt;

/* Takes what the nodes have in a column of the batch, ... */
static void take(const bolt *t, const double *column, double *to)
{
    if (t->in_order)
        memcpy(to, column + t->row[0], t->c.count * sizeof *to);
    for (uint32_t k = 0; k < t->c.count && !t->in_order; k++)
        to[k] = column[t->row[k]];
}

/* ... and puts it there. */
static void give(const bolt *t, const double *from, double *column)
{
    if (t->in_order)
        memcpy(column + t->row[0], from, t->c.count * sizeof *from);
    for (uint32_t k = 0; k < t->c.count && !t->in_order; k++)
        column[t->row[k]] = from[k];
}

static tl_vec3 column(const double *const of[3], uint32_t i)
{
    return tl_v3(of[0][i], of[1][i], of[2][i]);
}

static tl_vec3 way_of(const tl_element_batch *b, uint32_t i, uint32_t j)
{
    return tl_v3(b->rest[0][j] - b->rest[0][i] + (b->u[0][j] - b->u[0][i]),
                 b->rest[1][j] - b->rest[1][i] + (b->u[1][j] - b->u[1][i]),
                 b->rest[2][j] - b->rest[2][i] + (b->u[2][j] - b->u[2][i]));
}

/* Elongations of ways within a body, of nodes at these places that have gone by u; fills h and along. L^2 - h^2 =
 * d . (2 r + d) keeps the digits of a small d. */
TL_VECTORIZED static void stretch(bolt *t, const double *const rest_of[3], const double *const u_of[3],
                                  double *restrict longer_of)
{
    const double *restrict x = rest_of[0], *restrict y = rest_of[1], *restrict z = rest_of[2];
    const double *restrict u = u_of[0], *restrict v = u_of[1], *restrict w = u_of[2];
    const uint32_t last = t->c.count - 1;
#pragma omp simd
    for (uint32_t k = 0; k < last; k++) {
        const tl_vec3 rest = {x[k + 1] - x[k], y[k + 1] - y[k], z[k + 1] - z[k]};
        const tl_vec3 moved = {u[k + 1] - u[k], v[k + 1] - v[k], w[k + 1] - w[k]};
        const tl_vec3 now = tl_v3_add(rest, moved);
        const double h = tl_v3_norm(rest), length = tl_v3_norm(now), per = length > 0 ? 1 / length : 0;
        const double longer = tl_v3_dot(moved, tl_v3_add(tl_v3_add(rest, rest), moved)) / (length + h);
        t->h[k] = h;
        t->along[0][k] = per * now.x;
        t->along[1][k] = per * now.y;
        t->along[2][k] = per * now.z;
        longer_of[k] = fabs(longer) > NOISE * tl_v3_norm(moved) ? longer : 0;
    }
}

/* Elongation at a crossing, whose ends are known. */
static double part_sides(bolt *t, crossing *x, const tl_element_batch *b, double active)
{
    const uint32_t k = x->segment, i = t->row[k], j = t->row[k + 1];
    const tl_vec3 side[2] = {way_of(b, t->row[x->begin], i), way_of(b, j, t->row[x->end])}, g = way_of(b, i, j);
    const double gap = t->h[k] = tl_v3_norm(tl_v3_sub(column(b->rest, j), column(b->rest, i)));
    for (int s = 0; s < 2; s++) {
        x->side_length[s] = tl_v3_norm(side[s]);
        x->side[s] = x->side_length[s] > 0 ? tl_v3_scale(1 / x->side_length[s], side[s]) : tl_v3(0, 0, 0);
    }
    const tl_vec3 sum = tl_v3_add(x->side[0], x->side[1]);
    x->sum = tl_v3_norm(sum);
    x->axis = x->sum > 0 ? tl_v3_scale(1 / x->sum, sum) : tl_v3(0, 0, 0);
    x->part = tl_v3_dot(g, x->axis);
    x->slid = tl_v3_madd(g, -x->part, x->axis);
    x->size = tl_v3_norm(x->slid);
    const double l = active + gap, opened = x->part - gap;
    const tl_vec3 straight = tl_v3_madd(x->slid, l + opened, x->axis);
    const double length = tl_v3_norm(straight);
    x->turn = length > 0 ? active / length : 0;
    const tl_vec3 along = length > 0 ? tl_v3_scale(1 / length, straight) : x->axis;
    t->along[0][k] = along.x;
    t->along[1][k] = along.y;
    t->along[2][k] = along.z;
    return (opened * (2 * l + opened) + x->size * x->size) / (length + l);
}

/* Stiffness of a dowel whose largest displacement is known. */
static double dowel_stiffness(const params *p, double peak)
{
    if (peak >= p->dowel_rupture)
        return 0;
    return peak * p->dowel_stiffness > p->dowel_strength ? p->dowel_strength / peak : p->dowel_stiffness;
}

/* Finds the nodes that are left of an element, and the crossings between them. */
static void find_nodes(bolt *t, const tl_element_batch *b, uint32_t e)
{
    chain *c = &t->c;
    const double *crossing_from = b->state[CROSSES];
    uint32_t begin = 0;
    bool crosses = false;
    c->count = t->crossings = 0;
    for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++) {
        const bool gone = b->weight[i] == 0;
        if (!gone) {
            const uint32_t k = c->count++;
            t->row[k] = i;
            if (k > 0 && crosses) {
                if (t->crossings > 0)
                    t->cross[t->crossings - 1].end = k - 1;
                t->cross[t->crossings++] = (crossing){.segment = k - 1, .begin = begin};
                begin = k;
            }
        }
        crosses = (crosses && gone) || gone || crossing_from[i] != 0;
    }
    if (t->crossings > 0)
        t->cross[t->crossings - 1].end = c->count - 1;
    t->in_order = c->count == b->start[e + 1] - b->start[e];
}

/* Grout of all nodes, whose lengths are known; `worn` becomes 0 or 1. */
TL_VECTORIZED static void put_all_grout(bolt *t, const params *p, const steel *s)
{
    const double stiffness = p->grout_stiffness, bond = s->bond, residual = s->residual;
    chain *c = &t->c;
#pragma omp simd
    for (uint32_t k = 0; k < c->count; k++) {
        const double length = t->grouted[k], whole = bond * length, left = residual * length;
        c->hold[k] = stiffness * length;
        c->bond[k] = whole;
        c->residual[k] = left;
        c->bears[k] = c->worn[k] != 0 ? left : whole;
        c->worn[k] = c->worn[k] != 0 ? 1 : 0;
    }
}

/* Finds the nodes that are left of an element, and what they have. */
static void lay(bolt *t, const params *p, const steel *s, const tl_element_batch *b, uint32_t e)
{
    chain *c = &t->c;
    find_nodes(t, b, e);
    take(t, b->state[STEEL], c->w);
    take(t, b->state[GROUT_SLIP], c->slip);
    take(t, b->state[WORN], c->worn);
    take(t, b->state[PLASTIC], c->plastic);
    take(t, b->state[GROUTED], t->grouted);
    put_all_grout(t, p, s);
    const bool mouth = c->count > 0 && t->row[0] == b->start[e];
    c->pull = 0;
    c->plate_stiff = mouth ? p->plate_stiffness : 0;
    c->plate_limit = p->plate_strength;
    c->seat = b->element_state[SEAT][e];
}

/* Steel of all segments, whose lengths are known; `cut`: 0 where it is whole. */
TL_VECTORIZED static void put_all_steel(bolt *t, const params *p, const steel *s, const double *restrict cut)
{
    const double least = SHORT * p->diameter, ea = s->ea, yield = p->yield;
    chain *c = &t->c;
#pragma omp simd
    for (uint32_t k = 0; k < c->count - 1; k++) {
        c->stiff[k] = ea / larger(t->h[k], least);
        c->limit[k] = cut[k] != 0 ? 0 : yield;
    }
}

/* Displacement of the rock along the bolt, from its first node on, and what follows of the steel. */
static void follow_rock(bolt *t, const params *p, const steel *s, const tl_element_batch *b)
{
    chain *c = &t->c;
    double place[3][CHAIN_ROOM], moved[3][CHAIN_ROOM], longer[CHAIN_ROOM], cut[CHAIN_ROOM];
    const double *rest[3], *u[3];
    for (int d = 0; d < 3; d++) {
        rest[d] = t->in_order ? b->rest[d] + t->row[0] : place[d];
        u[d] = t->in_order ? b->u[d] + t->row[0] : moved[d];
        if (!t->in_order) {
            take(t, b->rest[d], place[d]);
            take(t, b->u[d], moved[d]);
        }
    }
    stretch(t, rest, u, longer);
    for (uint32_t n = 0; n < t->crossings; n++)
        longer[t->cross[n].segment] = part_sides(t, &t->cross[n], b, s->active);
    c->rock[0] = b->state[ROCK][t->row[0]];
    for (uint32_t k = 0; k + 1 < c->count; k++)
        c->rock[k + 1] = c->rock[k] + longer[k];
    memcpy(c->gauge, t->h, (c->count - 1) * sizeof *t->h);
    for (uint32_t n = 0; n < t->crossings; n++) {
        const uint32_t k = t->cross[n].segment;
        const double before = k ? t->h[k - 1] : t->h[k], after = k + 2 < c->count ? t->h[k + 1] : t->h[k];
        c->gauge[k] = gauge_of(before, t->h[k], after, true);
    }
    take(t, b->state[CUT], cut);
    if (c->count > 1)
        put_all_steel(t, p, s, cut);
}

/* ---------------------------------------------------------------- acting ----------------- */

/* What grout, steel, plate and dowels hold and have turned to heat, by the mean of the forces before and after. */
typedef struct books {
    double stored, lost;
} books;

/* What each spring of the grout, or of the steel, has slipped or yielded in this step, turned to heat and holds. */
typedef struct spring_books {
    double had[CHAIN_ROOM]; /* N, before */
    double gives[CHAIN_ROOM], lost[CHAIN_ROOM], stored[CHAIN_ROOM];
} spring_books;

/* Fills them; `trial` are forces without a limit. Whether some gives. */
TL_VECTORIZED static bool book_springs(spring_books *of, const double *restrict stiff, const double *restrict trial,
                                       const double *restrict force, uint32_t count)
{
    double any = 0;
#pragma omp simd reduction(+ : any)
    for (uint32_t k = 0; k < count; k++) {
        const bool holds = stiff[k] > 0;
        const double gives = holds ? (trial[k] - force[k]) / stiff[k] : 0;
        of->gives[k] = gives;
        of->lost[k] = 0.5 * (of->had[k] + force[k]) * gives;
        of->stored[k] = holds ? 0.5 * force[k] * force[k] / stiff[k] : 0;
        any += gives != 0 ? 1 : 0;
    }
    return any > 0;
}

/* Adds a column to what there was, node by node. */
TL_VECTORIZED static void add(double *restrict to, const double *restrict more, uint32_t count)
{
#pragma omp simd
    for (uint32_t k = 0; k < count; k++)
        to[k] += more[k];
}

/* The largest size. */
static double largest(const double *of, uint32_t count)
{
    double most = 0;
    for (uint32_t k = 0; k < count; k++)
        most = larger(most, fabs(of[k]));
    return most;
}

static void sum_books(const spring_books *of, uint32_t count, books *sum)
{
    for (uint32_t k = 0; k < count; k++) {
        sum->lost += of->lost[k];
        sum->stored += of->stored[k];
    }
}

static void keep_grout(bolt *t, const tl_element_batch *b, uint32_t e, books *sum)
{
    chain *c = &t->c;
    spring_books of;
    take(t, b->state[GROUT], of.had);
    b->flags[e] |= book_springs(&of, c->hold, c->grout_trial, c->grout, c->count) ? (uint32_t)TL_ELEMENT_YIELDED : 0;
    sum_books(&of, c->count, sum);
    add(c->slip, of.gives, c->count);
    give(t, c->grout, b->state[GROUT]);
    give(t, c->slip, b->state[GROUT_SLIP]);
    give(t, c->w, b->state[STEEL]);
    give(t, c->rock, b->state[ROCK]);
    give(t, c->worn, b->state[WORN]);
    b->element_state[SLIP][e] = largest(c->slip, c->count);
}

/* Counts the length of grout that has slipped. Where that is all on one side of a joint, and with a loss of bond, the
 * bolt is pulled out: broken. */
static void keep_bond(const bolt *t, const tl_element_batch *b, uint32_t e)
{
    const chain *c = &t->c;
    double slipped = 0, side = 0, side_slipped = 0;
    for (uint32_t k = 0, next = 0; k < c->count; k++) {
        const double length = t->grouted[k];
        side += length;
        side_slipped += c->worn[k] != 0 && c->residual[k] < c->bond[k] ? length : 0;
        slipped += c->worn[k] != 0 ? length : 0;
        const bool crosses = next < t->crossings && t->cross[next].segment == k;
        if (!crosses && k + 1 < c->count)
            continue;
        if (t->crossings > 0 && side > 0 && side_slipped == side)
            b->flags[e] |= (uint32_t)TL_ELEMENT_BROKEN;
        next += crosses;
        side = side_slipped = 0;
    }
    b->element_state[SLIPPED][e] = slipped;
}

/* Cuts steel that strains too much: it bears nothing from the next step on. How many pieces are cut. */
static double cut_steel(const bolt *t, const params *p, const tl_element_batch *b, uint32_t e)
{
    const chain *c = &t->c;
    double cuts = 0, *cut = b->state[CUT];
    for (uint32_t k = 0; k < c->count; k++) {
        const uint32_t i = t->row[k];
        if (k + 1 < c->count && fabs(c->w[k + 1] - c->w[k]) >= p->rupture_strain * c->gauge[k] && cut[i] == 0) {
            cut[i] = 1;
            b->flags[e] |= (uint32_t)TL_ELEMENT_BROKEN;
        }
        cuts += cut[i];
    }
    return cuts;
}

static void keep_steel(bolt *t, const params *p, const tl_element_batch *b, uint32_t e, books *sum)
{
    chain *c = &t->c;
    const uint32_t last = c->count - 1;
    spring_books of;
    take(t, b->state[TENSION], of.had);
    b->flags[e] |= book_springs(&of, c->stiff, c->tension_trial, c->tension, last) ? (uint32_t)TL_ELEMENT_YIELDED : 0;
    sum_books(&of, last, sum);
    add(c->plastic, of.gives, last);
    c->tension[last] = 0;
    give(t, c->tension, b->state[TENSION]);
    give(t, c->plastic, b->state[PLASTIC]);
    b->element_state[AXIAL][e] = largest(c->tension, last);
    b->element_state[BREAKS][e] = cut_steel(t, p, b, e);
}

/* The mouth that moves by x presses the plate by (P' - P) / k; the rest of x crushes it or is a gap. */
static void keep_plate(const bolt *t, const tl_element_batch *b, uint32_t e, books *sum)
{
    const chain *c = &t->c;
    double *plate = &b->element_state[PLATE][e];
    if (c->plate_stiff > 0) {
        const uint32_t i = t->row[0];
        const double way = (c->w[0] - c->rock[0]) - (b->state[STEEL][i] - b->state[ROCK][i]);
        sum->lost += 0.5 * (*plate + c->plate) * (way - (c->plate - *plate) / c->plate_stiff);
        sum->stored += 0.5 * c->plate * c->plate / c->plate_stiff;
        const double crushed = larger(0, c->plate_trial - c->plate_limit) / c->plate_stiff;
        b->element_state[SEAT][e] += crushed;
        b->flags[e] |= crushed > 0 ? (uint32_t)TL_ELEMENT_YIELDED : 0;
    }
    *plate = c->plate;
}

/* As the stiffness of a dowel falls from k to k' between d and d', (k - k') d.d' / 2 becomes heat. */
static void keep_dowels(bolt *t, const params *p, const tl_element_batch *b, uint32_t e, books *sum)
{
    double most = 0;
    for (uint32_t n = 0; n < t->crossings; n++) {
        crossing *x = &t->cross[n];
        const uint32_t i = t->row[x->segment], j = t->row[x->segment + 1];
        double *peak = &b->state[DOWEL_PEAK][i], *dowel = &b->state[DOWEL][i];
        const double had = dowel_stiffness(p, *peak), before = had > 0 ? *dowel / had : 0;
        b->flags[e] |= *peak < p->dowel_rupture && x->size >= p->dowel_rupture && p->dowel_stiffness > 0
                           ? (uint32_t)TL_ELEMENT_BROKEN
                           : 0;
        *peak = larger(*peak, x->size);
        const double has = dowel_stiffness(p, *peak);
        x->shear = has * x->size;
        const tl_vec3 way = tl_v3_sub(column(b->du, j), column(b->du, i));
        const double way2 = tl_v3_norm2(tl_v3_madd(way, -tl_v3_dot(way, x->axis), x->axis));
        sum->lost += 0.25 * (had - has) * (before * before + x->size * x->size - way2);
        sum->stored += 0.5 * x->shear * x->size;
        b->flags[e] |= has < p->dowel_stiffness ? (uint32_t)TL_ELEMENT_YIELDED : 0;
        *dowel = x->shear;
        most = larger(most, x->shear);
        b->element_state[BREAKS][e] += p->dowel_stiffness > 0 && *peak >= p->dowel_rupture;
    }
    b->element_state[SHEAR][e] = most;
}

static void push(const tl_element_batch *b, uint32_t i, double scale, tl_vec3 f)
{
    b->force[0][i] += scale * f.x;
    b->force[1][i] += scale * f.y;
    b->force[2][i] += scale * f.z;
}

/* Forces that turn the way s of a crossing: `couple` is the gradient of the energy in the axis. */
static void turn_side(const bolt *t, const crossing *x, const tl_element_batch *b, int s, tl_vec3 couple)
{
    if (!(x->side_length[s] > 0))
        return;
    const uint32_t from = t->row[s ? x->segment + 1 : x->begin], to = t->row[s ? x->end : x->segment];
    const tl_vec3 across = tl_v3_madd(couple, -tl_v3_dot(couple, x->side[s]), x->side[s]);
    push(b, to, -1 / x->side_length[s], across);
    push(b, from, 1 / x->side_length[s], across);
}

/* Forces of what the rock bears along the segments, N, on the nodes at their ends: one component. */
TL_VECTORIZED static void pull_nodes(const double *restrict tension, const double *restrict along, uint32_t count,
                                     double *restrict force)
{
    force[0] = count > 1 ? tension[0] * along[0] : 0;
#pragma omp simd
    for (uint32_t k = 1; k < count - 1; k++)
        force[k] = tension[k] * along[k] - tension[k - 1] * along[k - 1];
    if (count > 1)
        force[count - 1] = -tension[count - 2] * along[count - 2];
}

/* Forces on the nodes: minus the gradient of the energy. Plate and grout of the nodes so far give the tension that the
 * rock bears between two nodes. */
static void put_forces(const bolt *t, const tl_element_batch *b, uint32_t e)
{
    const chain *c = &t->c;
    double tension[CHAIN_ROOM], force[CHAIN_ROOM], sum = c->plate;
    for (uint32_t k = 0; k < c->count; k++)
        tension[k] = sum += c->grout[k];
    for (int k = 0; k < 3; k++) {
        if (!t->in_order)
            memset(&b->force[k][b->start[e]], 0, (b->start[e + 1] - b->start[e]) * sizeof(double));
        if (c->count == 0)
            continue;
        pull_nodes(tension, t->along[k], c->count, force);
        give(t, force, b->force[k]);
    }
    for (uint32_t n = 0; n < t->crossings; n++) {
        const crossing *x = &t->cross[n];
        const double dowel = x->size > 0 ? x->shear / x->size : 0;
        push(b, t->row[x->segment], dowel, x->slid);
        push(b, t->row[x->segment + 1], -dowel, x->slid);
        if (!(x->sum > 0))
            continue;
        const tl_vec3 couple = tl_v3_scale((tension[x->segment] * x->turn - dowel * x->part) / x->sum, x->slid);
        turn_side(t, x, b, 0, couple);
        turn_side(t, x, b, 1, couple);
    }
}

/* Work of the bodies on the element in this step: the half of one end of the step. */
static double work_on(const tl_element_batch *b, uint32_t e)
{
    double sum = 0;
    for (int k = 0; k < 3; k++)
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++)
            sum -= 0.5 * b->force[k][i] * b->du[k][i];
    return sum;
}

/* Cost only: numbers in a line of the cache. */
#define LINE 8

/* Has the columns of an element brought near, while another is worked on. */
static void fetch(const tl_element_batch *b, uint32_t e)
{
    for (uint32_t i = b->start[e]; i < b->start[e + 1]; i += LINE) {
        for (int k = 0; k < NODE_STATES; k++)
            __builtin_prefetch(b->state[k] + i, 1);
        for (int k = 0; k < 3; k++) {
            __builtin_prefetch(b->rest[k] + i, 0);
            __builtin_prefetch(b->u[k] + i, 0);
            __builtin_prefetch(b->force[k] + i, 1);
        }
    }
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)report;
    const params *p = self;
    const steel s = steel_of(p);
    bolt t;
    for (uint32_t e = 0; e < b->count; e++) {
        books sum = {0, 0};
        if (e + 1 < b->count)
            fetch(b, e + 1);
        lay(&t, p, &s, b, e);
        const bool whole = t.in_order;
        const double before = whole ? 0 : work_on(b, e);
        if (t.c.count > 0) {
            follow_rock(&t, p, &s, b);
            chain_solve(&t.c);
            keep_plate(&t, b, e, &sum);
            keep_grout(&t, b, e, &sum);
            keep_steel(&t, p, b, e, &sum);
            keep_dowels(&t, p, b, e, &sum);
            if (b->flags[e] & (uint32_t)TL_ELEMENT_YIELDED)
                keep_bond(&t, b, e);
        }
        put_forces(&t, b, e);
        /* what gone nodes held is heat */
        b->lost[e] = whole ? sum.lost : before + work_on(b, e) - (sum.stored - b->stored[e]);
        b->stored[e] = sum.stored;
    }
    return TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    const params *p = self;
    const steel s = steel_of(p);
    (void)c;
    const double turning = smaller(p->yield, MOST_STRAIN * s.ea) / s.active;
    for (uint32_t e = 0; e < b->count; e++)
        for (uint32_t i = b->start[e]; i < b->start[e + 1]; i++) {
            const bool first = i == b->start[e], crosses = b->state[CROSSES][i] != 0;
            const bool beside = crosses || (!first && b->state[CROSSES][i - 1] != 0);
            k[i] = p->grout_stiffness * b->state[GROUTED][i] + (first ? p->plate_stiffness : 0) +
                   (beside ? p->dowel_stiffness + turning : 0);
        }
}

static const tl_element_ops ops = {.size = sizeof ops,
                                   .create = create,
                                   .place = place,
                                   .update = update,
                                   .stiffness = stiffness,
                                   .destroy = free,
                                   .never_fails = 1};

static const tl_kind kinds[] = {
    TL_KIND(TL_KIND_ELEMENT, ops, .name = "bolt", .doc = "A grouted steel bar with a plate, across joints.",
            TL_KIND_PARAMS(params, bolt_params), TL_KIND_STATES(state_table)),
    TL_KIND(TL_KIND_ELEMENT, ops, .name = "anchor", .doc = "A bolt that is grouted at its far end only.",
            TL_KIND_PARAMS(params, anchor_params), TL_KIND_STATES(state_table))};

TL_PLUGIN_SINCE(13, kinds, .id = "talus.bolt", .version = TALUS_VERSION, .doc = "Bolts and anchors.",
                .licence = "BSD-3-Clause");
