/* solve.c - pressures and flows in a network of wet joints.
 *
 * A cell is a wet joint of area A. Its aperture is the mean over its corners, with the areas that they stand for,
 *
 *     w = mean of clamp(touching + opening, residual, maximum)
 *
 * with the opening of the walls, below 0 where they overlap, and the aperture `touching` where they just touch. The
 * potential is phi = p + unit_weight z, Pa. A side has the length L and the distance d from the centroid. By the cubic
 * law (Witherspoon, Wang, Iwai and Gale 1980) there flows to it, m3/s,
 *
 *     q = t (phi_cell - phi_side),    t = w^3 / (12 viscosity) L / d
 *
 * Sides that meet have one phi, the mean with the weights t, unless a head gives it; one that meets none is closed. The
 * pressure in a drain is 0. One of the radius r takes from a cell that it passes at the height z (Peaceman 1978)
 *
 *     q = 2 pi w^3 / (12 viscosity) / ln(r0 / r) (phi_cell - unit_weight z),    r0 = 0.2 sqrt(A)
 *
 * Steady flow: the sum over each cell is 0, and a joint above the water conducts as if it were full. It bears no
 * pressure. stored.c follows water that is stored.
 *
 * The equations A x = r are solved by conjugate gradients, one after the other, so the bits do not depend on threads.
 * With D the diagonal of A and L what is left of it, the preconditioner is the modified incomplete factor (Gustafsson
 * 1978)
 *
 *     M = (P + L) P^-1 (P + L^t),    P diagonal so that M and A + LIFT D have the same sums of rows
 *
 * Two cells e and f at a crossing of the sum s have the term -t_e t_f / s in A. So one pass over the cells finds P:
 *
 *     P_e = (1 + LIFT) D_e - sum over f < e of  t_e t_f / s W_f / P_f,    W_f = sum over g > f of t_f t_g / s
 *
 * With W_f <= P_f it is at least W_e + LIFT D_e, so M is positive definite.
 */
#include "solve.h"

/* Tolerance: the same over what it would be if the potentials were each alone: rounding of sums. It is for networks
 * without water, which have any potential. Test: property/flow_properties. */
#define ROUNDING 1e-15
/* Limit: iterations for each cell. Those of a network in a plane grow slower than the root of their number. */
#define MOST_ITERATIONS 20
/* Cost only: more of the diagonal in the preconditioner. It keeps pivots above 0 where rounding takes what drains. */
#define LIFT 1e-3

/* Tolerance: least ratio of the radii of a drain. `place` refuses smaller ones, but joints that are cut become smaller.
 * Test: lua/test_flow. */
#define LEAST_RATIO 1.05

/* ---------------------------------------------------------------- geometry --------------- */

static tl_vec3 node_at(const tl_element_batch *b, uint32_t i)
{
    return tl_v3(b->rest[0][i] + b->u[0][i], b->rest[1][i] + b->u[1][i], b->rest[2][i] + b->u[2][i]);
}

static tl_vec3 normal_at(const tl_element_batch *b, uint32_t i)
{
    return tl_v3(b->normal[0][i], b->normal[1][i], b->normal[2][i]);
}

static size_t role_of(const flow_net *n, size_t e)
{
    return (size_t)n->b->element_state[FLOW_ROLE][e];
}

/* A polygon as it is, halfway between its walls, in the frame x, y about its centroid. */
typedef struct cell {
    uint32_t node, corners;
    tl_vec3 centroid, x, y, normal;
    double area;
    double xx, xy, yy; /* second moments per area */
} cell;

static tl_vec3 corner_of(const flow_net *n, const cell *c, uint32_t i)
{
    const uint32_t a = c->node + i;
    return tl_v3_scale(0.5, tl_v3_add(node_at(n->b, a), node_at(n->b, a + c->corners)));
}

