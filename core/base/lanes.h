/* lanes.h - how functions are compiled whose loops run over whole lanes of TL_LANES.
 *
 * Such a loop has no branches and calls nothing that is not TL_INLINE or small, so that it becomes SIMD code. */
#ifndef TL_BASE_LANES_H
#define TL_BASE_LANES_H

#include <limits.h> /* says whether the library is glibc */

/* Compiled for wider vectors, too, where the program can choose among them as it starts. What is given for a
 * target never fuses a multiplication with an addition (-ffp-contract=off), so the bits are the same. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define TL_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TL_WIDE
#endif

/* Part of a loop over lanes. */
#define TL_INLINE static inline __attribute__((always_inline))

#endif
