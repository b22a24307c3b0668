/* measure.c - what a polyhedron measures: mass properties, bounds, faces, support, containment;
 * principal axes of its inertia.
 *
 * Volume integrals are sums over the tetrahedra from one vertex O to a fan of triangles (a, b, c)
 * of every face. With D = a . (b x c) relative to O and s = a + b + c, a tetrahedron has:
 *
 *     volume D / 6,   first moment D s / 24,   second moments D (s s' + a a' + b b' + c c') / 120.
 *
 * They are exact for any position (Tonon 2004, "Explicit exact formulas for the 3-D tetrahedron inertia tensor",
 * eqs. 3-10). Second moments are moved to the centroid by the parallel axis theorem. About a vertex of the body that
 * costs a factor of 4 in rounding at most, wherever the body stands. The volume of a block that is flat or long
 * compared with its size is summed anew with twice the digits.
 * Products of inertia have the sign of the tensor: xy = -integral of x y. */
#include "geometry/measure.h"

#include <float.h>
#include <math.h>
#include <talus/vmath.h>

/* Integrals over a body: of 1, of x, and of x x' (xx, yy, zz, xy, yz, zx). */
typedef struct integrals {
    double volume;
    tl_vec3 first;
    tl_sym3 second;
} integrals;

/* Adds s v v' to the second moments. */
static void add_square(tl_sym3 *m, double s, tl_vec3 v)
{
    m->xx += s * v.x * v.x;
    m->yy += s * v.y * v.y;
    m->zz += s * v.z * v.z;
    m->xy += s * v.x * v.y;
    m->yz += s * v.y * v.z;
    m->zx += s * v.z * v.x;
}

/* Six times the volume, twenty-four times the first and 120 times the second moments. */
static void add_tetrahedron(integrals *m, tl_vec3 a, tl_vec3 b, tl_vec3 c)
{
    double det = tl_v3_dot(a, tl_v3_cross(b, c));
    tl_vec3 sum = tl_v3_add(tl_v3_add(a, b), c);
    m->volume += det;
    m->first = tl_v3_madd(m->first, det, sum);
    add_square(&m->second, det, sum);
    add_square(&m->second, det, a);
    add_square(&m->second, det, b);
    add_square(&m->second, det, c);
}

/* ---- the volume of flat and long blocks ---- */

/* Tolerance: blocks of less than this times the cube of their size (a cube has 0.19). Their volume is what is
 * left of tetrahedra a thousand times and more as large, and those are summed with twice the digits. */
#define SLENDER 1e-3

/* A sum with what rounding has left out of it so far. */
typedef struct long_sum {
    double high, low;
} long_sum;

/* Adds a b c. Products are exact but for the last digits of `low`, the sum is without loss. (Ogita, Rump
 * and Oishi 2005, "Accurate sum and dot product", algorithms 3.1, 3.5 and 5.3). */
static void add_product(long_sum *s, double a, double b, double c)
{
    double bc = b * c, abc = a * bc;
    double left = fma(a, bc, -abc) + a * fma(b, c, -bc);
    double sum = s->high + abc, part = sum - s->high;
    s->low += left + ((s->high - (sum - part)) + (abc - part));
    s->high = sum;
}

/* A coordinate to subtract from all others without rounding: they are within half of it and twice it, or it is zero. */
static double far_part(double coordinate, double size)
{
    return fabs(coordinate) >= 2 * size ? coordinate : 0;
}

static double long_volume(const tl_poly *p)
{
    long_sum six = {0, 0};
    tl_vec3 o = p->vertex[0];
    o = tl_v3(far_part(o.x, p->size), far_part(o.y, p->size), far_part(o.z, p->size));
    for (uint32_t f = 0; f < p->face_count; f++) {
        const uint16_t *loop = p->loop + p->start[f];
        tl_vec3 a = tl_v3_sub(p->vertex[loop[0]], o);
        for (uint32_t i = 1; i + 1 < tl_poly_face_size(p, f); i++) {
            tl_vec3 b = tl_v3_sub(p->vertex[loop[i]], o), c = tl_v3_sub(p->vertex[loop[i + 1]], o);
            add_product(&six, a.x, b.y, c.z);
            add_product(&six, -a.x, b.z, c.y);
            add_product(&six, a.y, b.z, c.x);
            add_product(&six, -a.y, b.x, c.z);
            add_product(&six, a.z, b.x, c.y);
            add_product(&six, -a.z, b.y, c.x);
        }
    }
    return (six.high + six.low) / 6;
}

