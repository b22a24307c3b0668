/* pairs.h - pairs that sleep until their blocks, together, may have moved as far as they are apart. */
#ifndef TL_DETECT_PAIRS_H
#define TL_DETECT_PAIRS_H

#include "contact/detection.h"

/* The length of path at which a pair is to be tested, rounded down: too early, never too late. */
static inline float tl_pair_wake_at(double path)
{
    float out = (float)path;
    return (double)out > path ? nextafterf(out, -INFINITY) : out;
}

/* How far the blocks of a pair have moved, together. */
static inline double tl_pair_path(const tl_detect *d, const tl_pair *pair)
{
    return (double)d->path[pair->a] + (double)d->path[pair->b];
}

/* Lets a pair sleep until its blocks, together, have moved `way` more. */
static inline void tl_pair_sleep(const tl_detect *d, tl_pair *pair, double way)
{
    pair->wake = tl_pair_wake_at(tl_pair_path(d, pair) + way);
}

#endif
