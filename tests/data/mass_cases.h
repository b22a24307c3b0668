/* mass_cases.h - mass properties of polyhedra with rational vertices at density 1.
 *
 * Source: exact rational arithmetic (tetrahedra summed as fractions); volume, centroid and inertia
 * about the centroid are those fractions, the principal moments the eigenvalues of the exact tensor to
 * double precision. Tolerance for all: 1e-13 relative, a few hundred roundings. */
#ifndef TALUS_TESTS_MASS_CASES_H
#define TALUS_TESTS_MASS_CASES_H

#include <talus/types.h>

enum { MASS_CASE_VERTICES = 8 };

typedef struct mass_case {
    const char *name;
    size_t vertices, edges, faces;
    tl_vec3 vertex[MASS_CASE_VERTICES];
    double volume;
    tl_vec3 centroid;
    tl_sym3 inertia; /* xx, yy, zz, xy, yz, zx */
    double principal[3];
    double mean_radius; /* mean distance of the vertices from the centroid */
} mass_case;

static const mass_case mass_cases[] = {
    {.name = "unit_cube",
     .vertices = 8,
     .edges = 12,
     .faces = 6,
     .vertex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
     .volume = 1,
     .centroid = {1.0 / 2, 1.0 / 2, 1.0 / 2},
     .inertia = {1.0 / 6, 1.0 / 6, 1.0 / 6, 0, 0, 0},
     .principal = {0.16666666666666666, 0.16666666666666666, 0.16666666666666666},
     .mean_radius = 0.8660254037844386},
    {.name = "box_1_2_3",
     .vertices = 8,
     .edges = 12,
     .faces = 6,
     .vertex = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 3}, {1, 0, 3}, {1, 2, 3}, {0, 2, 3}},
     .volume = 6,
     .centroid = {1.0 / 2, 1, 3.0 / 2},
     .inertia = {13.0 / 2, 5, 5.0 / 2, 0, 0, 0},
     .principal = {2.5, 5.0, 6.5},
     .mean_radius = 1.8708286933869707},
    {.name = "trirect_tetra_1_1_1",
     .vertices = 4,
     .edges = 6,
     .faces = 4,
     .vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
     .volume = 1.0 / 6,
     .centroid = {1.0 / 4, 1.0 / 4, 1.0 / 4},
     .inertia = {1.0 / 80, 1.0 / 80, 1.0 / 80, 1.0 / 480, 1.0 / 480, 1.0 / 480},
     .principal = {0.010416666666666664, 0.010416666666666668, 0.016666666666666663},
     .mean_radius = 0.7301203236646923},
    {.name = "tetra_2_3_4",
     .vertices = 4,
     .edges = 6,
     .faces = 4,
     .vertex = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}},
     .volume = 4,
     .centroid = {1.0 / 2, 3.0 / 4, 1},
     .inertia = {15.0 / 4, 3, 39.0 / 20, 3.0 / 10, 3.0 / 5, 2.0 / 5},
     .principal = {1.6486218175822436, 3.022658790504613, 4.028719391913144},
     .mean_radius = 2.235953386893982},
    {.name = "regular_tetra_edge_2sqrt2",
     .vertices = 4,
     .edges = 6,
     .faces = 4,
     .vertex = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
     .volume = 8.0 / 3,
     .centroid = {0, 0, 0},
     .inertia = {16.0 / 15, 16.0 / 15, 16.0 / 15, 0, 0, 0},
     .principal = {1.0666666666666667, 1.0666666666666667, 1.0666666666666667},
     .mean_radius = 1.7320508075688772},
    {.name = "right_triangular_prism",
     .vertices = 6,
     .edges = 9,
     .faces = 5,
     .vertex = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 5}, {3, 0, 5}, {0, 4, 5}},
     .volume = 30,
     .centroid = {1, 4.0 / 3, 5.0 / 2},
     .inertia = {535.0 / 6, 155.0 / 2, 125.0 / 3, 10, 0, 0},
     .principal = {41.666666666666664, 71.75629667545849, 94.91036999120819},
     .mean_radius = 3.420780134767161},
    {.name = "square_pyramid",
     .vertices = 5,
     .edges = 8,
     .faces = 5,
     .vertex = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 3}},
     .volume = 4,
     .centroid = {0, 0, 3.0 / 4},
     .inertia = {43.0 / 20, 43.0 / 20, 8.0 / 5, 0, 0, 0},
     .principal = {1.6, 2.15, 2.15},
     .mean_radius = 1.7306248474865698},
    {.name = "octahedron",
     .vertices = 6,
     .edges = 12,
     .faces = 8,
     .vertex = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
     .volume = 4.0 / 3,
     .centroid = {0, 0, 0},
     .inertia = {4.0 / 15, 4.0 / 15, 4.0 / 15, 0, 0, 0},
     .principal = {0.26666666666666666, 0.26666666666666666, 0.26666666666666666},
     .mean_radius = 1.0},
    {.name = "frustum_4_2_3",
     .vertices = 8,
     .edges = 12,
     .faces = 6,
     .vertex = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {-1, -1, 3}, {1, -1, 3}, {1, 1, 3}, {-1, 1, 3}},
     .volume = 28,
     .centroid = {0, 0, 33.0 / 28},
     .inertia = {6091.0 / 140, 6091.0 / 140, 248.0 / 5, 0, 0, 0},
     .principal = {43.50714285714286, 43.50714285714286, 49.6},
     .mean_radius = 2.6850725740113983},
};

#endif
