/* flush.h - how far two faces on each other press as one patch, and where the points of that are. */
#ifndef TL_NARROW_FLUSH_H
#define TL_NARROW_FLUSH_H

#include "base/inline.h"
#include "geometry/polyhedron.h"

/* Tolerance: tilt of two faces, as a sine, up to which their patch is all there is, and from which on the field is all.
 * They are 0.05 and 0.15 degrees. Joints of a rock mass under load stay below, at some 1e-5. */
#define TL_FLUSH_TILT 8.7266e-4
#define TL_FIELD_TILT 2.6180e-3
/* Tolerance: the same of the overlap of the patch over the root of its area. Deep blocks have accidental flush faces.
 * Test: property/press_properties, verify/bounce. */
#define TL_FLUSH_DEPTH 4e-3
#define TL_FIELD_DEPTH 1e-2
/* Tolerance: the same of patches with points at their corners only, which are to be springs there: 5 and 10 degrees. */
#define TL_CORNERS_TILT 0.0872
#define TL_CORNERS_FIELD_TILT 0.1736
#define TL_CORNERS_DEPTH 0.1
#define TL_CORNERS_FIELD_DEPTH 0.2
/* Tolerance: of these, the tilt and the overlap up to which such a patch has points. Beyond, it counts how the corners
 * and their areas go in a tilt and over an edge, and all is done by the press (corner_sums.c). The points' forces are
 * off by about the tilt, and by the overlap. */
#define TL_CORNERS_POINTS_TILT 2e-4
#define TL_CORNERS_POINTS_DEPTH 1e-3

/* Limits of a patch, and from where on there is nothing of it. They are of the tilt, and of the overlap over the root
 * of the area. And of both up to which it has points. */
typedef struct tl_flush_limits {
    double tilt, field_tilt, depth, field_depth, points_tilt, points_depth;
} tl_flush_limits;

TL_INLINE tl_flush_limits tl_flush_limits_of(bool corners)
{
    return corners ? (tl_flush_limits){TL_CORNERS_TILT,        TL_CORNERS_FIELD_TILT,  TL_CORNERS_DEPTH,
                                       TL_CORNERS_FIELD_DEPTH, TL_CORNERS_POINTS_TILT, TL_CORNERS_POINTS_DEPTH}
                   : (tl_flush_limits){TL_FLUSH_TILT,  TL_FIELD_TILT, TL_FLUSH_DEPTH,
                                       TL_FIELD_DEPTH, TL_FLUSH_TILT, TL_FLUSH_DEPTH};
}

/* Whether the points of a patch of two faces are to lie at its corners, where the model has them so. They do where no
 * other face meets either of them so flat that it would touch next, within the tilt of springs at corners. On a blunt
 * edge, or a round outline, the corners of one face would give way to those of the next at once. */
bool tl_at_corners(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb);
/* The joint of two faces that lie flush: that which both have, or one of them. */
tl_tag tl_flush_tag(tl_tag a, tl_tag b);

#endif
