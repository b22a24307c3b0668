/* shell.c - a patch of a shell on springs.
 *
 * The shell has no mass. Its displacements q are those for which
 *
 *     K q = sum B (d - q),    B = w (kt (I - n n^t) + kn n n^t)
 *
 * with the stiffness K of its facets, the displacements d of the rock at the corners of facets, and the springs B of
 * the bond: w is the area of a corner and n the normal of its facet. A corner that presses has kt = 0. The matrix is
 * factorised again when something debonds or cracks.
 *
 * Displacements are small beside a motion that each part of the shell makes with the rock that holds it. With the
 * places X when installed and x now, from the means over the part, and its rotation R,
 *
 *     d = R^t x - X,    sum w X x (R^t x) = 0
 *
 * tells R. The energy depends on places alone, and forces on the rock are minus its gradient:
 *
 *     F = -R (f - w m x X),    f = B (d - q),    m = J^-1 sum (R^t x) x f,    J = sum w ((X.y) I - y X^t),  y = R^t x
 *
 * so they and their moments add up to zero, and the shell does not feel that all turns. */
#include "shell.h"

#include <math.h>
#include <string.h>
#include <talus/vmath.h>

/* Limit: of corners and freedoms of a patch. */
#define CORNERS TL_ELEMENT_MANY
#define FREEDOMS (4 * CORNERS)
/* Limit: rounds in which the rotation of a part is found; three are enough. */
#define ROUNDS 10
/* Tolerance: square of the last turn, rad2: the next one would be of its size. Test: lua/test_liner. */
#define TURNED 1e-18
/* Tolerance: pivot over the entry of the diagonal that it comes from, below which it is rounding. Test:
 * lua/test_liner. */
#define NO_PIVOT 1e-11

static tl_vec3 column(const double *const of[3], uint32_t i)
{
    return tl_v3(of[0][i], of[1][i], of[2][i]);
}

/* ---------------------------------------------------------------- layout ----------------- */

/* Numbers of nodes, sides and freedoms, and where rows begin. */
typedef struct layout {
    uint32_t corners, nodes, freedoms;
    size_t entries;
    uint16_t node[CORNERS], side[CORNERS], freedom[CORNERS];
    double sign[CORNERS];
    size_t first[FREEDOMS];
} layout;

static uint32_t side_key(const layout *l, uint32_t corner)
{
    const uint32_t t = corner - corner % 3, a = l->node[t + (corner + 1) % 3], b = l->node[t + (corner + 2) % 3];
    return (a < b ? b : a) * CORNERS + (a < b ? a : b);
}

/* Corners in the order of the sides across them: by the higher node, then the lower one. */
static void order_sides(const layout *l, uint16_t *order)
{
    for (uint32_t k = 0; k < l->corners; k++) {
        uint32_t i = k;
        const uint32_t key = side_key(l, k);
        for (; i > 0 && side_key(l, order[i - 1]) > key; i--)
            order[i] = order[i - 1];
        order[i] = (uint16_t)k;
    }
}

/* Freedoms of each node, and of the sides that go back from it. */
static void number_freedoms(layout *l)
{
    uint16_t order[CORNERS];
    uint32_t next = 0, at = 0;
    order_sides(l, order);
    for (uint32_t node = 0; node < l->nodes; node++) {
        l->freedom[node] = (uint16_t)next;
        next += 3;
        for (uint32_t last = UINT32_MAX; at < l->corners && side_key(l, order[at]) / CORNERS == node; at++) {
            const uint32_t key = side_key(l, order[at]);
            next += key != last;
            last = key;
            l->side[order[at]] = (uint16_t)(next - 1);
        }
    }
    l->freedoms = next;
}

/* The freedoms of a facet, in its order. */
static void freedoms_of(const uint16_t *node, const uint16_t *side, const uint16_t *freedom, uint32_t triangle,
                        uint32_t out[FACET_FREEDOMS])
{
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t a = 0; a < 3; a++)
            out[3 * k + a] = freedom[node[3 * triangle + k]] + a;
        out[9 + k] = side[3 * triangle + k];
    }
}

