/* spot.h - where the blocks of a pair were against each other (spot.c). */
#ifndef TL_CONTACT_SPOT_H
#define TL_CONTACT_SPOT_H

#include <talus/types.h>

/* B's body in the frame of A's: its centroid and its rotation. */
typedef struct tl_spot {
    tl_vec3 way;
    tl_quat turn;
} tl_spot;

/* The same, to seven digits. */
typedef struct tl_rough_spot {
    float way[3], turn[4];
} tl_rough_spot;

struct tl_model;
tl_spot tl_spot_of(const struct tl_model *m, uint32_t block_a, uint32_t block_b);
tl_rough_spot tl_spot_roughly(const tl_spot *spot);
tl_spot tl_spot_from(const tl_rough_spot *spot);
/* How far a point has moved between two spots that lies within `radius` of the centroid of B's body, at the most. */
double tl_spot_moved(const tl_spot *from, const tl_spot *to, double radius);

#endif