/* ---- mass properties ---- */

/* A face through the vertex O makes tetrahedra without volume: for a box half of all. */
static bool has_first_vertex(const uint16_t *loop, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++)
        if (loop[i] == 0)
            return true;
    return false;
}

tl_mass tl_poly_mass(const tl_poly *p)
{
    integrals m = {0};
    tl_vec3 origin = p->vertex[0];
    for (uint32_t f = 0; f < p->face_count; f++) {
        const uint16_t *loop = p->loop + p->start[f];
        uint32_t n = tl_poly_face_size(p, f);
        if (has_first_vertex(loop, n))
            continue;
        tl_vec3 a = tl_v3_sub(p->vertex[loop[0]], origin), b = tl_v3_sub(p->vertex[loop[1]], origin);
        for (uint32_t i = 2; i < n; i++) {
            tl_vec3 c = tl_v3_sub(p->vertex[loop[i]], origin);
            add_tetrahedron(&m, a, b, c);
            b = c;
        }
    }
    tl_mass mass = {.volume = m.volume / 6};
    if (mass.volume < SLENDER * p->size * p->size * p->size)
        mass.volume = long_volume(p);
    tl_vec3 arm = tl_v3(m.first.x / (4 * m.volume), m.first.y / (4 * m.volume), m.first.z / (4 * m.volume));
    mass.centroid = tl_v3_add(origin, arm);
    /* Second moments about the centroid, then the inertia tensor from them. */
    tl_sym3 s = m.second;
    double v = mass.volume;
    double xx = s.xx / 120 - v * arm.x * arm.x, yy = s.yy / 120 - v * arm.y * arm.y;
    double zz = s.zz / 120 - v * arm.z * arm.z;
    mass.inertia = (tl_sym3){.xx = yy + zz,
                             .yy = zz + xx,
                             .zz = xx + yy,
                             .xy = v * arm.x * arm.y - s.xy / 120,
                             .yz = v * arm.y * arm.z - s.yz / 120,
                             .zx = v * arm.z * arm.x - s.zx / 120};
    return mass;
}

tl_vec3 tl_points_mean(const tl_vec3 *points, size_t count)
{
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        sum = tl_v3_add(sum, points[i]);
    return tl_v3_scale(1.0 / (double)count, sum);
}

tl_bounds tl_points_bounds(const tl_vec3 *points, size_t count)
{
    tl_bounds bounds = {points[0], points[0]};
    for (size_t i = 1; i < count; i++) {
        bounds.min = tl_v3_min(bounds.min, points[i]);
        bounds.max = tl_v3_max(bounds.max, points[i]);
    }
    return bounds;
}

void tl_poly_find_size(tl_poly *p)
{
    tl_bounds bounds = tl_poly_bounds(p);
    p->size = tl_v3_norm(tl_v3_sub(bounds.max, bounds.min));
}

/* Twice the area of the fan triangle i of a face, signed by the face's normal. */
static double fan_area2(const tl_poly *p, uint32_t face, uint32_t i)
{
    const uint16_t *loop = p->loop + p->start[face];
    tl_vec3 base = p->vertex[loop[0]];
    return tl_v3_dot(p->plane[face].normal,
                     tl_v3_cross(tl_v3_sub(p->vertex[loop[i]], base), tl_v3_sub(p->vertex[loop[i + 1]], base)));
}

double tl_poly_face_area(const tl_poly *p, uint32_t face)
{
    double area2 = 0;
    for (uint32_t i = 1; i + 1 < tl_poly_face_size(p, face); i++)
        area2 += fan_area2(p, face, i);
    return 0.5 * area2;
}

