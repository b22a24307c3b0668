/* seats.h - pairs of blocks that are taken as fitting, and the shapes that the blocks of a pair have for each other. */
#ifndef TL_MODEL_SEATS_H
#define TL_MODEL_SEATS_H

#include "model/model.h"

/* The frame of a block's body as the block sees it. */
static inline tl_block_frame tl_block_frame_of(const tl_model *m, uint32_t row)
{
    return (tl_block_frame){tl_block_local(m, row), tl_block_made(m, row).turn};
}
/* A plane of a block, from one frame of its body into another. */
tl_plane tl_plane_reframed(tl_plane plane, const tl_block_frame *from, const tl_block_frame *to);

/* Makes the shapes of seated pairs for the present rows, and drops pairs of blocks that have gone. Does nothing where
 * that is done. false: out of memory. */
bool tl_seats_follow(tl_model *m);
/* Makes room for so many pairs more; false: out of memory. */
bool tl_seats_reserve(tl_model *m, size_t more);
/* Puts pairs, each of other blocks, into the list, which has room, in the place of those of the same blocks. Shapes are
 * then to be made again. */
void tl_seats_put(tl_model *m, const tl_seated *more, size_t count);
/* Whether what has been read of pairs fits the blocks. */
bool tl_seats_sound(const tl_model *m);
/* What is kept of a pair; NULL: nothing. */
const tl_seated *tl_seated_of(const tl_model *m, tl_id a, tl_id b);
bool tl_block_is_seated(const tl_model *m, tl_id block);
/* Bytes of what follows from the list. */
size_t tl_seats_bytes(const tl_model *m);
void tl_seats_free(tl_seats *seats);

const tl_poly *tl_seated_shape(const tl_model *m, uint32_t row, uint32_t other);
/* The shape that the block in a row has for another block, in its body's frame. */
static inline const tl_poly *tl_pair_shape(const tl_model *m, uint32_t row, uint32_t other)
{
    return m->seats.made == 0 ? m->blocks.shape[row] : tl_seated_shape(m, row, other);
}

#endif
