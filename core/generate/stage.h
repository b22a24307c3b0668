/* stage.h - beginning, filling, cutting and ending a staging set. */
#ifndef TL_GENERATE_STAGE_H
#define TL_GENERATE_STAGE_H

#include "generate/fracture.h"
#include "generate/staging.h"

/* Begins a staging set without the model's blocks, to which new ones may be added. */
tl_status tl_stage_begin_empty(tl_model *m, tl_stage *stage);
/* Puts the model's blocks into it, before those that were added. TL_E_MEMORY leaves it as it was. */
tl_status tl_stage_open(tl_stage *stage);
/* Adds the convex hull of vertices, or a box, given in user coordinates. */
tl_status tl_stage_add_hull(tl_stage *stage, const tl_vec3 *vertices, size_t count, double density, const char *group);
tl_status tl_stage_add_box(tl_stage *stage, tl_vec3 min, tl_vec3 max, double density, const char *group);
/* Adds a block given by its faces; see tl_host.create_block. */
tl_status tl_stage_add_faces(tl_stage *stage, const tl_block_shape *given);
/* Adds convex blocks that fill a solid given by its faces, joined to one body; see tl_host.create_solid. */
tl_status tl_stage_add_solid(tl_stage *stage, const tl_block_shape *given, double flat, bool whole, size_t *parts);
/* Cuts the visible blocks by a plane, disc or polygon. Adds the blocks in its path to *met. See tl_host.cut_disc. */
tl_status tl_stage_cut_fracture(tl_stage *stage, const tl_fracture *fracture, tl_tag tag, double persistence,
                                size_t *met);
/* Cuts block `index` (of all staged) without a joint: both sides stay one body. `above` is the new
 * block on the normal's side, or SIZE_MAX when the plane does not divide the block. */
tl_status tl_stage_cut_block(tl_stage *stage, size_t index, tl_vec3 normal, tl_vec3 point, size_t *above);
/* Whether the inside of block `index` meets the common inside of half spaces. */
tl_status tl_stage_meets(tl_stage *stage, size_t index, const tl_half_space *spaces, size_t count, bool *meets);
/* Frees a staging set. One that has not been committed is dropped without a trace. */
void tl_stage_end(tl_stage *stage);

#endif