tl_vec3 tl_poly_face_centroid(const tl_poly *p, uint32_t face)
{
    const uint16_t *loop = p->loop + p->start[face];
    uint32_t n = tl_poly_face_size(p, face);
    tl_vec3 base = p->vertex[loop[0]], sum = {0, 0, 0};
    double area2 = 0;
    for (uint32_t i = 1; i + 1 < n; i++) {
        double w = fan_area2(p, face, i);
        tl_vec3 arm = tl_v3_add(tl_v3_sub(p->vertex[loop[i]], base), tl_v3_sub(p->vertex[loop[i + 1]], base));
        area2 += w;
        sum = tl_v3_madd(sum, w, arm);
    }
    /* A face without area, such as a sliver may have, has its first vertex for a centroid. */
    return area2 > 0 ? tl_v3_add(base, tl_v3(sum.x / (3 * area2), sum.y / (3 * area2), sum.z / (3 * area2))) : base;
}

double tl_poly_shortest_edge(const tl_poly *p)
{
    double shortest2 = INFINITY;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_vec3 along = tl_v3_sub(p->vertex[p->edge[e].b], p->vertex[p->edge[e].a]);
        double length2 = tl_v3_norm2(along);
        shortest2 = length2 < shortest2 ? length2 : shortest2;
    }
    return sqrt(shortest2);
}

double tl_poly_smallest_face(const tl_poly *p)
{
    double smallest = INFINITY;
    for (uint32_t f = 0; f < p->face_count; f++)
        smallest = fmin(smallest, tl_poly_face_area(p, f));
    return smallest;
}

double tl_poly_diameter(const tl_poly *p)
{
    double longest2 = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        for (uint32_t k = i + 1; k < p->vertex_count; k++)
            longest2 = fmax(longest2, tl_v3_norm2(tl_v3_sub(p->vertex[k], p->vertex[i])));
    return sqrt(longest2);
}

double tl_poly_thickness(const tl_poly *p)
{
    double thinnest = INFINITY;
    for (uint32_t f = 0; f < p->face_count; f++) {
        double deepest = 0;
        tl_vec3 on = p->vertex[p->loop[p->start[f]]];
        for (uint32_t v = 0; v < p->vertex_count; v++)
            deepest = fmax(deepest, tl_v3_dot(p->plane[f].normal, tl_v3_sub(on, p->vertex[v])));
        thinnest = fmin(thinnest, deepest);
    }
    return thinnest;
}

bool tl_poly_contains(const tl_poly *p, tl_vec3 point, double tolerance)
{
    for (uint32_t f = 0; f < p->face_count; f++)
        if (!(tl_v3_dot(p->plane[f].normal, point) - p->plane[f].offset <= tolerance))
            return false;
    return true;
}

/* ---------------------------------------------------------------- principal axes ---------
 *
 * By Jacobi's cyclic rotations (Golub and Van Loan, Matrix Computations, section 8.5). Off-diagonal terms at the level
 * of rounding are zero. So the axes of a cube stay its own, and a diagonal tensor is only put in order. Its moments are
 * then the very numbers given. */

/* Tolerance: an off-diagonal term below this times the geometric mean of its two diagonal terms is rounding. Leaving
 * it changes either moment by a few roundings of that moment. */
#define OFF_DIAGONAL (8 * DBL_EPSILON)
/* Convergence is quadratic: four sweeps do for any 3 x 3 matrix, the rest is a guard. */
#define MAX_SWEEPS 32

/* Turns rows and columns p and q of `a` so that a[p][q] vanishes, and columns of `r` with them. */
static inline void rotate(tl_mat3 *a, tl_mat3 *r, int p, int q)
{
    double theta = (a->m[q][q] - a->m[p][p]) / (2 * a->m[p][q]);
    /* theta is at most 1e21 for the thinnest block, so its square does not overflow */
    double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    int k = 3 - p - q;
    a->m[p][p] -= t * a->m[p][q];
    a->m[q][q] += t * a->m[p][q];
    a->m[p][q] = a->m[q][p] = 0;
    double kp = a->m[k][p], kq = a->m[k][q];
    a->m[k][p] = a->m[p][k] = c * kp - s * kq;
    a->m[k][q] = a->m[q][k] = s * kp + c * kq;
    for (int i = 0; i < 3; i++) {
        double ip = r->m[i][p], iq = r->m[i][q];
        r->m[i][p] = c * ip - s * iq;
        r->m[i][q] = s * ip + c * iq;
    }
}

