/* corner_keys.h - numbers of the corners of blocks by place. */
#ifndef TL_ZONE_CORNER_KEYS_H
#define TL_ZONE_CORNER_KEYS_H

#include "model/model.h"

/* The key of corner v of the block in a row is of[start[row] + v]. Corners of different blocks in one place have the
 * same key. Of one block all keys differ. */
typedef struct tl_corner_keys {
    uint64_t *of;
    size_t *start; /* [rows + 1] */
} tl_corner_keys;

/* Makes the keys of all blocks, by their present places. false: out of memory, and there are none. */
bool tl_corner_keys_make(const tl_model *m, tl_corner_keys *keys);
void tl_corner_keys_free(tl_corner_keys *keys);

#endif