static cell cell_of(const flow_net *n, size_t e)
{
    const uint32_t begin = n->b->start[e];
    cell c = {.node = begin, .corners = (n->b->start[e + 1] - begin) / 2};
    c.normal = tl_v3_unit(tl_v3_sub(normal_at(n->b, begin), normal_at(n->b, begin + c.corners)));
    c.x = tl_v3_perpendicular(c.normal);
    c.y = tl_v3_cross(c.normal, c.x);
    const tl_vec3 o = corner_of(n, &c, 0);
    double sx = 0, sy = 0;
    for (uint32_t i = 1; i + 1 < c.corners; i++) {
        const tl_vec3 r = tl_v3_sub(corner_of(n, &c, i), o), s = tl_v3_sub(corner_of(n, &c, i + 1), o);
        const double rx = tl_v3_dot(r, c.x), ry = tl_v3_dot(r, c.y), qx = tl_v3_dot(s, c.x), qy = tl_v3_dot(s, c.y);
        const double part = 0.5 * (rx * qy - ry * qx);
        c.area += part;
        sx += part * (rx + qx) / 3;
        sy += part * (ry + qy) / 3;
        c.xx += part * (rx * rx + rx * qx + qx * qx) / 6;
        c.xy += part * (2 * rx * ry + rx * qy + qx * ry + 2 * qx * qy) / 12;
        c.yy += part * (ry * ry + ry * qy + qy * qy) / 6;
    }
    sx /= c.area;
    sy /= c.area;
    c.xx = c.xx / c.area - sx * sx;
    c.xy = c.xy / c.area - sx * sy;
    c.yy = c.yy / c.area - sy * sy;
    c.centroid = tl_v3_madd(tl_v3_madd(o, sx, c.x), sy, c.y);
    return c;
}

static double height_of(const flow_net *n, const cell *c)
{
    return n->b->origin.z + c->centroid.z;
}

/* Side i: its vector L n, outward, and its middle from the centroid. */
static void side_of(const flow_net *n, const cell *c, uint32_t i, tl_vec3 *out, tl_vec3 *middle)
{
    const tl_vec3 a = corner_of(n, c, i), b = corner_of(n, c, i + 1 < c->corners ? i + 1 : 0);
    *out = tl_v3_cross(tl_v3_sub(b, a), c->normal);
    *middle = tl_v3_sub(tl_v3_scale(0.5, tl_v3_add(a, b)), c->centroid);
}

/* Mean aperture, m, and mean opening. */
static double aperture_of(const flow_net *n, const cell *c, double *opening)
{
    const tl_element_batch *b = n->b;
    double sum = 0, area = 0, open = 0;
    for (uint32_t i = c->node; i < c->node + c->corners; i++) {
        double gap = 0;
        for (int k = 0; k < 3; k++) {
            const uint32_t j = i + c->corners;
            gap += b->normal[k][i] * ((b->rest[k][j] - b->rest[k][i]) + (b->u[k][j] - b->u[k][i]));
        }
        sum += b->weight[i] * fmin(fmax(b->state[FLOW_TOUCHING][i] + gap, n->p->residual), n->p->maximum);
        open += b->weight[i] * gap;
        area += b->weight[i];
    }
    *opening = open / area;
    return sum / area;
}

/* ---------------------------------------------------------------- the network ------------ */

bool flow_is_wet(const flow_net *n, size_t e)
{
    const tl_element_batch *b = n->b;
    return role_of(n, e) == FLOW_JOINT && !(b->flags[e] & TL_ELEMENT_DETACHED);
}

/* Makes room. false: out of memory. */
static bool make_room(flow_net *n)
{
    double top = -1;
    n->first = malloc((n->cells + 1) * sizeof *n->first);
    for (size_t e = 0; n->first && e < n->cells; e++) {
        n->first[e] = (uint32_t)n->sides;
        const uint32_t half = flow_is_wet(n, e) ? (n->b->start[e + 1] - n->b->start[e]) / 2 : 0;
        for (uint32_t i = 0; i < half; i++)
            top = fmax(top, n->b->state[FLOW_CROSSING][n->b->start[e] + i]);
        n->sides += half;
    }
    if (!n->first)
        return false;
    n->first[n->cells] = (uint32_t)n->sides;
    n->crossings = (size_t)(top + 1);
    double **const of_cells[] = {&n->x,      &n->r,      &n->way,  &n->y,     &n->extra, &n->diagonal, &n->leak,
                                 &n->linked, &n->source, &n->mean, &n->width, &n->level, &n->pivot,    &n->z};
    n->head_row = malloc((n->cells + 1) * sizeof *n->head_row);
    n->drain_row = malloc((n->cells + 1) * sizeof *n->drain_row);
    bool enough = n->head_row && n->drain_row;
    for (size_t k = 0; k < n->cells && enough; k++)
        if (role_of(n, k) == FLOW_AT_HEAD)
            n->head_row[n->head_count++] = (uint32_t)k;
        else if (role_of(n, k) == FLOW_AT_DRAIN)
            n->drain_row[n->drain_count++] = (uint32_t)k;
    for (size_t k = 0; k < sizeof of_cells / sizeof *of_cells; k++)
        enough = (*of_cells[k] = calloc(n->cells + 1, sizeof(double))) != NULL && enough;
    double **const of_crossings[] = {&n->sum, &n->phi, &n->given, &n->share, &n->later};
    for (size_t k = 0; k < sizeof of_crossings / sizeof *of_crossings; k++)
        enough = (*of_crossings[k] = calloc(n->crossings + 1, sizeof(double))) != NULL && enough;
    n->crossing = calloc(n->sides + 1, sizeof *n->crossing);
    n->t = calloc(n->sides + 1, sizeof *n->t);
    n->head = calloc(n->crossings + 1, sizeof *n->head);
    n->open = calloc(n->crossings + 1, 1);
    n->closed = calloc(n->cells + 1, 1);
    n->drained = calloc(n->cells + 1, 1);
    return enough && n->crossing && n->t && n->head && n->open && n->closed && n->drained;
}

