/* measure.h - what a polyhedron measures. */
#ifndef TL_GEOMETRY_MEASURE_H
#define TL_GEOMETRY_MEASURE_H

#include "geometry/polyhedron.h"

#include <talus/vmath.h>

/* Volume, centroid and inertia at density 1 about the centroid, exact up to rounding. They are sums over tetrahedra
 * about a vertex, so that an offset costs no digits. */
typedef struct tl_mass {
    double volume;
    tl_vec3 centroid;
    tl_sym3 inertia;
} tl_mass;

tl_mass tl_poly_mass(const tl_poly *poly);

tl_vec3 tl_points_mean(const tl_vec3 *points, size_t count);
tl_bounds tl_points_bounds(const tl_vec3 *points, size_t count);
static inline tl_bounds tl_poly_bounds(const tl_poly *poly)
{
    return tl_points_bounds(poly->vertex, poly->vertex_count);
}
/* The volume of a tetrahedron of corners x; above 0 where 0, 1, 2 are counter-clockwise as seen from the side without
 * corner 3. */
static inline double tl_tetrahedron_volume(const tl_vec3 x[4])
{
    return tl_v3_dot(tl_v3_sub(x[1], x[0]), tl_v3_cross(tl_v3_sub(x[2], x[0]), tl_v3_sub(x[3], x[0]))) / 6;
}
/* Whether two bounds have a point in common. */
static inline bool tl_bounds_meet(const tl_bounds *a, const tl_bounds *b)
{
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y && b->min.y <= a->max.y &&
           a->min.z <= b->max.z && b->min.z <= a->max.z;
}
/* Sets `size` by the vertices as they are. */
void tl_poly_find_size(tl_poly *poly);
double tl_poly_face_area(const tl_poly *poly, uint32_t face);
tl_vec3 tl_poly_face_centroid(const tl_poly *poly, uint32_t face);
double tl_poly_shortest_edge(const tl_poly *poly);
/* The area of its smallest face. */
double tl_poly_smallest_face(const tl_poly *poly);
/* Largest distance between two vertices. */
double tl_poly_diameter(const tl_poly *poly);
/* Smallest extent along the normal of a face. (Between two crossing edges it may be less, 0.87 of this
 * in a regular tetrahedron; but what is thin is thin along a face.) */
double tl_poly_thickness(const tl_poly *poly);
/* Within `tolerance` (a length) of the inside. */
bool tl_poly_contains(const tl_poly *poly, tl_vec3 point, double tolerance);

/* Eigenvalues (ascending in `moments`) and the rotation from principal axes to the given ones. The
 * identity for a diagonal tensor's own axes up to their order. */
void tl_principal_axes(tl_sym3 tensor, tl_vec3 *moments, tl_quat *axes);

#endif
