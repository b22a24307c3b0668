/* spot.h - where the blocks of a pair were against each other. */
#ifndef TL_CONTACT_SPOT_H
#define TL_CONTACT_SPOT_H

#include <talus/types.h>

/* B's body in the frame of A's: its centroid and its rotation, each to seven digits. */
typedef struct tl_spot {
    float centroid[3], turn[4];
    /* of a contact: from here its blocks may move so far against each other, m, before its faces are to be chosen
     * anew */
    float remaining;
} tl_spot;

struct tl_model;
/* Where the blocks are. */
tl_spot tl_spot_of(const struct tl_model *m, uint32_t block_a, uint32_t block_b, double remaining);
/* How far points have moved since then that lie within `radius` of the centroid of B's body, at the most: what the
 * rounding of the spot may hide is counted. */
double tl_spot_moved(const struct tl_model *m, const tl_spot *then, uint32_t block_a, uint32_t block_b, double radius);

#endif
