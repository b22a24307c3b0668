/* skyline.h - symmetric matrices stored row by row from the first entry to the diagonal, and their slowest
 * vibrations. */
#ifndef TL_BASE_SKYLINE_H
#define TL_BASE_SKYLINE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct tl_skyline {
    size_t size;
    size_t *first; /* of each row: the first column that is stored */
    size_t *start; /* of each row: its first entry; size + 1 of them */
    double *entry;
} tl_skyline;

/* Makes a matrix of zeros whose rows begin at `first`, which it then owns. false: out of memory. */
bool tl_skyline_make(tl_skyline *a, size_t size, size_t *first);
void tl_skyline_free(tl_skyline *a);
static inline double *tl_skyline_at(const tl_skyline *a, size_t row, size_t column)
{
    return &a->entry[a->start[row] + column - a->first[row]];
}
/* Replaces A by its factor L, A = L L^T. false: it is not positive definite. */
bool tl_skyline_factor(tl_skyline *a);
/* Replaces x by the solution of L L^T x = b. */
void tl_skyline_solve(const tl_skyline *l, double *x);

/* The `count` lowest eigenvalues of L L^T, ascending, and their vectors of unit length, one after the other. Subspace
 * iteration from vectors that follow from their numbers. false: out of memory. */
bool tl_skyline_lowest(const tl_skyline *l, size_t count, double *value, double *vector);

#endif
