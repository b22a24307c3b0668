/* skyline.h - matrices of talus/skyline.h that own their memory, and their slowest vibrations. */
#ifndef TL_BASE_SKYLINE_H
#define TL_BASE_SKYLINE_H

#include <stdbool.h>
#include <talus/skyline.h>

/* Makes a matrix of zeros whose rows begin at `first`, which it then owns. false: out of memory. */
bool tl_skyline_make(tl_skyline *a, size_t size, size_t *first);
void tl_skyline_free(tl_skyline *a);
static inline double *tl_skyline_at(const tl_skyline *a, size_t row, size_t column)
{
    return row == column ? &a->diagonal[row] : &a->entry[a->start[row] + column - a->first[row]];
}

/* The `count` lowest eigenvalues of A, ascending, and their vectors of unit length, one after the other. Subspace
 * iteration from vectors that follow from their numbers. A is positive definite, and factorised. false: out of
 * memory. */
bool tl_skyline_lowest(const tl_skyline *a, size_t count, double *value, double *vector);

#endif