static void find_rows(layout *l)
{
    for (uint32_t i = 0; i < l->freedoms; i++)
        l->first[i] = i;
    for (uint32_t t = 0; t < l->corners / 3; t++) {
        uint32_t of[FACET_FREEDOMS], least = UINT32_MAX;
        freedoms_of(l->node, l->side, l->freedom, t, of);
        for (int k = 0; k < FACET_FREEDOMS; k++)
            least = of[k] < least ? of[k] : least;
        for (int k = 0; k < FACET_FREEDOMS; k++)
            l->first[of[k]] = least < l->first[of[k]] ? least : l->first[of[k]];
    }
    l->entries = 0;
    for (uint32_t i = 0; i < l->freedoms; i++)
        l->entries += i - l->first[i];
}

static void lay(layout *l, const tl_element_batch *b, uint32_t e, const double *number)
{
    l->corners = (b->start[e + 1] - b->start[e]) / 3 * 3;
    l->nodes = 1;
    for (uint32_t k = 0; k < l->corners; k++) {
        const double given = number[b->start[e] + k]; /* of a file, it may be anything */
        l->node[k] = (uint16_t)(given >= 0 && given < l->corners ? given : 0);
        l->nodes = l->node[k] >= l->nodes ? l->node[k] + 1u : l->nodes;
    }
    for (uint32_t k = 0; k < l->corners; k++) {
        const uint32_t t = k - k % 3;
        l->sign[k] = l->node[t + (k + 1) % 3] < l->node[t + (k + 2) % 3] ? 1 : -1;
    }
    number_freedoms(l);
    find_rows(l);
}

/* The next piece of memory; NULL while bytes are only counted. */
static void *carve(unsigned char *block, size_t *at, size_t count, size_t size)
{
    void *piece = block ? block + *at : NULL;
    *at += (count * size + 63) / 64 * 64;
    return piece;
}

/* Gives the lists of a shell their places. */
static size_t spread(shell *s, unsigned char *block, const layout *l)
{
    size_t at = 0;
    carve(block, &at, 1, sizeof *s);
    s->node = carve(block, &at, l->corners, sizeof *s->node);
    s->side = carve(block, &at, l->corners, sizeof *s->side);
    s->freedom = carve(block, &at, l->nodes, sizeof *s->freedom);
    s->part = carve(block, &at, l->nodes, sizeof *s->part);
    s->held = carve(block, &at, l->corners, 1);
    s->torn = carve(block, &at, l->corners / 3, 1);
    s->counts = carve(block, &at, l->corners / 3, 1);
    s->sign = carve(block, &at, l->corners, sizeof *s->sign);
    s->facet = carve(block, &at, l->corners / 3, sizeof *s->facet);
    s->of = carve(block, &at, l->nodes, sizeof *s->of);
    s->q = carve(block, &at, l->freedoms, sizeof *s->q);
    s->d = carve(block, &at, l->corners, sizeof *s->d);
    s->force = carve(block, &at, l->corners, sizeof *s->force);
    s->matrix.first = carve(block, &at, l->freedoms, sizeof *s->matrix.first);
    s->matrix.start = carve(block, &at, l->freedoms, sizeof *s->matrix.start);
    s->matrix.diagonal = carve(block, &at, l->freedoms, sizeof(double));
    s->matrix.entry = carve(block, &at, l->entries, sizeof(double));
    return at;
}

size_t shell_bytes(const tl_element_batch *b, uint32_t e, const double *number)
{
    layout l;
    shell s;
    lay(&l, b, e, number);
    return spread(&s, NULL, &l);
}

/* Facets have the places of their nodes: those of the first corner at each. */
static void make_facets(shell *s, const tl_element_batch *b, uint32_t e)
{
    tl_vec3 at[CORNERS];
    for (uint32_t k = s->corners; k-- > 0;)
        at[s->node[k]] = column(b->rest, b->start[e] + k);
    for (uint32_t t = 0; t < s->corners / 3; t++) {
        const uint16_t *n = &s->node[3 * t];
        facet_make(&s->facet[t], (const tl_vec3[]){at[n[0]], at[n[1]], at[n[2]]}, &s->sign[3 * t]);
    }
}

