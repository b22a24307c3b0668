/* polar.c - the rotation in a gradient, and the quaternion of a rotation.
 *
 * R <- (R + R^-T) / 2 converges quadratically to the rotation next to R (N. J. Higham, SIAM J. Sci. Stat. Comput. 7
 * (1986) 1160-1174). */
#include "geometry/polar.h"

#include <math.h>

/* Steps of the iteration: a gradient stretched by 1000 takes 14. */
#define STEPS 20
/* Tolerance: change of a component of R in a step with which the iteration ends: what is left is its square. */
#define SETTLED 1e-9

static tl_vec3 row_of(const tl_mat3 *a, int i)
{
    return tl_v3(a->m[i][0], a->m[i][1], a->m[i][2]);
}

double tl_m3_determinant(const tl_mat3 *a)
{
    return tl_v3_dot(row_of(a, 0), tl_v3_cross(row_of(a, 1), row_of(a, 2)));
}

tl_mat3 tl_m3_inverse(const tl_mat3 *a)
{
    const tl_vec3 x = tl_v3_cross(row_of(a, 1), row_of(a, 2)), y = tl_v3_cross(row_of(a, 2), row_of(a, 0));
    const tl_vec3 z = tl_v3_cross(row_of(a, 0), row_of(a, 1));
    const double per = 1 / tl_v3_dot(row_of(a, 0), x);
    return (tl_mat3){
        {{per * x.x, per * y.x, per * z.x}, {per * x.y, per * y.y, per * z.y}, {per * x.z, per * y.z, per * z.z}}};
}

tl_mat3 tl_m3_polar(const tl_mat3 *f)
{
    tl_mat3 r = *f;
    for (int k = 0; k < STEPS; k++) {
        const tl_mat3 inverse = tl_m3_inverse(&r);
        double change = 0;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const double next = 0.5 * (r.m[i][j] + inverse.m[j][i]);
                change = fmax(change, fabs(next - r.m[i][j]));
                r.m[i][j] = next;
            }
        if (change < SETTLED)
            break;
    }
    return r;
}

/* From the largest of its four squares, so that no digits are lost. */
tl_quat tl_q_of_matrix(const tl_mat3 *r)
{
    const double(*m)[3] = (const double(*)[3])r->m;
    const double w = 1 + m[0][0] + m[1][1] + m[2][2], x = 1 + m[0][0] - m[1][1] - m[2][2];
    const double y = 1 - m[0][0] + m[1][1] - m[2][2], z = 1 - m[0][0] - m[1][1] + m[2][2];
    tl_quat q;
    if (w >= x && w >= y && w >= z)
        q = (tl_quat){w, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
    else if (x >= y && x >= z)
        q = (tl_quat){m[2][1] - m[1][2], x, m[0][1] + m[1][0], m[2][0] + m[0][2]};
    else if (y >= z)
        q = (tl_quat){m[0][2] - m[2][0], m[0][1] + m[1][0], y, m[1][2] + m[2][1]};
    else
        q = (tl_quat){m[1][0] - m[0][1], m[2][0] + m[0][2], m[1][2] + m[2][1], z};
    const double size = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z), per = (q.w < 0 ? -1 : 1) / size;
    return (tl_quat){per * q.w, per * q.x, per * q.y, per * q.z};
}
