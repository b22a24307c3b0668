/* law_check.h - a law that breaks the interface is a failure of the step, with the contact it did so in (law_check.c). */
#ifndef TL_FORCE_LAW_CHECK_H
#define TL_FORCE_LAW_CHECK_H

#include "base/failure.h"
#include "contact/layout.h"
#include "model/model.h"

/* Component of a shear force along the normal, relative to the whole force of the point, and of all points of a contact
 * before they are looked at one by one. The host's own reaches 4e-7 where normals change from point to point. */
#define TL_OUT_OF_PLANE 1e-4

/* Of the points of a SIMD group, whose first is in lane `lane`: whether they are stiffer than the law says, those in the lanes of the
 * mask `begins`, and whether shear forces leave the common plane. */
void tl_law_check_stiffness(const tl_model *m, tl_failure *failure, const tl_law *law,
                            const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane,
                            unsigned begins);
void tl_law_check_shear(const tl_model *m, tl_failure *failure, const tl_law *law,
                        const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane);
/* Of `count` points from row `first`: whether their states are numbers. */
void tl_law_check_states(const tl_model *m, tl_failure *failure, const tl_law *law, size_t first,
                         size_t count);

/* Names what is no finite number in the force of the contact in a lane of the SIMD group: what the law was given, what it gave, or
 * the sum. */
void tl_law_check_forces(const tl_model *m, tl_failure *failure, const tl_law *law,
                         const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane,
                         size_t contact);

#endif
