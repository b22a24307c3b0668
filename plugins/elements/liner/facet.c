/* facet.c - a flat triangle of a shell, with constant strain and constant moment.
 *
 * In the plane it is the constant-strain triangle. Across it the deflection w is quadratic (Morley 1968; as
 * a facet of shells Dawe 1972). It is given by w at the corners and by the rotation p of the shell about the middle of
 * each side. Let n be the outward normal of a side of length l, and q the slope of the plane through the corners. The
 * curvature is
 *
 *     k = (1 / A) sum l (dw/dn - q.n) n n^t,    dw/dn = -p
 *
 * which is exact for each quadratic w. The rotation about a side is the same for both facets that meet there, in one
 * plane or at a fold. So the shell needs neither rotations of nodes nor a stiffness against drilling. A side that
 * belongs to one facet bears no moment. */
#include "facet.h"

#include <math.h>
#include <string.h>
#include <talus/vmath.h>

static const int AXES = 3;

static double component(tl_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

void facet_make(facet *f, const tl_vec3 at[3], const double sign[3])
{
    const tl_vec3 twice = tl_v3_cross(tl_v3_sub(at[1], at[0]), tl_v3_sub(at[2], at[0]));
    memset(f, 0, sizeof *f);
    f->area = 0.5 * tl_v3_norm(twice);
    f->normal = tl_v3_unit(twice);
    const tl_vec3 x = tl_v3_unit(tl_v3_sub(at[1], at[0])), y = tl_v3_cross(f->normal, x);
    double gx[3], gy[3], nx[3], ny[3], length[3]; /* gradients of the corners' shares, normals of the sides */
    for (int k = 0; k < 3; k++) {
        const tl_vec3 way = tl_v3_sub(at[(k + 2) % 3], at[(k + 1) % 3]);
        const double wx = tl_v3_dot(way, x), wy = tl_v3_dot(way, y);
        length[k] = tl_v3_norm(way);
        nx[k] = wy / length[k];
        ny[k] = -wx / length[k];
        gx[k] = -nx[k] * length[k] / (2 * f->area);
        gy[k] = -ny[k] * length[k] / (2 * f->area);
    }
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < AXES; a++) {
            const int freedom = AXES * k + a;
            f->membrane[0][freedom] = gx[k] * component(x, a);
            f->membrane[1][freedom] = gy[k] * component(y, a);
            f->membrane[2][freedom] = gy[k] * component(x, a) + gx[k] * component(y, a);
        }
    for (int j = 0; j < 3; j++) {
        const double share = length[j] / f->area, part[3] = {nx[j] * nx[j], ny[j] * ny[j], 2 * nx[j] * ny[j]};
        for (int i = 0; i < 3; i++) {
            f->bending[i][9 + j] -= share * sign[j] * part[i];
            for (int k = 0; k < 3; k++)
                for (int a = 0; a < AXES; a++)
                    f->bending[i][AXES * k + a] -=
                        share * (nx[j] * gx[k] + ny[j] * gy[k]) * component(f->normal, a) * part[i];
        }
    }
}

void facet_stress(double modulus, double poisson, const double strain[3], double stress[3])
{
    stress[0] = modulus * (strain[0] + poisson * strain[1]);
    stress[1] = modulus * (strain[1] + poisson * strain[0]);
    stress[2] = modulus * 0.5 * (1 - poisson) * strain[2];
}

void facet_principal(const double stress[3], double value[2])
{
    const double mean = 0.5 * (stress[0] + stress[1]), half = 0.5 * (stress[0] - stress[1]);
    const double radius = sqrt(half * half + stress[2] * stress[2]);
    value[0] = mean + radius;
    value[1] = mean - radius;
}

/* Adds B^t D B A for the first `count` freedoms. */
static void add(double *matrix, int count, const double *b, double modulus, const facet_stiffness *of, double area)
{
    double db[3][FACET_FREEDOMS];
    for (int j = 0; j < count; j++) {
        double stress[3];
        facet_stress(modulus, of->poisson, (const double[]){b[j], b[count + j], b[2 * count + j]}, stress);
        for (int i = 0; i < 3; i++)
            db[i][j] = area * stress[i];
    }
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++)
            for (int k = 0; k < 3; k++)
                matrix[FACET_FREEDOMS * i + j] += b[k * count + i] * db[k][j];
}

void facet_matrix(const facet *f, const facet_stiffness *of, double matrix[FACET_FREEDOMS][FACET_FREEDOMS])
{
    memset(matrix, 0, FACET_FREEDOMS * FACET_FREEDOMS * sizeof(double));
    if (of->membrane > 0)
        add(matrix[0], 9, f->membrane[0], of->membrane, of, f->area);
    if (of->bending > 0)
        add(matrix[0], FACET_FREEDOMS, f->bending[0], of->bending, of, f->area);
}