static void release(flow_net *n)
{
    void *const owned[] = {n->first,     n->crossing, n->t,     n->head,  n->given,    n->sum,    n->phi,   n->x,
                           n->r,         n->way,      n->y,     n->extra, n->diagonal, n->width,  n->level, n->closed,
                           n->open,      n->drained,  n->drain, n->leak,  n->linked,   n->source, n->mean,  n->head_row,
                           n->drain_row, n->pivot,    n->z,     n->share, n->later};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
}

/* Adds the drains that pass a cell. false: out of memory. */
static bool add_drains(flow_net *n, size_t e, const cell *c)
{
    const tl_element_batch *b = n->b;
    tl_vec3 corner[TL_ELEMENT_NODES];
    for (uint32_t i = 0; n->drain_count > 0 && i < c->corners; i++)
        corner[i] = corner_of(n, c, i);
    for (size_t i = 0; i < n->drain_count; i++) {
        const uint32_t k = n->drain_row[i];
        double z;
        if (!flow_drain_meets(corner, c->corners, c->normal, node_at(b, b->start[k]), node_at(b, b->start[k] + 1), &z))
            continue;
        if (n->hits == n->hit_capacity) {
            const size_t more = n->hits ? 2 * n->hits : 64;
            flow_hit *list = realloc(n->drain, more * sizeof *list);
            if (!list)
                return false;
            n->drain = list;
            n->hit_capacity = more;
        }
        const double ratio = FLOW_WELL_RADIUS * sqrt(c->area) / b->weight[b->start[k]], w = n->width[e];
        const double conductance =
            2 * TL_PI * w * w * w / (12 * n->p->viscosity) / tl_log1p(fmax(ratio, LEAST_RATIO) - 1);
        n->drain[n->hits++] = (flow_hit){(uint32_t)e, k, conductance, n->p->unit_weight * (b->origin.z + z) - n->base};
        n->drained[e] = 1;
    }
    return true;
}

/* Gives a crossing the head of the first box that the middle of a side lies in. */
static void take_head(flow_net *n, tl_vec3 middle, uint32_t crossing)
{
    const tl_element_batch *b = n->b;
    for (size_t i = 0; i < n->head_count; i++) {
        const uint32_t k = n->head_row[i];
        if ((n->head[crossing] == 0 || n->head[crossing] > k + 1) &&
            flow_in_box(node_at(b, b->start[k]), node_at(b, b->start[k] + 1), middle)) {
            n->head[crossing] = k + 1;
            n->open[crossing] = 1;
            n->given[crossing] = n->p->unit_weight * b->element_state[FLOW_HEAD][k] - n->base;
        }
    }
}

