/* params.h - random deviations of the planes of a joint set. */
#ifndef JOINTSET_DRAW_H
#define JOINTSET_DRAW_H

#include <talus/plugin.h>

/* Where the draws of one call are found: planes of an earlier call of the same set come first. */
typedef struct draws {
    const tl_host *host;
    uint32_t joint, first;
} draws;

/* The quantities a plane draws. */
enum { DRAW_DIP, DRAW_DIRECTION, DRAW_GAP, DRAW_KINDS };

/* Uniform in [-1, 1) for plane `index` (from 0) of this call. */
double draw_even(const draws *d, int64_t index, uint32_t kind);
/* Normal with mean 0 and standard deviation 1, cut off at +-limit; limit >= 1. */
double draw_normal(const draws *d, int64_t index, uint32_t kind, double limit);
/* The pole of plane `index`: distributed after Fisher about the unit vector `mean`, concentration k > 0. */
tl_vec3 draw_fisher(const draws *d, int64_t index, tl_vec3 mean, double k);

#endif
