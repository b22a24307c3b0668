/* outer.h - what acts on the surfaces of deformable blocks from outside, and what holds them. */
#ifndef TL_ZONE_OUTER_H
#define TL_ZONE_OUTER_H

#include "zone/zones.h"

/* Puts conditions on triangles, each in the place of an earlier one or, with `add`, beside it: loads add up, and what
 * holds gridpoints holds together. Several of one triangle count as one. Gridpoints go free that an earlier condition
 * held, and none holds any more. A quiet one without a load keeps that of the earlier one. It also keeps the force by
 * which that held the gridpoints in the last step. Without an earlier one it keeps the stress of its zone. TL_E_MEMORY:
 * nothing has changed. */
tl_status tl_outer_put(tl_model *m, const tl_outer_part *list, size_t count, bool add);
/* The forces of its load on the corners of a triangle at its present place, N. */
void tl_outer_forces(const tl_model *m, const tl_outer_part *of, tl_vec3 force[3]);
/* Adds the forces of all loads, times `share`, to those of the gridpoints; notes how quiet ones resist. */
void tl_outer_push(tl_model *m, double share);
/* Zones have got other solids: quiet triangles resist by those. */
void tl_outer_find_solids(struct tl_zones *z);
/* Ends what holds and drives the gridpoints of a mesh. */
void tl_outer_let_go(tl_model *m, uint32_t mesh);
/* Forces of the last step count no more: rows have moved, or conditions changed. */
void tl_outer_forget(tl_gridpoints *p);

#endif