/* Fills in the cell of element e. false: out of memory. */
static bool add_cell(flow_net *n, size_t e)
{
    const tl_element_batch *b = n->b;
    const cell c = cell_of(n, e);
    double opening;
    n->width[e] = aperture_of(n, &c, &opening);
    b->element_state[FLOW_OPENING][e] = opening;
    if (opening > n->p->drain_gap)
        b->element_state[FLOW_DRY][e] = 1;
    const bool dry = b->element_state[FLOW_DRY][e] != 0 || !(c.area > 0);
    const double law = n->width[e] * n->width[e] * n->width[e] / (12 * n->p->viscosity);
    for (uint32_t i = 0; i < c.corners; i++) {
        const uint32_t side = n->first[e] + i, crossing = (uint32_t)b->state[FLOW_CROSSING][c.node + i];
        tl_vec3 out, middle;
        side_of(n, &c, i, &out, &middle);
        const double length2 = tl_v3_norm2(out), distance = tl_v3_dot(out, middle);
        n->crossing[side] = crossing;
        n->t[side] = dry || !(distance > 0) ? 0 : law * length2 / distance;
        n->sum[crossing] += n->t[side];
        if (n->t[side] > 0)
            take_head(n, tl_v3_add(b->origin, tl_v3_add(c.centroid, middle)), crossing);
    }
    double own = 0, area = 0;
    for (uint32_t i = c.node; i < c.node + c.corners; i++) {
        own += b->weight[i] * b->state[FLOW_SOURCE][i];
        area += b->weight[i];
    }
    const bool made = b->element_state[FLOW_APERTURE][e] > 0;
    const double head = b->element_state[FLOW_HEAD][e];
    n->level[e] = n->p->unit_weight * height_of(n, &c) - n->base;
    n->x[e] = made ? n->p->unit_weight * head - n->base : n->level[e] + own / area;
    n->closed[e] = dry;
    b->element_state[FLOW_AREA][e] = c.area;
    return dry || add_drains(n, e, &c);
}

/* The least and largest head lie about it. */
static double base_of(const flow_net *n)
{
    return n->head_count > 0 ? n->p->unit_weight * n->b->element_state[FLOW_HEAD][n->head_row[0]] : 0;
}

static bool build(flow_net *n)
{
    if (!make_room(n))
        return false;
    n->base = base_of(n);
    bool enough = true;
    for (size_t e = 0; e < n->cells && enough; e++)
        if (flow_is_wet(n, e))
            enough = add_cell(n, e);
    return enough;
}

/* ---------------------------------------------------------------- the equations ---------- */

/* The potentials of crossings for those of cells; where a head is, that or, with `bare`, 0. */
static void meet(flow_net *n, const double *x, bool bare)
{
    memset(n->phi, 0, n->crossings * sizeof *n->phi);
    for (size_t e = 0; e < n->cells; e++)
        for (uint32_t k = n->first[e]; k < n->first[e + 1]; k++)
            n->phi[n->crossing[k]] += n->t[k] * x[e];
    for (size_t c = 0; c < n->crossings; c++)
        n->phi[c] = n->head[c] ? (bare ? 0 : n->given[c]) : n->sum[c] > 0 ? n->phi[c] / n->sum[c] : 0;
}

/* y = A x. */
void flow_multiply(flow_net *n, const double *x, double *y)
{
    meet(n, x, true);
    for (size_t e = 0; e < n->cells; e++) {
        double sum = n->extra[e] * x[e];
        for (uint32_t k = n->first[e]; k < n->first[e + 1]; k++)
            sum += n->t[k] * (x[e] - n->phi[n->crossing[k]]);
        y[e] = sum;
    }
}

/* Sum of a b / d over all cells, by partial sums that compilers may keep side by side. */
static double scaled_product(const flow_net *n, const double *a, const double *b)
{
    double part[4] = {0, 0, 0, 0};
    for (size_t e = 0; e < n->cells; e++)
        part[e % 4] += n->diagonal[e] > 0 ? a[e] * b[e] / n->diagonal[e] : 0;
    return (part[0] + part[1]) + (part[2] + part[3]);
}

/* Sum of d a^2. */
static double weighted_square(const flow_net *n, const double *a)
{
    double sum = 0;
    for (size_t e = 0; e < n->cells; e++)
        sum += n->diagonal[e] * a[e] * a[e];
    return sum;
}

static double product(const flow_net *n, const double *a, const double *b)
{
    double part[4] = {0, 0, 0, 0};
    for (size_t e = 0; e < n->cells; e++)
        part[e % 4] += a[e] * b[e];
    return (part[0] + part[1]) + (part[2] + part[3]);
}

