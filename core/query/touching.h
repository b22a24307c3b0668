/* touching.h - the faces of blocks that lie on faces of others. */
#ifndef TL_QUERY_TOUCHING_H
#define TL_QUERY_TOUCHING_H

#include "model/model.h"

/* A face of a block, as far as it lies on a face of a block of another body. */
typedef struct tl_touch {
    uint32_t row, face; /* the block and its face */
    uint32_t other;     /* row of the other block */
    double area;        /* that they share, m2 */
    tl_tag joint;
    /* By how much the two have moved against each other since they were made, over the size of the block's body. */
    double moved;
} tl_touch;

/* Of all blocks, in the order of their ids and of the others'. Those of a row: at[start[row]] .. at[start[row + 1]]. */
typedef struct tl_touches {
    tl_touch *at;
    size_t *start;
    size_t count, capacity;
    /* [rows] 1: the block touched another when it was made, has moved against it by more, and no longer does */
    uint8_t *left;
} tl_touches;

/* Tolerance: motion up to which blocks touch as they did when they were made, over its size. Test: lua/test_keyblocks,
 * verify/settled_keyblocks. */
#define TL_TOUCH_KEPT 0.01

/* Free the result with tl_touches_free, also after an error. */
tl_status tl_touches_find(tl_model *m, tl_touches *out);
void tl_touches_free(tl_touches *touches);

/* The axes along which a body is held, on rollers or, all three, throughout; how many they are. */
size_t tl_held_axes(const tl_model *m, uint32_t body, tl_vec3 held[3]);
/* Whether a body has moved by more against what it touches, or touched when it was made: its faces are those of now. */
bool tl_touches_moved(const tl_model *m, const tl_touches *touches, uint32_t body);
/* Outward unit normal of a touch, axes of the model: as the block lay when it was made, or as it lies now. */
tl_vec3 tl_touch_normal(const tl_model *m, const tl_touch *touch, bool now);

/* Tolerance: cosine within which a direction lies in a face, sine within which two faces are parallel: far above
 * rounding of what was cut. */
#define TL_TOUCH_ALONG 1e-6

#endif
