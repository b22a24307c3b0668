/* view.h - two blocks as the geometry of a pair sees them, and the lengths that count there, over their size.
 *
 * The geometry is done in the frame of block A's body, where B's body is given by a rotation and a translation. A is
 * the block with the lower id. Normals point from A to B. Gap is positive between separate walls; overlap is -gap. */
#ifndef TL_NARROW_VIEW_H
#define TL_NARROW_VIEW_H

#include "geometry/polyhedron.h"

#include <talus/vmath.h>

/* Tolerance: lengths below it, relative to the smaller block's size, make no difference: a motion within which a pair
 * without points is not looked at again. A motion in a step with which a contact is calm. A gap of walls that are
 * together. Far above rounding of places, far below the contact tolerance. */
#define TL_STILL 1e-6

/* Tolerance: gap at which two flush faces become a contact, relative to the smaller block's size. A contact ends at
 * the second times this gap, so none flickers. Test: unit/test_contact. */
#define TL_CONTACT_TOLERANCE 1e-3
#define TL_CONTACT_RELEASE 1.5

/* Where B is in A's frame. */
typedef struct tl_pair_pose {
    tl_mat3 turn;
    tl_vec3 shift;
} tl_pair_pose;

/* Two blocks in the frame of A's body. */
typedef struct tl_pair_view {
    const tl_poly *a, *b;
    tl_mat3 turn;      /* from B's frame to A's */
    tl_vec3 shift;     /* B's origin in A's frame */
    double size;       /* of the smaller block */
    double mean_face;  /* smaller of the two mean face areas */
    tl_vec3 *vertex_b; /* B's vertices and face normals in A's frame: filled by tl_pair_place */
    tl_vec3 *normal_b;
} tl_pair_view;

/* The plane of a face of A, or of B, in A's frame, of a pair that has been placed. */
static inline tl_plane tl_view_plane(const tl_pair_view *view, bool of_b, uint32_t face)
{
    if (!of_b)
        return view->a->plane[face];
    tl_vec3 n = view->normal_b[face];
    return (tl_plane){n, view->b->plane[face].offset + tl_v3_dot(n, view->shift)};
}

#endif