/* Fills what the equations have without storage. */
static void set_up(flow_net *n)
{
    for (size_t k = 0; k < n->hits; k++) {
        n->leak[n->drain[k].cell] += n->drain[k].conductance;
        n->source[n->drain[k].cell] += n->drain[k].conductance * n->drain[k].phi;
    }
    for (size_t e = 0; e < n->cells; e++) {
        n->linked[e] = n->leak[e];
        for (uint32_t k = n->first[e]; !n->closed[e] && k < n->first[e + 1]; k++) {
            const uint32_t c = n->crossing[k];
            n->linked[e] += n->head[c] ? n->t[k] : n->t[k] * (1 - n->t[k] / n->sum[c]);
            n->source[e] += n->head[c] ? n->t[k] * n->given[c] : 0;
        }
    }
}

/* Cells that take no part: dry ones, and closed networks in steady flow. Nothing flows there. */
static void still(flow_net *n)
{
    for (size_t e = 0; e < n->cells; e++)
        for (uint32_t k = n->first[e]; n->closed[e] && k < n->first[e + 1]; k++) {
            n->sum[n->crossing[k]] -= n->t[k];
            n->t[k] = 0;
        }
    for (size_t c = 0; c < n->crossings; c++)
        n->sum[c] = 0;
    for (size_t k = 0; k < n->sides; k++)
        n->sum[n->crossing[k]] += n->t[k];
}

/* What reaches cell e from the others at its crossings: sum of t / s of what `from` has gathered there. */
static double reaching(const flow_net *n, size_t e, const double *from)
{
    double sum = 0;
    for (uint32_t k = n->first[e]; k < n->first[e + 1]; k++)
        sum += n->t[k] * n->share[n->crossing[k]] * from[n->crossing[k]];
    return sum;
}

/* Adds `value` of cell e to what its crossings have gathered. */
static void gather(const flow_net *n, size_t e, double value, double *to)
{
    for (uint32_t k = n->first[e]; k < n->first[e + 1]; k++)
        to[n->crossing[k]] += n->t[k] * value;
}

/* Finds the factor of the equations: `pivot` has 1 / P, 0 where the potential is given. */
static void factor(flow_net *n)
{
    memset(n->phi, 0, n->crossings * sizeof *n->phi);
    memset(n->later, 0, n->crossings * sizeof *n->later);
    for (size_t c = 0; c < n->crossings; c++)
        n->share[c] = n->head[c] || !(n->sum[c] > 0) ? 0 : 1 / n->sum[c];
    for (size_t e = 0; e < n->cells; e++)
        gather(n, e, n->diagonal[e] > 0 ? 1 : 0, n->later);
    for (size_t e = 0; e < n->cells; e++) {
        n->pivot[e] = 0;
        if (!(n->diagonal[e] > 0))
            continue;
        gather(n, e, -1, n->later);
        const double after = fmax(0, reaching(n, e, n->later));
        n->pivot[e] = 1 / fmax((1 + LIFT) * n->diagonal[e] - reaching(n, e, n->phi), LIFT * n->diagonal[e]);
        gather(n, e, after * n->pivot[e], n->phi);
    }
}

/* z = M^-1 r. */
static void precondition(flow_net *n)
{
    memset(n->phi, 0, n->crossings * sizeof *n->phi);
    for (size_t e = 0; e < n->cells; e++) {
        n->z[e] = n->pivot[e] * (n->r[e] + reaching(n, e, n->phi));
        gather(n, e, n->z[e], n->phi);
    }
    memset(n->phi, 0, n->crossings * sizeof *n->phi);
    for (size_t e = n->cells; e-- > 0;) {
        n->z[e] += n->pivot[e] * reaching(n, e, n->phi);
        gather(n, e, n->z[e], n->phi);
    }
}

