/* skyline.h - symmetric equations whose matrix is kept row by row, from its first entry to the diagonal. */
#ifndef LINER_SKYLINE_H
#define LINER_SKYLINE_H

#include <stddef.h>
#include <stdint.h>

typedef struct skyline {
    uint32_t count;
    const uint32_t *first; /* [count] column of the first entry of each row */
    const size_t *at;      /* [count] where rows begin in `entry`; the diagonal is not among them */
    double *entry;
    double *diagonal; /* [count] of the matrix; 1 / pivot once it is factorised, or 0 */
} skyline;

/* L D L^t. A pivot that is 0 to rounding belongs to a motion that nothing resists: that freedom stays 0. */
void skyline_factorise(skyline *s);
/* Solves in place. */
void skyline_solve(const skyline *s, double *x);

#endif
