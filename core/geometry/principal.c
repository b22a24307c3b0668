/* principal.c - principal moments and axes of a symmetric tensor by Jacobi's cyclic rotations
 * (Golub and Van Loan, Matrix Computations, section 8.5).
 *
 * Off-diagonal terms at the level of rounding are zero. So the axes of a cube stay its own, and a diagonal tensor is
 * only put in order. Its moments are then the very numbers given. */
#include "geometry/principal.h"

#include "geometry/polyhedron.h"

#include <float.h>
#include <talus/vmath.h>

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