bool flow_iterate(flow_net *n)
{
    const double wanted = scaled_product(n, n->r, n->r);
    flow_multiply(n, n->x, n->y);
    for (size_t e = 0; e < n->cells; e++)
        n->r[e] = n->diagonal[e] > 0 ? n->r[e] - n->y[e] : 0;
    double left = scaled_product(n, n->r, n->r);
    const double most = MOST_ITERATIONS * (double)n->cells + 1000,
                 least = ROUNDING * ROUNDING * weighted_square(n, n->x);
    const double end = fmax(FLOW_CONVERGED * FLOW_CONVERGED * fmax(wanted, left), least);
    if (left <= end)
        return isfinite(left);
    factor(n);
    precondition(n);
    memcpy(n->way, n->z, n->cells * sizeof *n->way);
    double now = product(n, n->r, n->z);
    for (double i = 0; left > end; i++) {
        if (!(i < most))
            return false;
        flow_multiply(n, n->way, n->y);
        const double part = now / product(n, n->way, n->y);
        for (size_t e = 0; e < n->cells; e++) {
            n->x[e] += part * n->way[e];
            n->r[e] -= part * n->y[e];
        }
        left = scaled_product(n, n->r, n->r);
        precondition(n);
        const double next = product(n, n->r, n->z), again = next / now;
        for (size_t e = 0; e < n->cells; e++)
            n->way[e] = n->z[e] + again * n->way[e];
        now = next;
    }
    return isfinite(left);
}

/* ---------------------------------------------------------------- what comes of it ------- */

/* Gives the nodes of a cell its pressures: linear, with the gradient that the sides have on the mean. What each corner
 * is to bear has the force and the moments of that, since its weight stands for a third of triangles: second moments
 * of the corners are larger than those of the polygon. */
static void give_pressures(flow_net *n, size_t e)
{
    const tl_element_batch *b = n->b;
    const cell c = cell_of(n, e);
    const double p = n->x[e] + n->base - n->p->unit_weight * height_of(n, &c);
    tl_vec3 slope = {0, 0, 0};
    double vx = 0, vxy = 0, vy = 0, area = 0;
    for (uint32_t i = 0; i < c.corners; i++) {
        const uint32_t side = n->first[e] + i;
        tl_vec3 out, middle;
        side_of(n, &c, i, &out, &middle);
        if (n->t[side] > 0)
            slope = tl_v3_madd(slope, (n->phi[n->crossing[side]] - n->x[e]) / c.area, out);
        const tl_vec3 d = tl_v3_sub(corner_of(n, &c, i), c.centroid);
        const double x = tl_v3_dot(d, c.x), y = tl_v3_dot(d, c.y), w = b->weight[c.node + i];
        vx += w * x * x;
        vxy += w * x * y;
        vy += w * y * y;
        area += w;
    }
    slope.z -= n->p->unit_weight;
    const double gx = tl_v3_dot(slope, c.x), gy = tl_v3_dot(slope, c.y);
    const double hx = c.xx * gx + c.xy * gy, hy = c.xy * gx + c.yy * gy, det = (vx * vy - vxy * vxy) / area;
    const double fx = det > 0 ? (vy * hx - vxy * hy) / det : 0, fy = det > 0 ? (vx * hy - vxy * hx) / det : 0;
    for (uint32_t i = 0; i < 2 * c.corners; i++) {
        const tl_vec3 d = tl_v3_sub(corner_of(n, &c, i % c.corners), c.centroid);
        const double x = tl_v3_dot(d, c.x), y = tl_v3_dot(d, c.y);
        b->state[FLOW_PRESSURE][c.node + i] = fmax(0, p + gx * x + gy * y);
        b->state[FLOW_SOURCE][c.node + i] = fmax(0, p + fx * x + fy * y);
    }
}

void flow_out(flow_net *n, const double *x, double *out)
{
    meet(n, x, false);
    for (size_t e = 0; e < n->cells; e++) {
        out[e] = 0;
        for (uint32_t k = n->first[e]; k < n->first[e + 1]; k++)
            out[e] += n->t[k] * (x[e] - n->phi[n->crossing[k]]);
    }
    for (size_t k = 0; k < n->hits; k++) {
        const flow_hit *h = &n->drain[k];
        out[h->cell] += n->closed[h->cell] ? 0 : h->conductance * (x[h->cell] - h->phi);
    }
}

/* Flows of cells, heads and drains. */
static void give_flows(flow_net *n)
{
    double *const flow = n->b->element_state[FLOW_FLOW];
    for (size_t e = 0; e < n->cells; e++)
        flow[e] = 0;
    for (size_t e = 0; e < n->cells; e++)
        for (uint32_t k = n->first[e]; k < n->first[e + 1]; k++) {
            const uint32_t c = n->crossing[k];
            const double q = n->t[k] * (n->mean[e] - n->phi[c]);
            flow[e] += 0.5 * fabs(q);
            if (n->head[c] && n->t[k] > 0)
                flow[n->head[c] - 1] -= q;
        }
    for (size_t k = 0; k < n->hits; k++) {
        const flow_hit *h = &n->drain[k];
        const double q = n->closed[h->cell] ? 0 : h->conductance * (n->mean[h->cell] - h->phi);
        flow[h->cell] += 0.5 * fabs(q);
        flow[h->drain] -= q;
    }
}