shell *shell_open(void *memory, const tl_element_batch *b, uint32_t e, const double *number)
{
    shell *s = memory;
    if (s->laid)
        return s;
    layout l;
    size_t at = 0;
    lay(&l, b, e, number);
    spread(s, memory, &l);
    s->corners = l.corners;
    s->nodes = l.nodes;
    memcpy(s->node, l.node, l.corners * sizeof *s->node);
    memcpy(s->side, l.side, l.corners * sizeof *s->side);
    memcpy(s->freedom, l.freedom, l.nodes * sizeof *s->freedom);
    memcpy(s->sign, l.sign, l.corners * sizeof *s->sign);
    memcpy(s->matrix.first, l.first, l.freedoms * sizeof *l.first);
    for (uint32_t i = 0; i < l.freedoms; i++) {
        s->matrix.start[i] = at;
        at += i - l.first[i];
    }
    s->matrix.size = l.freedoms;
    make_facets(s, b, e);
    s->laid = true;
    s->factorised = false;
    return s;
}

/* ---------------------------------------------------------------- holding ---------------- */

static uint16_t root_of(shell *s, uint16_t node)
{
    while (s->part[node] != node)
        node = s->part[node] = s->part[s->part[node]];
    return node;
}

/* Finds the parts that hang together, and the facets that tell their motion: those that rock is left under, and the
 * bond holds somewhere. */
static void find_parts(shell *s, const tl_element_batch *b, uint32_t e)
{
    const double *weight = b->weight + b->start[e];
    for (uint32_t k = 0; k < s->nodes; k++)
        s->part[k] = (uint16_t)k;
    for (uint32_t t = 0; t < s->corners / 3; t++)
        for (uint32_t k = 1; s->torn[t] != SHELL_THROUGH && k < 3; k++) {
            const uint16_t one = root_of(s, s->node[3 * t]), other = root_of(s, s->node[3 * t + k]);
            s->part[one < other ? other : one] = one < other ? one : other;
        }
    for (uint32_t k = 0; k < s->nodes; k++)
        s->part[k] = root_of(s, (uint16_t)k);
    memset(s->of, 0, s->nodes * sizeof *s->of);
    for (uint32_t t = 0; t < s->corners / 3; t++) {
        const double *w = &weight[3 * t];
        const unsigned char *held = &s->held[3 * t];
        const bool bonded = held[0] == SHELL_BONDED || held[1] == SHELL_BONDED || held[2] == SHELL_BONDED;
        s->counts[t] = bonded && s->torn[t] != SHELL_THROUGH && w[0] > 0 && w[1] > 0 && w[2] > 0;
        shell_part *part = &s->of[s->part[s->node[3 * t]]];
        for (uint32_t k = 0; s->counts[t] && k < 3; k++) {
            part->weight += w[k];
            part->middle = tl_v3_madd(part->middle, w[k], column(b->rest, b->start[e] + 3 * t + k));
        }
    }
    for (uint32_t k = 0; k < s->nodes; k++)
        if (s->of[k].weight > 0)
            s->of[k].middle = tl_v3_scale(1 / s->of[k].weight, s->of[k].middle);
}

static const shell_part *part_of(const shell *s, uint32_t corner)
{
    return &s->of[s->part[s->node[corner]]];
}

/* Stiffness of the bond at a corner, Pa/m: across and along it. */
static void bond_of(const shell *s, const shell_material *of, uint32_t corner, double k[2])
{
    const bool active = s->held[corner] != SHELL_FREE && part_of(s, corner)->weight > 0;
    k[0] = active ? of->normal : 0;
    k[1] = active && s->held[corner] == SHELL_BONDED ? of->shear : 0;
}

static void add_entry(shell *s, uint32_t i, uint32_t j, double value)
{
    if (i == j)
        s->matrix.diagonal[i] += value;
    else if (i > j)
        s->matrix.entry[s->matrix.start[i] + (j - s->matrix.first[i])] += value;
}

