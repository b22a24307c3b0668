/* seat.h - pairs of blocks that are taken as fitting: what a model keeps of them (seats.h). */
#ifndef TL_MODEL_SEAT_H
#define TL_MODEL_SEAT_H

#include "geometry/polyhedron.h"

#include <talus/talus.h>
#include <talus/vmath.h>

/* A body's frame as one of its blocks sees it: where the block's centroid lies in it, and how the frame was turned when
 * the block was made. A body that is made anew of other blocks has another frame; its blocks have not moved. */
typedef struct tl_block_frame {
    tl_vec3 centroid;
    tl_quat turn;
} tl_block_frame;

/* A seated pair: each of its blocks sees the other with a face in another plane than it was drawn in, so that the two
 * touch without overlap. To all other blocks they are as drawn. */
typedef struct tl_seated {
    tl_id block[2];          /* the lower first */
    uint32_t face[2];        /* TL_NO_ROW: this block is as drawn */
    tl_plane plane[2];       /* in which they are, in the frames of their bodies */
    tl_block_frame frame[2]; /* those frames */
} tl_seated;

typedef struct tl_seats {
    tl_seated *list; /* by ascending blocks */
    size_t count, capacity;
    /* what follows from the list and the rows of blocks: made for a count of `structure`, less 1; 0: not yet */
    uint64_t made_for;
    tl_poly **shape;   /* [2 made] of the two blocks of each; NULL: as drawn */
    uint32_t *first;   /* [rows + 1] the first pair whose lower block this row is */
    size_t made;       /* pairs that have shapes */
    double reach;      /* no vertex has moved farther, m */
    double search_gap; /* while pairs are sought: the gap up to which they are, m; else 0 */
} tl_seats;

#endif
