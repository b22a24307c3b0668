/* field_sums.h - what is integrated over a pressure field (field.h), and what counts as one plane there. */
#ifndef TL_NARROW_FIELD_SUMS_H
#define TL_NARROW_FIELD_SUMS_H

#include "narrow/field_faces.h"

/* An integral over K, and minus its gradient, borders included. */
typedef struct tl_field_power {
    double whole;
    tl_vec3 force, moment;
} tl_field_power;

/* Powers of d beyond those of the volume and of the energy: d^2 and d^3. */
enum { TL_FIELD_POWERS = 2 };

/* Integrals over S and K, moments about the origin. Those marked * include the borders. */
typedef struct tl_field_sums {
    double energy, volume; /* of K: G and its volume (see energy_only); m^4, m^3 */
    tl_vec3 force, moment; /* * -dG: int d n dS, int d x cross n dS; on B; m^3, m^4 */
    tl_vec3 swept,
        swept_moment; /* * -dV of the volume of K: int n dS, int x cross n dS; m^2, m^3 */
    /* int d n dS over the seams: what passes through them from one part of a body to the next, and into `force` of both */
    tl_vec3 through, through_moment;
    tl_vec3 area;     /* int n dS; m^2 */
    double pressure;  /* int d dS; m^3 */
    tl_vec3 pressed;  /* int d x dS; m^4 */
    double extent;    /* int dS; m^2 */
    tl_vec3 first;    /* int x dS; m^3 */
    double second;    /* int x . x dS; m^4 */
    double stiffness; /* int 2 / |n_a - n_b| dS: times kn that against motion along n; m^2 */
    double deepest;   /* largest d on S; m */
    tl_vec3 deepest_at;
    /* int d^2 dV, m^5, and int d^3 dV, m^6, if wanted; with what passes through seams */
    tl_field_power powers[TL_FIELD_POWERS];
} tl_field_sums;

/* Tolerance: roundings of the largest offset within which two faces that look the same way are one plane. */
#define TL_FIELD_ONE_PLANE (16 * 2.220446049250313e-16)
/* Tolerance: length of n_a - n_b below which what is between two faces counts no more in the stiffness. They look so
 * much the same way that it bears nothing. */
#define TL_FIELD_SAME_WAY 0.5

#endif
