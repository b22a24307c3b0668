/* spot.h - where the sides of a contact were against each other. */
#ifndef TL_CONTACT_SPOT_H
#define TL_CONTACT_SPOT_H

#include "contact/sides.h"

/* Where they are. */
tl_spot tl_spot_of(const tl_model *m, tl_sides sides, double remaining);
/* How far points have moved since then that lie within `radius` of the centroid of B, at the most: what the rounding of
 * the spot may hide is counted. */
double tl_spot_moved(const tl_model *m, const tl_spot *then, tl_sides sides, double radius);

#endif
