/* random.h - counter-based random numbers: a draw is a pure function of its key, so adding a draw elsewhere never
 * changes it. After Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC11. The mixing function is that
 * of SplitMix64 (Steele, Lea and Flood 2014). */
#ifndef TL_BASE_RANDOM_H
#define TL_BASE_RANDOM_H

#include <stdint.h>

static inline uint64_t tl_mix64(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/* A key from a key and one more word. */
static inline uint64_t tl_key(uint64_t key, uint64_t word)
{
    return tl_mix64(tl_mix64(key) ^ word);
}

/* Key of a text. */
static inline uint64_t tl_key_text(uint64_t key, const char *text)
{
    for (; *text; text++)
        key = tl_key(key, (unsigned char)*text);
    return key;
}

/* Uniform in [0, 1) with 53 bits. */
static inline double tl_uniform(uint64_t key)
{
    return (double)(tl_mix64(key) >> 11) * 0x1p-53;
}

#endif
