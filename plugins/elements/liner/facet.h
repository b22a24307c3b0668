/* facet.h - a flat triangle of a shell: strains from displacements. */
#ifndef LINER_FACET_H
#define LINER_FACET_H

#include <talus/types.h>

/* Freedoms of a facet: displacements x, y, z of its three corners, m, and rotations of its three sides, rad. Side k is
 * across corner k. */
#define FACET_FREEDOMS 12

/* Strains xx, yy, 2 xy in the plane, and the curvatures, 1/m, for each freedom. */
typedef struct facet {
    double membrane[3][9], bending[3][FACET_FREEDOMS];
    double area;    /* m2 */
    tl_vec3 normal; /* unit */
} facet;

/* Stiffness of a shell: forces N/m and moments N m/m are these times strains and curvatures. */
typedef struct facet_stiffness {
    double membrane, bending; /* E t / (1 - nu^2), E t^3 / (12 (1 - nu^2)) */
    double poisson;
} facet_stiffness;

/* From the places of its corners; `sign` tells for each side whether its rotation counts about the way round the
 * triangle, 1, or against it, -1. */
void facet_make(facet *f, const tl_vec3 at[3], const double sign[3]);

/* Plane stresses, times what `modulus` has, of strains. */
void facet_stress(double modulus, double poisson, const double strain[3], double stress[3]);

/* The two principal values of xx, yy, xy, the larger first. */
void facet_principal(const double stress[3], double value[2]);

/* The matrix of stiffness; without membrane or bending where the stiffness is 0. */
void facet_matrix(const facet *f, const facet_stiffness *of, double matrix[FACET_FREEDOMS][FACET_FREEDOMS]);

#endif
