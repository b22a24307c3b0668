/* box_tree.h - which of many boxes hold a point, or meet another box. */
#ifndef TL_GEOMETRY_BOX_TREE_H
#define TL_GEOMETRY_BOX_TREE_H

#include <stdbool.h>
#include <talus/types.h>

typedef struct tl_box_tree {
    const tl_bounds *box; /* of the caller */
    uint32_t count;
    uint32_t *order; /* numbers of boxes: each half of a range again by halves */
    tl_bounds *all;  /* of the ranges, in the order in which they are halved */
} tl_box_tree;

/* Over boxes that stay where they are. false: out of memory. */
bool tl_box_tree_make(tl_box_tree *tree, const tl_bounds *box, uint32_t count);
void tl_box_tree_free(tl_box_tree *tree);
/* Calls `fn` for each box that holds a point, in an order that depends on the boxes alone. */
void tl_box_tree_ask(const tl_box_tree *tree, tl_vec3 at, void (*fn)(void *user, uint32_t box), void *user);
/* The same for each box that has a point in common with another box. */
void tl_box_tree_meet(const tl_box_tree *tree, const tl_bounds *with, void (*fn)(void *user, uint32_t box), void *user);

#endif
