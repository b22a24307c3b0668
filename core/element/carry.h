/* carry.h - what carries a node: a rigid body, or a zone. */
#ifndef TL_ELEMENT_CARRY_H
#define TL_ELEMENT_CARRY_H

#include "element/elements.h"

/* Puts a node, whose block is set, on its block where it is now: `place` from the model's origin, the present normal or
 * zero. Its displacement counts from here. */
void tl_node_install(tl_model *m, size_t row, tl_vec3 place, tl_vec3 normal);
/* Gives a node its place in the frame, or in a zone, of the body that the block in row `block` is in now. It does not
 * move by that. */
void tl_node_reframe(tl_model *m, size_t row, uint32_t block);
/* The displacement of a node at the present pose of what carries it, m. */
tl_vec3 tl_node_moved(const tl_model *m, size_t row);
/* Its present outward normal, unit, or zero. */
tl_vec3 tl_node_normal(const tl_model *m, size_t row);
/* Whether a block may have moved since it was made. */
bool tl_block_has_moved(const tl_model *m, uint32_t block);
/* How far a point, from the model's origin, lies inside of a block as it is now, m; below 0: outside. */
double tl_block_depth(const tl_model *m, uint32_t block, tl_vec3 place);
/* First gridpoint of the mesh that carries a node, or TL_NO_ROW: none does. */
uint32_t tl_node_first_point(const tl_model *m, size_t row);

#endif
