/* share.h - the share of a patch in what two blocks press with. */
#ifndef TL_NARROW_SHARE_H
#define TL_NARROW_SHARE_H

#include "narrow/field_sums.h"

#include <stdbool.h>

/* The share of the patch, 1 - w, and its gradient: by a way of B, and by a turn about the origin of the sums. */
typedef struct tl_patch_share {
    double share;
    tl_vec3 push, turn;
} tl_patch_share;

/* By the outward normals of both faces, their shift, and the sums of the patch and of the field. Energy and volume of
 * the patch are above 0. */
tl_patch_share tl_patch_share_of(const tl_vec3 *na, const tl_vec3 *nb, bool corners, double shift,
                                 const tl_field_sums *patch, const tl_field_sums *field);

#endif
