/* bent.h - cells of partly open patches under a stress that is no line in the closure (bent.c). */
#ifndef TL_FORCE_BENT_H
#define TL_FORCE_BENT_H

#include "contact/layout.h"
#include "model/model.h"

/* Of the cells of the patches in the lanes `parts` of a SIMD group, whose integrals are known: what the stress of a law changes that
 * tells the energy of what presses (tl_law_presses). `found`: of points at their closures, else of closures that suit the cells. */
void tl_cells_bend(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                   const tl_point_lanes *lanes, size_t lane, uint32_t parts, bool found);

#endif