static void assemble(shell *s, const double *weight, const shell_material *of)
{
    const size_t last = s->matrix.size - 1;
    memset(s->matrix.entry, 0, (s->matrix.start[last] + (last - s->matrix.first[last])) * sizeof(double));
    memset(s->matrix.diagonal, 0, s->matrix.size * sizeof(double));
    for (uint32_t t = 0; t < s->corners / 3; t++) {
        double matrix[FACET_FREEDOMS][FACET_FREEDOMS];
        uint32_t at[FACET_FREEDOMS];
        facet_stiffness left = of->facet;
        left.membrane *= s->torn[t] != SHELL_THROUGH;
        left.bending *= s->torn[t] == SHELL_SOUND;
        facet_matrix(&s->facet[t], &left, matrix);
        freedoms_of(s->node, s->side, s->freedom, t, at);
        for (int i = 0; i < FACET_FREEDOMS; i++)
            for (int j = 0; j < FACET_FREEDOMS; j++)
                add_entry(s, at[i], at[j], matrix[i][j]);
        const double n[3] = {s->facet[t].normal.x, s->facet[t].normal.y, s->facet[t].normal.z};
        for (uint32_t c = 3 * t; c < 3 * t + 3; c++) {
            double k[2];
            bond_of(s, of, c, k);
            for (uint32_t i = 0; i < 3; i++)
                for (uint32_t j = 0; j < 3; j++)
                    add_entry(s, s->freedom[s->node[c]] + i, s->freedom[s->node[c]] + j,
                              weight[c] * ((i == j ? k[1] : 0) + (k[0] - k[1]) * n[i] * n[j]));
        }
    }
}

void shell_hold(shell *s, const tl_element_batch *b, uint32_t e, const shell_material *of, const unsigned char *held,
                const unsigned char *torn)
{
    if (s->factorised && memcmp(s->held, held, s->corners) == 0 && memcmp(s->torn, torn, s->corners / 3) == 0)
        return;
    memcpy(s->held, held, s->corners);
    memcpy(s->torn, torn, s->corners / 3);
    find_parts(s, b, e);
    assemble(s, b->weight + b->start[e], of);
    (void)tl_skyline_factor(&s->matrix, NO_PIVOT);
    s->factorised = true;
}

/* ---------------------------------------------------------------- motion ----------------- */

