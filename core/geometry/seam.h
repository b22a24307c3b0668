/* seam.h - bodies of several polyhedra: which faces are inside, and what hangs together. */
#ifndef TL_GEOMETRY_SEAM_H
#define TL_GEOMETRY_SEAM_H

#include "geometry/polyhedron.h"

/* Whether faces of two parts of one body, given in one frame, lie on each other. They do as closely as blocks that had
 * settled when they were joined. What they have in common is inside the body. Raises *uncovered to the share of a face
 * that may stay uncovered when it is inside by such faces. */
bool tl_poly_faces_meet(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *uncovered);
/* Area common to two such faces; 0 when they do not lie on each other. false when out of memory. */
bool tl_poly_shared_area(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb, double *area);

/* Marks the seams of a body made of `count` parts given in one frame: faces that lie on other parts over
 * their whole area. */
tl_status tl_poly_mark_seams(tl_poly *const *parts, size_t count, tl_error *error);
/* Gives parts whose seams are marked the planes of outer faces of the others that count for them. */
tl_status tl_poly_share_planes(tl_poly *const *parts, size_t count, tl_error *error);

/* Whether faces of this tag keep parts apart that share them. */
typedef bool (*tl_sever_fn)(const void *user, tl_tag tag);

/* Which of the parts of a body hang together over faces that lie on each other: label[i] is the lowest index of its
 * group. Faces that `severs` (NULL: none does) do not count. */
tl_status tl_poly_connected(tl_poly *const *parts, size_t count, tl_sever_fn severs, const void *user, uint32_t *label,
                            tl_error *error);

#endif