/* Marks heads and drains that reach no joint. */
static void mark_ends(flow_net *n)
{
    double *const closed = n->b->element_state[FLOW_CLOSED];
    for (size_t i = 0; i < n->head_count; i++)
        closed[n->head_row[i]] = 1;
    for (size_t i = 0; i < n->drain_count; i++)
        closed[n->drain_row[i]] = 1;
    for (size_t c = 0; c < n->crossings; c++)
        if (n->head[c])
            closed[n->head[c] - 1] = 0;
    for (size_t k = 0; k < n->hits; k++)
        closed[n->drain[k].drain] = 0;
}

static void give_all(flow_net *n)
{
    const tl_element_batch *b = n->b;
    if (n->flows) {
        meet(n, n->mean, false);
        give_flows(n);
    }
    meet(n, n->x, false);
    mark_ends(n);
    for (size_t e = 0; e < n->cells; e++) {
        b->element_state[FLOW_TIME][e] = b->time;
        if (!flow_is_wet(n, e))
            continue;
        b->element_state[FLOW_APERTURE][e] = n->width[e];
        b->element_state[FLOW_HEAD][e] = (n->x[e] + n->base) / n->p->unit_weight;
        b->element_state[FLOW_CLOSED][e] = n->closed[e];
        give_pressures(n, e);
    }
}

static TL_PRINTF(3, 4) tl_status refuse(tl_report *report, tl_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(report->text, sizeof report->text, format, arguments);
    va_end(arguments);
    return status;
}

/* Time since pressures were found last, s; 0: never. */
static double time_since(const flow_net *n)
{
    const double *time = n->b->element_state[FLOW_TIME];
    double last = -1;
    for (size_t e = 0; e < n->cells; e++)
        last = fmax(last, time[e]);
    return last < 0 ? 0 : n->b->time - last;
}

/* Whether some element has not been solved yet: one that was placed now. */
static bool is_new(const flow_net *n)
{
    bool some = false;
    for (size_t e = 0; e < n->cells; e++)
        some = some || n->b->element_state[FLOW_TIME][e] < 0;
    return some;
}

/* Solves the equations without storage. false: they do not converge. */
static bool find_steady(flow_net *n)
{
    const size_t bytes = n->cells * sizeof *n->x;
    memcpy(n->extra, n->leak, bytes);
    memcpy(n->diagonal, n->linked, bytes);
    memcpy(n->r, n->source, bytes);
    return flow_iterate(n);
}

static tl_status solve(flow_net *n, tl_report *report)
{
    tl_status status = build(n) ? TL_OK : TL_E_MEMORY;
    n->step = n->p->steady ? 0 : time_since(n);
    n->flows = n->p->steady || n->step > 0 || is_new(n);
    if (status == TL_OK && n->p->steady &&
        !flow_find_closed(n->cells, n->first, n->crossing, n->crossings, n->open, n->drained, n->closed))
        status = TL_E_MEMORY;
    if (status == TL_OK) {
        still(n);
        set_up(n);
        if (!n->p->steady)
            flow_count_water(n);
        if (n->step > 0)
            status = flow_follow(n);
        else if (n->p->steady && !find_steady(n))
            status = TL_E_NUMERIC;
    }
    if (status == TL_E_MEMORY)
        return refuse(report, status, "out of memory for the flow in %u wet joints", n->b->count);
    if (status != TL_OK)
        return refuse(report, status,
                      "the flow does not converge in %d iterations for each of %u joints: bring residual and "
                      "maximum, %g and %g m, nearer to each other",
                      MOST_ITERATIONS, n->b->count, n->p->residual, n->p->maximum);
    if (!(n->step > 0))
        memcpy(n->mean, n->x, n->cells * sizeof *n->x);
    give_all(n);
    return TL_OK;
}

tl_status flow_solve(const void *self, const tl_element_batch *batch, tl_report *report)
{
    flow_net n = {.p = self, .b = batch, .cells = batch->count};
    const tl_status status = solve(&n, report);
    release(&n);
    return status;
}
