/* closures.h - two closures that stand for all of what presses (closures.c). */
#ifndef TL_FORCE_CLOSURES_H
#define TL_FORCE_CLOSURES_H

/* Of a closure: how far from it energies are taken for the stress. Both what a curve adds and what is lost in rounding are below
 * 1e-6 of the stress. */
#define TL_NEAR_CLOSURE (1.0 / 1024)

/* The closures of Gauss for the weight u, the less first, of the moments int u^n dA, n = 1 .. 4. */
void tl_two_closures(const double moment[4], double closure[2]);

#endif
