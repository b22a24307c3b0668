/* closures.h - two closures that stand for all of what presses. */
#ifndef TL_FORCE_CLOSURES_H
#define TL_FORCE_CLOSURES_H

/* The closures of Gauss for the weight u, the less first, of the moments int u^n dA, n = 1 .. 4. */
void tl_two_closures(const double moment[4], double closure[2]);
/* The cubic p_0 + p_1 u + p_2 u^2 + p_3 u^3 of the energy per closure that meets energies and stresses at both. */
void tl_energy_cubic(const double at[2], const double energy[2], const double stress[2], double p[4]);

#endif
