/* follow.h - the contacts of a SIMD group in the present place. */
#ifndef TL_FORCE_FOLLOW_H
#define TL_FORCE_FOLLOW_H

#include "base/lanes.h"
#include "contact/layout.h"
#include "model/model.h"
#include "narrow/facet.h"

/* Of the contacts of a SIMD group: the force on B of a normal force of 1, and where the arms of the points of a patch
 * begin, from A's centroid. Those of a field contact begin there. */
typedef struct tl_arms {
    tl_lanes3 push, at;
} tl_arms;

/* Finds gaps, normals and relative motion of the contacts of a SIMD group of patches, or of field contacts, from lane
 * `lane` on. Turns shear forces with the common plane, and the states of which `tangents` has a bit. */
void tl_simd_group_follow(tl_model *m, const tl_simd_group *group, bool field,
                          const tl_point_lanes *lanes, size_t lane, uint32_t tangents,
                          tl_arms *arms);

#endif
