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

/* The least d of m: less, and the two closures could not be told apart. */
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
