/* partly_open.h - patches of which some corners are apart: their pressure integrated exactly (partly_open.c). */
#ifndef TL_FORCE_PARTLY_OPEN_H
#define TL_FORCE_PARTLY_OPEN_H

#include "contact/layout.h"
#include "model/model.h"

/* What the points of a SIMD group lack, for a stiffness kn of 1, a contact in each lane. */
typedef struct tl_partly_open {
    bool any;
    tl_vec3 moment[TL_LANES]; /* on B about A's centroid, m^4 */
    double energy[TL_LANES];  /* m^4 */
} tl_partly_open;

/* Whether the points of contacts of a law carry nothing where the faces are apart, as long as no bond of them holds. */
bool tl_part_applies(const tl_model *m, const tl_law *law);
/* After a SIMD group of patches has been followed: gives points of contacts that are partly open closures that add up to the
 * force of the closed part, and tells what else there is. */
void tl_simd_group_part(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                        const tl_point_lanes *lanes, size_t lane, tl_partly_open *out);

/* The closures at the outermost fibres of the points of a SIMD group. */
void tl_simd_group_edges(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *lanes,
                         size_t lane);

#endif
