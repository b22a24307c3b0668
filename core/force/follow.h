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

/* Of each contact of a SIMD group: force on B of its points, their moment about A's centroid, and the energies of
 * their springs and slip. */
typedef struct tl_group_sums {
    double force[3][TL_LANES], moment[3][TL_LANES], stored[TL_LANES], dissipated[TL_LANES];
    double holds_over_gap[TL_LANES]; /* above 0 when a force acts across a gap */
    double
        odd[TL_LANES]; /* 0, NaN when the force or moment is not finite, 1 when shear forces may leave their planes */
} tl_group_sums;

/* Limit: component of a shear force along the normal, relative to the whole force of the point. It holds for all
 * points of a contact together before they are looked at one by one. The host's own reaches 4e-7 where normals change
 * from point to point. Test: lua/test_law_check. */
#define TL_OUT_OF_PLANE 1e-4

/* Finds gaps, normals and relative motion of the contacts of a SIMD group of patches, or of field contacts, from lane
 * `lane` on. Turns shear forces with the common plane, and the states of which `tangents` has a bit. */
void tl_simd_group_follow(tl_model *m, const tl_simd_group *group, bool field, const tl_point_lanes *lanes, size_t lane,
                          uint32_t tangents, tl_arms *arms);

#endif
