/* make.h - making, copying and checking polyhedra. */
#ifndef TL_GEOMETRY_MAKE_H
#define TL_GEOMETRY_MAKE_H

#include "base/error.h"
#include "geometry/polyhedron.h"

#include <float.h>

/* Euler's formula bounds the edges of a polyhedron within the limits on vertices and faces. */
#define TL_POLY_MAX_EDGES (TL_POLY_MAX_VERTICES + TL_POLY_MAX_FACES - 2)

/* Tolerance: distances are known to a few roundings of the coordinates. For a small block far from zero that,
 * and not TL_POLY_ON times its size, is the least distance that means anything. */
#define TL_POLY_ROUNDINGS (16 * DBL_EPSILON)

/* Tolerance: depths below this times the thickness of a block change nothing of it. Faces may be bent, and points be
 * left out inside, by no more. */
#define TL_POLY_SHALLOW 1e-2

/* One allocation with the counts set and its arrays laid out but empty; NULL without memory. */
tl_poly *tl_poly_allocate(uint32_t vertex_count, uint32_t face_count, uint32_t edge_count);

/* Derives edges and size from vertex, start and loop, which the caller has filled in with valid indices, and gives the
 * polyhedron to *linked. TL_E_GEOMETRY when some edge does not belong to exactly two faces, one in each direction: then
 * it is freed. */
tl_status tl_poly_link(tl_poly *poly, tl_poly **linked, tl_error *error);

/* Forgets the seams of a polyhedron; gives it marks of its own, where no face is covered yet; NULL without memory. */
void tl_poly_clear_seams(tl_poly *poly);
uint8_t *tl_poly_open_seams(tl_poly *poly);
/* Puts planes of other parts behind those of the faces; false without memory. With none nothing is allocated. */
bool tl_poly_add_planes(tl_poly *poly, const tl_plane *planes, uint32_t count);

/* Twice the vector area of a face, by its fan of triangles. */
tl_vec3 tl_poly_fan_area(const tl_vec3 *vertices, const uint16_t *loop, size_t count);
/* The normal of a vector area, an axis to the bit where that lies along one; 0 for 0. */
tl_vec3 tl_poly_normal(tl_vec3 area);

/* The middle of two heights, that height to the bit where they are one. */
double tl_poly_midway(double low, double high);

/* A polyhedron from faces: loops[start[f] .. start[f+1]) are indices into `vertices`. Derives edges.
 * Fails (TL_E_GEOMETRY) when some edge does not belong to exactly two faces. */
tl_status tl_poly_make(const tl_vec3 *vertices, size_t vertex_count, const tl_plane *planes, const tl_tag *tags,
                       const uint32_t *start, const uint16_t *loops, size_t face_count, tl_poly **poly,
                       tl_error *error);

tl_status tl_poly_box(tl_vec3 min, tl_vec3 max, tl_poly **poly, tl_error *error);

void tl_poly_free(tl_poly *poly);
/* Bytes of its allocation, and of its seams. */
size_t tl_poly_bytes(const tl_poly *poly);

/* The same once more; NULL when out of memory. */
tl_poly *tl_poly_copy(const tl_poly *poly);

/* A copy with every vertex x replaced by R x + t (R a rotation; NULL is the identity). */
tl_status tl_poly_transformed(const tl_poly *poly, const tl_mat3 *rotation, tl_vec3 translation, tl_poly **copy,
                              tl_error *error);

/* Euler's formula, closed, convex and every vertex on its faces' planes within `tolerance` times the
 * size, positive volume. */
tl_status tl_poly_check(const tl_poly *poly, double tolerance, tl_error *error);

#endif