/* Adds a b^t. */
static void add_product(tl_mat3 *to, double w, tl_vec3 a, tl_vec3 b)
{
    const double x[3] = {w * a.x, w * a.y, w * a.z}, y[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            to->m[i][j] += x[i] * y[j];
}

/* J of the rotation, by the sums of w y X^t; and the vector that J takes to a given one. */
static tl_vec3 turn_by(const tl_mat3 *sum, tl_vec3 moment)
{
    const double trace = sum->m[0][0] + sum->m[1][1] + sum->m[2][2];
    tl_mat3 j = tl_m3_identity();
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            j.m[i][k] = (i == k ? trace : 0) - sum->m[i][k];
    const tl_vec3 a = tl_m3_column(&j, 0), b = tl_m3_column(&j, 1), c = tl_m3_column(&j, 2), bc = tl_v3_cross(b, c);
    const double volume = tl_v3_dot(a, bc);
    if (!(fabs(volume) > 0))
        return tl_v3(0, 0, 0);
    return tl_v3_scale(1 / volume, tl_v3(tl_v3_dot(moment, bc), tl_v3_dot(a, tl_v3_cross(moment, c)),
                                         tl_v3_dot(a, tl_v3_cross(b, moment))));
}

/* Axes of a triangle, as columns. */
static tl_mat3 axes_of(tl_vec3 a, tl_vec3 b, tl_vec3 c)
{
    const tl_vec3 x = tl_v3_unit(tl_v3_sub(b, a)), n = tl_v3_unit(tl_v3_cross(x, tl_v3_sub(c, a)));
    return tl_m3_of_rows(x, tl_v3_cross(n, x), n);
}

/* From the rotation of one facet to that of the part. */
static void find_turn(shell_part *p, tl_mat3 begin)
{
    p->turn = begin;
    for (int round = 0; round < ROUNDS; round++) {
        const tl_mat3 y = tl_m3_tproduct(&p->turn, &p->sum);
        const tl_vec3 off = {y.m[2][1] - y.m[1][2], y.m[0][2] - y.m[2][0], y.m[1][0] - y.m[0][1]};
        const tl_vec3 turn = turn_by(&y, off);
        const tl_mat3 more = tl_q_matrix(tl_q_unit((tl_quat){1, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z}));
        p->turn = tl_m3_product(&p->turn, &more);
        if (tl_v3_norm2(turn) < TURNED)
            break;
    }
}

/* Shifts and rotations of all parts. */
static void follow(shell *s, const tl_element_batch *b, uint32_t e)
{
    const uint32_t first = b->start[e];
    for (uint32_t k = 0; k < s->nodes; k++)
        s->of[k].shift = s->of[k].net = s->of[k].moment = tl_v3(0, 0, 0);
    for (uint32_t c = 0; c < s->corners; c++) {
        shell_part *p = &s->of[s->part[s->node[c]]];
        if (s->counts[c / 3])
            p->shift = tl_v3_madd(p->shift, b->weight[first + c] / p->weight, column(b->u, first + c));
    }
    for (uint32_t k = 0; k < s->nodes; k++)
        memset(&s->of[k].sum, 0, sizeof s->of[k].sum);
    for (uint32_t c = 0; c < s->corners; c++) {
        shell_part *p = &s->of[s->part[s->node[c]]];
        const tl_vec3 rest = tl_v3_sub(column(b->rest, first + c), p->middle);
        const tl_vec3 now = tl_v3_add(rest, tl_v3_sub(column(b->u, first + c), p->shift));
        if (s->counts[c / 3])
            add_product(&p->sum, b->weight[first + c], now, rest);
    }
    for (uint32_t k = 0; k < s->nodes; k++)
        s->of[k].spread = tl_v3(s->of[k].weight > 0, 0, 0);
    for (uint32_t t = 0; t < s->corners / 3; t++) {
        shell_part *p = &s->of[s->part[s->node[3 * t]]];
        if (!s->counts[t] || p->spread.x == 0)
            continue;
        tl_vec3 x[3], y[3];
        for (uint32_t k = 0; k < 3; k++) {
            x[k] = column(b->rest, first + 3 * t + k);
            y[k] = tl_v3_add(x[k], column(b->u, first + 3 * t + k));
        }
        const tl_mat3 before = axes_of(x[0], x[1], x[2]), now = axes_of(y[0], y[1], y[2]);
        find_turn(p, tl_m3_tproduct(&now, &before));
        p->spread.x = 0;
    }
}

/* Displacement of the rock at a corner in the frame of its part. */
static tl_vec3 displaced(const shell_part *p, tl_vec3 rest, tl_vec3 u)
{
    const tl_vec3 from = tl_v3_sub(rest, p->middle);
    const tl_vec3 turned = tl_v3_sub(tl_m3_tmul(&p->turn, from), from);
    return tl_v3_add(tl_m3_tmul(&p->turn, tl_v3_sub(u, p->shift)), turned);
}

static tl_vec3 spring(const double k[2], double w, tl_vec3 n, tl_vec3 x)
{
    return tl_v3_madd(tl_v3_scale(w * k[1], x), w * (k[0] - k[1]) * tl_v3_dot(n, x), n);
}

static tl_vec3 moved(const shell *s, uint32_t corner)
{
    const double *q = &s->q[s->freedom[s->node[corner]]];
    return tl_v3(q[0], q[1], q[2]);
}

double shell_solve(shell *s, const tl_element_batch *b, uint32_t e, const shell_material *of)
{
    const uint32_t first = b->start[e];
    double energy = 0;
    follow(s, b, e);
    memset(s->q, 0, s->matrix.size * sizeof *s->q);
    for (uint32_t c = 0; c < s->corners; c++) {
        const shell_part *p = part_of(s, c);
        double k[2], *q = &s->q[s->freedom[s->node[c]]];
        bond_of(s, of, c, k);
        s->d[c] = p->weight > 0 ? displaced(p, column(b->rest, first + c), column(b->u, first + c)) : tl_v3(0, 0, 0);
        const tl_vec3 pull = spring(k, b->weight[first + c], s->facet[c / 3].normal, s->d[c]);
        q[0] += pull.x;
        q[1] += pull.y;
        q[2] += pull.z;
    }
    tl_skyline_solve(&s->matrix, s->q);
    for (uint32_t c = 0; c < s->corners; c++) {
        shell_part *p = &s->of[s->part[s->node[c]]];
        double k[2];
        bond_of(s, of, c, k);
        const tl_vec3 apart = tl_v3_sub(s->d[c], moved(s, c));
        s->force[c] = spring(k, b->weight[first + c], s->facet[c / 3].normal, apart);
        energy += 0.5 * tl_v3_dot(s->force[c], s->d[c]);
        const tl_vec3 at = tl_v3_add(tl_v3_sub(column(b->rest, first + c), p->middle), s->d[c]);
        p->net = tl_v3_add(p->net, s->force[c]);
        p->moment = tl_v3_add(p->moment, tl_v3_cross(at, s->force[c]));
    }
    return energy;
}

/* ---------------------------------------------------------------- results ---------------- */

void shell_bond(const shell *s, const shell_material *of, uint32_t corner, double *tension, double *shear)
{
    const tl_vec3 n = s->facet[corner / 3].normal, apart = tl_v3_sub(moved(s, corner), s->d[corner]);
    const double open = tl_v3_dot(apart, n);
    const bool held = part_of(s, corner)->weight > 0;
    *tension = held ? of->normal * open : 0;
    *shear = held ? of->shear * tl_v3_norm(tl_v3_madd(apart, -open, n)) : 0;
}

void shell_stress(const shell *s, const shell_material *of, uint32_t triangle, double force[3], double moment[3])
{
    const facet *f = &s->facet[triangle];
    uint32_t at[FACET_FREEDOMS];
    double strain[3] = {0, 0, 0}, curvature[3] = {0, 0, 0};
    freedoms_of(s->node, s->side, s->freedom, triangle, at);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 9; k++)
            strain[i] += f->membrane[i][k] * s->q[at[k]];
        for (int k = 0; k < FACET_FREEDOMS; k++)
            curvature[i] += f->bending[i][k] * s->q[at[k]];
    }
    facet_stress(s->torn[triangle] != SHELL_THROUGH ? of->facet.membrane : 0, of->facet.poisson, strain, force);
    facet_stress(s->torn[triangle] == SHELL_SOUND ? of->facet.bending : 0, of->facet.poisson, curvature, moment);
}

void shell_push(const shell *s, const tl_element_batch *b, uint32_t e)
{
    const uint32_t first = b->start[e];
    for (uint32_t k = 0; k < s->nodes; k++)
        if (s->of[k].weight > 0) {
            const tl_mat3 y = tl_m3_tproduct(&s->of[k].turn, &s->of[k].sum);
            s->of[k].spread = turn_by(&y, s->of[k].moment);
        }
    for (uint32_t c = 0; c < s->corners; c++) {
        const shell_part *p = part_of(s, c);
        tl_vec3 f = s->force[c];
        if (s->counts[c / 3]) {
            const tl_vec3 rest = tl_v3_sub(column(b->rest, first + c), p->middle);
            f = tl_v3_madd(f, -b->weight[first + c] / p->weight, p->net);
            f = tl_v3_madd(f, -b->weight[first + c], tl_v3_cross(p->spread, rest));
        }
        f = p->weight > 0 ? tl_v3_neg(tl_m3_mul(&p->turn, f)) : tl_v3(0, 0, 0);
        b->force[0][first + c] = f.x;
        b->force[1][first + c] = f.y;
        b->force[2][first + c] = f.z;
    }
}
