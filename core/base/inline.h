/* inline.h - functions that are part of the loop which calls them. */
#ifndef TL_BASE_INLINE_H
#define TL_BASE_INLINE_H

/* For what a loop in a TL_VECTORIZED function does with one element: a call that is left stops the loop from
 * becoming SIMD code. */
#define TL_INLINE static inline __attribute__((always_inline))

#endif