/* Rotates unless a[p][q] is rounding; whether it did. */
static inline bool sweep_pair(tl_mat3 *a, tl_mat3 *r, int p, int q)
{
    double mean2 = fabs(a->m[p][p] * a->m[q][q]);
    bool turn = a->m[p][q] * a->m[p][q] > OFF_DIAGONAL * OFF_DIAGONAL * mean2;
    if (turn)
        rotate(a, r, p, q);
    return turn;
}

/* The unit quaternion of a rotation matrix, w >= 0, by its largest component (Shepperd 1978). */
static tl_quat quaternion(const tl_mat3 *r)
{
    double x = r->m[0][0], y = r->m[1][1], z = r->m[2][2];
    double yz = r->m[2][1] - r->m[1][2], zx = r->m[0][2] - r->m[2][0], xy = r->m[1][0] - r->m[0][1];
    double sxy = r->m[0][1] + r->m[1][0], syz = r->m[1][2] + r->m[2][1];
    double szx = r->m[2][0] + r->m[0][2];
    tl_quat q;
    if (x + y + z >= fmax(x, fmax(y, z)))
        q = (tl_quat){1 + x + y + z, yz, zx, xy};
    else if (x >= y && x >= z)
        q = (tl_quat){yz, 1 + x - y - z, sxy, szx};
    else if (y >= z)
        q = (tl_quat){zx, sxy, 1 - x + y - z, syz};
    else
        q = (tl_quat){xy, szx, syz, 1 - x - y + z};
    q = tl_q_unit(q);
    return q.w < 0 ? (tl_quat){-q.w, -q.x, -q.y, -q.z} : q;
}

/* Column `from` of `r` as a unit vector whose largest component is positive. */
static tl_vec3 axis(const tl_mat3 *r, int from)
{
    tl_vec3 v = tl_m3_column(r, from);
    double ax = fabs(v.x), ay = fabs(v.y), az = fabs(v.z);
    double largest = ax >= ay && ax >= az ? v.x : ay >= az ? v.y : v.z;
    return largest < 0 ? tl_v3_neg(v) : v;
}

void tl_principal_axes(tl_sym3 tensor, tl_vec3 *moments, tl_quat *axes)
{
    tl_mat3 a = {
        {{tensor.xx, tensor.xy, tensor.zx}, {tensor.xy, tensor.yy, tensor.yz}, {tensor.zx, tensor.yz, tensor.zz}}};
    tl_mat3 r = tl_m3_identity();
    bool turned = true;
    for (int sweep = 0; sweep < MAX_SWEEPS && turned; sweep++) {
        /* with p and q known to the compiler the matrices stay in registers */
        bool first = sweep_pair(&a, &r, 0, 1);
        bool second = sweep_pair(&a, &r, 0, 2);
        bool third = sweep_pair(&a, &r, 1, 2);
        turned = first || second || third;
    }
    /* Ascending order; equal moments keep theirs. */
    int order[3] = {0, 1, 2};
    for (int i = 1; i < 3; i++)
        for (int j = i; j > 0 && a.m[order[j]][order[j]] < a.m[order[j - 1]][order[j - 1]]; j--) {
            int swap = order[j];
            order[j] = order[j - 1];
            order[j - 1] = swap;
        }
    *moments = tl_v3(a.m[order[0]][order[0]], a.m[order[1]][order[1]], a.m[order[2]][order[2]]);
    tl_vec3 first = axis(&r, order[0]), second = axis(&r, order[1]), third = axis(&r, order[2]);
    if (tl_v3_dot(tl_v3_cross(first, second), third) < 0)
        third = tl_v3_neg(third);
    tl_mat3 rotation = {{{first.x, second.x, third.x}, {first.y, second.y, third.y}, {first.z, second.z, third.z}}};
    *axes = quaternion(&rotation);
}
