/* talus/draws.h - random numbers of realisations, each a pure function of (seed, row, name), and intervals of
 * probabilities.
 *
 * A draw hangs on nothing else: another name, another row or another process changes none of the others. */
#ifndef TALUS_DRAWS_H
#define TALUS_DRAWS_H

#include <stdint.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A number of a realisation. */
typedef struct tl_draw {
    uint64_t seed, row; /* the row counts from 1 */
    const char *name;
    uint32_t part;  /* which number of those of one name */
    uint64_t latin; /* rows of a Latin hypercube, of which `row` is one; 0: independent draws */
} tl_draw;

/* Uniform in (0, 1). In a Latin hypercube of n rows one row of each name and part is in each of the intervals
 * [j / n, (j + 1) / n). Its number j is a keyed permutation of the rows, so no row knows of the others. */
TL_API double tl_draw_uniform(const tl_draw *draw);
/* A key of 64 bits for further draws, likewise a pure function. */
TL_API uint64_t tl_draw_key(const tl_draw *draw);

/* A probability of which `hits` of `count` trials tell: the interval that holds it with the probability `level` after
 * Clopper and Pearson (1934). 0 <= hits <= count, 0 < level < 1; [0, 1] without a trial. */
TL_API void tl_binomial_interval(uint64_t hits, uint64_t count, double level, double *low, double *high);

#ifdef __cplusplus
}
#endif
#endif
