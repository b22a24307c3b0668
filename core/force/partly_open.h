/* partly_open.h - patches of which a part is closed and a part apart: their pressure integrated exactly. */
#ifndef TL_FORCE_PARTLY_OPEN_H
#define TL_FORCE_PARTLY_OPEN_H

#include "contact/layout.h"
#include "model/model.h"

/* The closures at the outermost fibres of the points of a SIMD group. */
void tl_simd_group_edges(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane);

/* Lanes of a SIMD group, a bit each, in which something is apart: of patches whose points stand for cells, and of those
 * that hold all of it, whose points go by their own closures. */
typedef struct tl_part_lanes {
    uint32_t parts, held;
} tl_part_lanes;

/* After a SIMD group of patches has been followed: gives the points of patches that are partly open, or of which a part
 * holds, the mean closures of their cells. `closure_apart` of the group's rows is valid when there is such a patch. */
tl_part_lanes tl_simd_group_part(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                                 const tl_point_lanes *lanes, size_t lane);

/* What the forces of cells have beside those of their points. */
typedef struct tl_part_sums {
    tl_vec3 moment; /* on B, N m */
    double force;   /* along the normal, N */
    tl_vec3 arm;    /* where it acts, of the lanes */
    double stored, dissipated;
} tl_part_sums;

/* Lanes in which patches have something beside their points after the law; of these those that slip opened just now. */
typedef struct tl_found_lanes {
    uint32_t parts, opened;
} tl_found_lanes;

/* After the law: what patches have beside their points, in the lanes given. turn, rad: of B against A in the step. */
tl_found_lanes tl_simd_group_part_sum(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                                      const tl_point_lanes *lanes, size_t lane, tl_part_lanes given,
                                      const tl_vec3 *turn, tl_part_sums *out);

#endif
