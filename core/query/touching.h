/* touching.h - the faces of blocks that lie on faces of others. */
#ifndef TL_QUERY_TOUCHING_H
#define TL_QUERY_TOUCHING_H

#include "model/model.h"

/* A face of a block, as far as it lies on a face of a block of another body. */
typedef struct tl_touch {
    uint32_t other; /* row of the other block */
    tl_vec3 normal; /* outward unit normal of the block's own face, axes of the model */
    double area;    /* that they share, m2 */
    tl_tag joint;   /* of the contact */
} tl_touch;

typedef struct tl_touches {
    tl_touch *at;
    size_t count, capacity;
} tl_touches;

/* Adds what the block in `row` touches, in the order of the other blocks' ids, after a
 * tl_detect_refresh. False when out of memory. `at` is freed with free(). */
bool tl_touches_add(const tl_model *m, uint32_t row, tl_touches *touches);

#endif
