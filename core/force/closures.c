/* closures.c - two closures that stand for all of what presses.
 *
 * Those of Gauss for the weight u,
 *
 *     u_1, u_2 = m + d/2 (g -+ (g^2 + 4)^(1/2)),   I_n = int u^n dA
 *     m = I_2 / I_1,   d^2 = I_3 / I_1 - m^2,   g d^3 = I_4 / I_1 - 3 m I_3 / I_1 + 2 m^3
 *
 * with the weights that give I_1 and I_2 give I_3 and I_4, too. */
#include "force/closures.h"

#include <math.h>

/* Tolerance: the least d of m: less, and the two closures could not be told apart. */
#define LEAST_SPREAD 0.01

void tl_two_closures(const double moment[4], double closure[2])
{
    double by = 1 / moment[0], mean = by * moment[1], square = by * moment[2];
    double cube = by * moment[3];
    double d = fmax(sqrt(fmax(square - mean * mean, 0)), LEAST_SPREAD * mean);
    double third = cube - mean * (3 * square - 2 * mean * mean), g = third / (d * d * d);
    double side = sqrt(g * g + 4);
    closure[0] = mean + 0.5 * d * (g - side);
    closure[1] = mean + 0.5 * d * (g + side);
}

void tl_energy_cubic(const double at[2], const double energy[2], const double stress[2], double p[4])
{
    double a = at[0], b = at[1], per = 1 / (b - a);
    double f = energy[0] / a, g = energy[1] / b, mean = (g - f) * per;
    double c1 = (stress[0] - f) / a, c2 = (mean - c1) * per;
    double c3 = (((stress[1] - g) / b - mean) * per - c2) * per;
    p[0] = f - a * (c1 - a * (c2 - c3 * b));
    p[1] = c1 - a * (2 * c2 - c3 * (a + 2 * b));
    p[2] = c2 - c3 * (2 * a + b);
    p[3] = c3;
}
